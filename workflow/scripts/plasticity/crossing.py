"""Probability that the permanent deformation has exceeded one limit, by Monte Carlo."""

import numpy as np

from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.crossing.proportions import DESCRIPTIONS, crossing_estimate
from nonsmooth.paths import time_grids
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.plasticity import yielding_oscillator


def crossing(ground, oscillator, limit, duration, outputs, step, paths, seed, threads):
    """Simulate from rest and count the paths that have exceeded the limit, by duration.

    Returns
    -------
    xarray.Dataset
    """
    scene = yielding_oscillator(ground, oscillator)
    durations = time_grids.equidistant(duration, outputs)
    found = crossing_probability(
        scene,
        limit,
        durations,
        step=step,
        paths=paths,
        seed=(seed, f"plasticity, limit = {limit}"),
        threads=threads,
    )
    # the errors of counting alone, beside the bias
    crossed = np.rint(found["probability"].values * paths).astype(int)
    counted = crossing_estimate(crossed, paths)
    return artifact.dataset(
        "Probability that the permanent deformation has exceeded a limit, by Monte Carlo",
        f"{paths} paths of {scene}, limit = {limit}",
        {
            "duration": ("duration", durations, "duration of the earthquake"),
            "limit": ((), limit, "limit of the permanent deformation"),
        },
        {
            name: ("duration", counted[name], text)
            for name, text in (
                DESCRIPTIONS | {"probability": "probability of having exceeded the limit"}
            ).items()
        }
        | {
            "bias": ("duration", found["step_bias"].values, "bias by the time step"),
            "bias_error": (
                "duration",
                found["step_bias_error"].values,
                "standard error of the bias",
            ),
        },
    )


if __name__ == "__main__":
    produce(crossing, snakemake, threads=snakemake.threads)
