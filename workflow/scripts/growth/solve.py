"""gamma^2 of one scene without Monte Carlo."""

from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.variance import asymptotic_variance
from reproduction import artifact
from reproduction.jobs import produce


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
        "Growth rate of the variance of the integrated observable",
        f"{scene}, by {found.method}",
        {},
        {
            "gamma2": ((), found.value, "growth rate of the variance of int_0^t g"),
            "gamma2_error": ((), found.error, "error bound of the growth rate"),
        },
    )


if __name__ == "__main__":
    produce(solve, snakemake)
