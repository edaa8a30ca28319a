"""gamma^2 of the permanent deformation: all that the asymptotic formula needs."""

from functools import partial

from nonsmooth import artifact
from nonsmooth.jobs import produce
from nonsmooth.plasticity import yielding_oscillator
from nonsmooth.variance import asymptotic_variance


def variance(ground, oscillator, tolerance, seed, threads):
    """Compute the growth rate of the variance of the permanent deformation.

    Returns
    -------
    xarray.Dataset
    """
    scene = yielding_oscillator(ground, oscillator)
    found = asymptotic_variance(
        scene, tolerance, method="monte_carlo", seed=(seed, "plasticity"), threads=threads
    )
    return artifact.dataset(
        "Growth rate of the variance of the permanent deformation",
        f"{scene}, {found.method}",
        {},
        {
            "gamma2": ((), found.value, "growth rate of the variance of the deformation"),
            "gamma2_error": ((), found.error, "its error"),
        },
    )


if __name__ == "__main__":
    produce(partial(variance, threads=snakemake.threads), snakemake)
