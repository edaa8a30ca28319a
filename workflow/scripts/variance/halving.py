"""The change of figure 2a's Monte Carlo results by halving the time step."""

from nonsmooth.paths import time_grids
from nonsmooth.paths.ensembles import coupled
from nonsmooth.paths.moments import step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def halving(scene, first_time, horizon, points, step, paths, seed, threads):
    """Estimate the bias of v from steps h and h/2 on the same Brownian paths.

    Returns
    -------
    xarray.Dataset
        From paths independent of those of the shards. With a scheme of weak order q the bias of the
        step h is the change by halving it, divided by 1 - 2^-q.
    """
    scene = Scene(**scene)
    tau = time_grids.logarithmic(first_time, horizon, points)
    change, _ = coupled(scene, tau, Sampling(step, paths, (seed, "halving"), threads=threads))
    bias, error = step_bias(change, registry.scheme(scene, "strang").weak_order(scene))
    return artifact.dataset(
        "Bias of the time step in the variance of the integrated observable",
        f"steps {step} and {step / 2} on the same paths of {scene}",
        {"tau": ("tau", tau, "time tau")},
        {
            "bias": ("tau", bias, "bias of v"),
            "bias_error": ("tau", error, "standard error of the bias"),
        },
    )


if __name__ == "__main__":
    produce(halving, snakemake, threads=snakemake.threads)
