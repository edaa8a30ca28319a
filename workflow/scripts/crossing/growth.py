"""Relative bias of the growth rate of the variance by figure 2b's time step."""

from functools import partial

from nonsmooth import artifact, strang
from nonsmooth.jobs import produce
from nonsmooth.scene import Scene
from nonsmooth.trajectories import central_moments, step_bias
from nonsmooth.variance import variance


def growth(scene, time, step, paths, seed, threads):
    """Estimate the bias of v(0, time) from steps h and h/2, relative to v.

    For p large it is the negative bias of the mean log first-passage time, and far more
    precise than the direct measurement.

    Returns
    -------
    xarray.Dataset
        From an ensemble independent of the shards'.
    """
    scene = Scene(**scene)
    change = central_moments(step_bias(scene, time, step, paths, (seed, "growth"), [time], threads))
    factor = 1 / (1 - 2 ** -strang.weak_order(scene)) / float(variance(scene, [time])["v"][0])
    return artifact.dataset(
        "Bias of the time step in the growth of the variance",
        f"steps {step} and {step / 2} on the same paths of {scene}, tau = {time}",
        {},
        {
            "bias": ((), factor * change["mean"][0], "relative bias of v"),
            "bias_error": ((), factor * change["mean_error"][0], "standard error of the bias"),
        },
    )


if __name__ == "__main__":
    produce(partial(growth, threads=snakemake.threads), snakemake)
