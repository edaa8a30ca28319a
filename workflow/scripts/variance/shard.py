"""One shard of figure 2a's Monte Carlo: sums over its paths."""

from nonsmooth.paths import time_grids
from nonsmooth.paths.ensembles import gram
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def shard(scene, first_time, horizon, points, step, part, seed, threads):
    """Simulate a part of the ensemble, given by the number of its first path and of its paths.

    Returns
    -------
    xarray.Dataset
    """
    tau = time_grids.logarithmic(first_time, horizon, points)
    first, paths = part
    scene = Scene(**scene)
    return artifact.dataset(
        "Sums of the integrated observable and of its control variates",
        f"{paths} paths from number {first} of {scene}",
        {"tau": ("tau", tau, "time tau")},
        {
            "gram": (
                ("tau", "row", "column"),
                gram(scene, tau, Sampling(step, paths, seed, first, threads)),
                "sums of the products of (1, D, D^2, M, M^2 - <M>)",
            )
        },
    )


if __name__ == "__main__":
    produce(shard, snakemake, threads=snakemake.threads)
