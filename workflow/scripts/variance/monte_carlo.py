"""Merge the shards of figure 2a's Monte Carlo and attach their errors."""

from functools import reduce

from nonsmooth.paths.moments import moments
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def merge(shards, halving):
    """Add up the sums in the order of the shards and estimate v.

    Parameters
    ----------
    shards : list of xarray.Dataset
    halving : xarray.Dataset
        The change by halving the step.

    Returns
    -------
    xarray.Dataset
    """
    total = reduce(lambda a, b: a + b, (shard["gram"].values for shard in shards))
    found = moments(total)
    return artifact.dataset(
        "Variance of the integrated observable by Monte Carlo",
        "all shards together; the first: " + shards[0].attrs["summary"],
        {"tau": ("tau", shards[0]["tau"].values, "time tau")},
        {
            "v": ("tau", found["variance"], "variance of int_0^tau g"),
            "v_error": ("tau", found["variance_error"], "standard error of v"),
            "bias": ("tau", halving["bias"].values, "bias of v by the time step"),
            "bias_error": ("tau", halving["bias_error"].values, "standard error of the bias"),
            "paths": ((), total[0, 0, 0], "number of paths"),
        },
    )


if __name__ == "__main__":
    produce(merge, snakemake)
