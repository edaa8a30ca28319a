"""One shard of figure 2b: how many paths cross by each horizon."""

import numpy as np

from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.paths import time_grids
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def shard(scene, threshold, horizon, outputs, p, step, part, seed, threads):
    """Simulate a part of the ensemble, given by the number of its first path and of its paths.

    Returns
    -------
    xarray.Dataset
    """
    horizons = time_grids.equidistant(horizon, outputs)
    first, paths = part
    scene = Scene(**scene)
    sampling = Sampling(step, paths, (seed, f"p = {p}"), first, threads)
    crossed = first_passage_counts(scene, threshold, horizons, p, sampling)
    return artifact.dataset(
        "Numbers of paths that cross the threshold",
        f"{paths} paths from number {first} of {scene}, b = {threshold}, p = {p}",
        {"horizon": ("horizon", horizons, "T")},
        {
            "crossed": ("horizon", np.cumsum(crossed), "paths that have crossed by p T"),
            "paths": ((), paths, "number of paths"),
        },
    )


if __name__ == "__main__":
    produce(shard, snakemake, threads=snakemake.threads)
