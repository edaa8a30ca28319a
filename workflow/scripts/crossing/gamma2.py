"""Relative bias of gamma^2 by figure 2b's time step."""

from nonsmooth.paths.ensembles import coupled
from nonsmooth.paths.moments import step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.variance import variance
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def bias_of_gamma2(scene, time, step, paths, seed, threads):
    """Estimate the bias of v(0, time) from steps h and h/2, relative to v.

    For large `time` this is the relative bias of gamma^2. For large p the first-passage times have
    the same relative bias with the opposite sign, but there it cannot be measured so precisely. The
    paths are independent of those of the shards.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    sampling = Sampling(step, paths, (seed, "growth"), threads=threads)
    change, _ = coupled(scene, [time], sampling)
    bias, error = step_bias(change, registry.scheme(scene, "strang").weak_order(scene))
    v = variance(scene, [time])["v"].values
    return artifact.dataset(
        "Bias of gamma^2 by the time step",
        f"steps {step} and {step / 2} on the same paths of {scene}, tau = {time}",
        {},
        {
            "bias": ((), (bias / v)[0], "relative bias of v"),
            "bias_error": ((), (error / v)[0], "standard error of the bias"),
        },
    )


if __name__ == "__main__":
    produce(bias_of_gamma2, snakemake, threads=snakemake.threads)
