"""gamma^2 of one scene of the sweep by Monte Carlo."""

from nonsmooth.paths.ensembles import integrals_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.sampled_gamma2 import gamma2_bias, slopes
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def variance(scene, times, step, paths, halving_paths, seed, threads):
    """Estimate gamma^2 by the slope of the variance between two times, and its bias by the step.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    sampling = Sampling(step, paths, (seed, "sweep"), threads=threads)
    halving = Sampling(step, halving_paths, (seed, "sweep, halving"), threads=threads)
    found = slopes(integrals_at(scene, times, sampling), times)
    bias, bias_error = gamma2_bias(scene, times, halving)
    return artifact.dataset(
        "Asymptotic variance of the integrated observable by Monte Carlo",
        f"{paths} paths of {scene}, from t = {times[0]:g} to {times[-1]:g}",
        {},
        {
            "gamma2": ((), found.gamma2, "gamma^2, asymptotic variance of int_0^t g"),
            "gamma2_error": ((), found.gamma2_error, "standard error of gamma^2"),
            "bias": ((), bias, "bias of gamma^2 by the time step"),
            "bias_error": ((), bias_error, "standard error of the bias"),
            "settling": (
                (),
                found.settling,
                "gamma^2 from the second half of the time less that from the first",
            ),
            "settling_error": ((), found.settling_error, "standard error of the difference"),
            "mean": ((), found.mean, "stationary mean of g"),
            "mean_error": ((), found.mean_error, "standard error of the mean"),
        },
    )


if __name__ == "__main__":
    produce(variance, snakemake, threads=snakemake.threads)
