"""Strong error of the Strang splitting against the step, for three models and n to infinity."""

from functools import lru_cache
from itertools import product

from nonsmooth.scenes.scene import Scene
from reproduction.jobs.job import produce
from reproduction.speed_against_error.pathwise import BrownianPaths
from reproduction.speed_against_error.work_precision import Case, measured


def pathwise(models, n, horizon, doublings, reference, paths, rounds):
    """Follow each model at each n with every step on the same paths.

    Parameters
    ----------
    models : dict
        Name -> potential.
    n : list of float
    horizon : float
        T.
    doublings : list of int
        Steps are T / 2^doublings.
    reference : int
        Doublings of the solution that stands for the exact one.
    paths, rounds : int

    Returns
    -------
    xarray.Dataset
        `size` is the step.
    """
    cases, references = [], {}

    @lru_cache(maxsize=1)
    def driven(scene, seed):
        return BrownianPaths(scene, horizon, reference, paths, seed)

    for (model, potential), penalization in product(models.items(), n):
        scene = Scene(model, n=penalization, potential=potential, observable="y")
        panel = model.replace("_", "-")
        name = r"$n = \infty$" if penalization == float("inf") else f"$n = {penalization:g}$"
        references[panel] = 0.0, 0.0
        for level in doublings:
            cases.append(
                Case(
                    panel,
                    name,
                    horizon / 2**level,
                    lambda seed, scene=scene, level=level: driven(scene, seed).error(level),
                )
            )
    return measured(
        "Strong error against the step",
        f"root mean square of sup |X_h - X| up to T = {horizon:g} (of the velocity under friction) "
        f"by the Strang splitting, white noise; X has {2**reference} steps",
        cases,
        rounds,
        references,
    )


if __name__ == "__main__":
    produce(pathwise, snakemake)
