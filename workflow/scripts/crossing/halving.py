"""By how much halving the time step shifts the first-passage times of figure 2b."""

from nonsmooth.crossing.counting import first_passage_shift
from nonsmooth.errors import SceneError
from nonsmooth.paths.moments import bias_over_change
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def halving(scene, threshold, horizon, p, step, paths, seed, threads):
    """Estimate the relative bias of the first-passage times from steps h and h/2.

    Returns
    -------
    xarray.Dataset
        From paths independent of those of the shards. With a scheme of weak order q the bias of the
        step h is the change by halving it, divided by 1 - 2^-q.
    """
    scene = Scene(**scene)
    sampling = Sampling(step, paths, (seed, f"halving, p = {p}"), threads=threads)
    count, total, square = first_passage_shift(scene, threshold, horizon, p, sampling)
    if not count:
        raise SceneError(
            f"no path crosses {threshold} sqrt(p) by {horizon} p at p = {p}; "
            "lower crossing.threshold or raise crossing.horizon"
        )
    factor = bias_over_change(registry.scheme(scene, "strang").weak_order(scene))
    mean = total / count
    return artifact.dataset(
        "Bias of the time step in the first-passage times",
        f"steps {step} and {step / 2} on the same paths of {scene}, b = {threshold}, p = {p}",
        {"p": ((), p, "scale p")},
        {
            "shift": ((), factor * mean, "bias of the mean log first-passage time"),
            "shift_error": (
                (),
                factor * ((square / count - mean**2) / count) ** 0.5,
                "standard error of the bias",
            ),
        },
    )


if __name__ == "__main__":
    produce(halving, snakemake, threads=snakemake.threads)
