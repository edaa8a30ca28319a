"""w and v of figure 2a by spectral elements, the reference."""

from nonsmooth.paths import time_grids
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.variance import variance
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def reference(scene, first_time, horizon, points, tolerance):
    """Solve for v(0, tau) at logarithmic tau and for gamma^2.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    tau = time_grids.logarithmic(first_time, horizon, points)
    solution = variance(scene, tau, tol=tolerance)
    gamma2 = asymptotic_variance(scene)
    return artifact.dataset(
        "Variance of the integrated observable by spectral elements",
        f"v(0, tau) and gamma^2 of {scene}",
        {"tau": ("tau", tau, "time tau")},
        {
            "v": ("tau", solution["v"].values, "variance of int_0^tau g"),
            "v_error": ("tau", solution["v_error"].values, "error bound of v"),
            "gamma2": ((), gamma2.value, "asymptotic variance gamma^2"),
            "gamma2_error": ((), gamma2.error, "error bound of gamma^2"),
        },
    )


if __name__ == "__main__":
    produce(reference, snakemake)
