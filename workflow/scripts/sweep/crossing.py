"""Threshold crossing probabilities of one scene of the sweep at one p."""

import numpy as np

from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.crossing.proportions import DESCRIPTIONS, crossing_estimate
from nonsmooth.paths import time_grids
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.sweep import crossing_bias


def crossing(
    scene, threshold, horizon, outputs, p, step, measured, paths, halving_paths, seed, threads
):
    """Count the paths that have crossed sqrt(p) b by p T, for equidistant T.

    The bias of the time step is measured at p or, at p above `measured`, follows from those of
    gamma^2 and at that p.

    Returns
    -------
    xarray.Dataset
    """
    horizons = time_grids.equidistant(horizon, outputs)
    scene = Scene(**scene)
    sampling = Sampling(step, paths, (seed, f"sweep, p = {p}"), threads=threads)
    halving = Sampling(step, halving_paths, (seed, f"sweep, halving, p = {p}"), threads=threads)
    crossed = first_passage_counts(scene, threshold, horizons, p, sampling)
    estimate = crossing_estimate(np.cumsum(crossed), paths)
    bias, bias_error = crossing_bias(
        scene, threshold, horizons, p, estimate["probability"], measured, halving
    )
    return artifact.dataset(
        "Threshold crossing probability by Monte Carlo",
        f"{paths} paths of {scene}, b = {threshold}, p = {p}",
        {"horizon": ("horizon", horizons, "T"), "p": ((), p, "scale p")},
        {name: ("horizon", estimate[name], text) for name, text in DESCRIPTIONS.items()}
        | {
            "bias": ("horizon", bias, "bias of the probability by the time step"),
            "bias_error": ("horizon", bias_error, "standard error of the bias"),
        },
    )


if __name__ == "__main__":
    produce(crossing, snakemake, threads=snakemake.threads)
