"""The limit of figure 2b: W_star(b / gamma, T)."""

from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.paths import time_grids
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def limit(scene, threshold, horizon, outputs):
    """Evaluate the paper's asymptotic formula.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    horizons = time_grids.equidistant(horizon, outputs)
    solution = crossing_probability(scene, threshold, horizons, method="asymptotic")
    return artifact.dataset(
        "Asymptotic threshold crossing probability",
        f"W_star(b / gamma, T) of {scene}, b = {threshold}",
        {"horizon": ("horizon", horizons, "T")},
        {
            "probability": ("horizon", solution["probability"].values, "W_star(b / gamma, T)"),
            "probability_error": (
                "horizon",
                solution["limit_error"].values,
                "error inherited from gamma^2",
            ),
        },
    )


if __name__ == "__main__":
    produce(limit, snakemake)
