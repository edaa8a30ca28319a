"""Figure 2b without Monte Carlo: W(sqrt(p) b, p T) by the deterministic method."""

from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.paths import time_grids
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def exact(scene, threshold, horizon, outputs, first_time, tolerance, p):
    """Solve for the crossing probability at the horizons of Monte Carlo from `first_time` on.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    horizons = time_grids.equidistant(horizon, outputs)
    horizons = horizons[horizons >= first_time * (1 - 1e-9)]
    solution = crossing_probability(
        scene, threshold, horizons, p, method="deterministic", tol=tolerance
    )
    return artifact.dataset(
        "Threshold crossing probability by the deterministic method",
        f"{scene}, b = {threshold}, p = {p}",
        {"horizon": ("horizon", horizons, "T"), "p": ((), p, "scale p")},
        {
            "probability": (
                "horizon",
                solution["probability"].values,
                "probability of crossing sqrt(p) b by p T",
            ),
            "probability_error": (
                "horizon",
                solution["probability_error"].values,
                "difference of two resolutions",
            ),
        },
    )


if __name__ == "__main__":
    produce(exact, snakemake)
