"""One column of table 4 by spectral elements, and gamma_n^2 in closed form."""

from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.variance import variance
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def reference(scene, n, horizon, tolerance):
    """Solve for v(0, T)/T and gamma_n^2.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene, n=n)
    solution = variance(scene, [horizon], tol=tolerance)
    gamma2 = asymptotic_variance(scene)
    ratio = float(solution["v"][0]) / horizon
    error = float(solution["v_error"][0]) / horizon
    return artifact.dataset(
        "v(0, T)/T by spectral elements",
        f"{scene}, T = {horizon}",
        {"n": ((), n, "penalization")},
        {
            "v_over_time": ((), ratio, "v(0, T)/T"),
            "v_over_time_error": ((), error, "error bound of v(0, T)/T"),
            "gamma2": ((), gamma2.value, "gamma_n^2 in closed form"),
            "gamma2_error": ((), gamma2.error, "error bound of gamma_n^2"),
            "offset": ((), ratio - gamma2.value, "v(0, T)/T - gamma_n^2"),
            "offset_error": ((), error + gamma2.error, "error bound of the offset"),
        },
    )


if __name__ == "__main__":
    produce(reference, snakemake)
