"""gamma^2 of one scene without Monte Carlo."""

from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def solve(scene, tolerance):
    """Solve the Poisson equation to the tolerance of the scene's number of variables.

    Parameters
    ----------
    scene : dict
    tolerance : list of float
        Relative, for one to four variables.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    found = asymptotic_variance(scene, tolerance[scene.dimension - 1], "deterministic")
    return artifact.dataset(
        "Asymptotic variance of the integrated observable",
        f"{scene}, by {found.method}",
        {},
        {
            "gamma2": ((), found.value, "gamma^2, asymptotic variance of int_0^t g"),
            "gamma2_error": ((), found.error, "error bound of gamma^2"),
        },
    )


if __name__ == "__main__":
    produce(solve, snakemake)
