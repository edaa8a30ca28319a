"""Merge the shards of one p of figure 2b and attach their errors."""

import numpy as np

from nonsmooth.crossing.proportions import DESCRIPTIONS, crossing_estimate
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def merge(shards, halving, p):
    """Add up the counts and estimate W(sqrt(p) b, p T).

    The bias of the time step follows from the shift of the first-passage times: a relative
    shift s of the times changes W by -s dW/dlog T.

    Parameters
    ----------
    shards : list of xarray.Dataset
    halving : xarray.Dataset
    p : float

    Returns
    -------
    xarray.Dataset
    """
    horizon = shards[0]["horizon"].values
    crossed = sum(shard["crossed"].values for shard in shards)
    paths = sum(int(shard["paths"]) for shard in shards)
    estimate = crossing_estimate(crossed, paths)
    slope = np.abs(horizon * np.gradient(estimate["probability"], horizon))
    return artifact.dataset(
        "Threshold crossing probability by Monte Carlo",
        "all shards together; the first: " + shards[0].attrs["summary"],
        {"horizon": ("horizon", horizon, "T"), "p": ((), p, "scale p")},
        {name: ("horizon", estimate[name], text) for name, text in DESCRIPTIONS.items()}
        | {
            "bias": ((), -float(halving["shift"]) * slope.max(), "largest bias by the time step"),
            "bias_error": (
                (),
                float(halving["shift_error"]) * slope.max(),
                "standard error of the bias",
            ),
            "slope": ((), slope.max(), "largest dW/dlog T"),
            "paths": ((), paths, "number of paths"),
        },
    )


if __name__ == "__main__":
    produce(merge, snakemake)
