"""gamma^2 and kappa of the permanent deformation: all that the asymptotic formulas need."""

from nonsmooth.boundary_layer.extrapolation_length import extrapolation_length
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.plasticity import yielding_oscillator


def variance(ground, oscillator, tolerance, seed, threads):
    """Compute the asymptotic variance of the permanent deformation, and kappa.

    Returns
    -------
    xarray.Dataset
    """
    scene = yielding_oscillator(ground, oscillator)
    found = asymptotic_variance(
        scene, tolerance, method="monte_carlo", seed=(seed, "plasticity"), threads=threads
    )
    kappa = extrapolation_length(scene, seed=(seed, "plasticity, length"), threads=threads)
    return artifact.dataset(
        "Asymptotic variance of the permanent deformation, and its extrapolation length",
        f"{scene}, {found.method}",
        {},
        {
            "gamma2": ((), found.value, "gamma^2, asymptotic variance of the deformation"),
            "gamma2_error": ((), found.error, "its error"),
            "kappa": ((), kappa.value, "extrapolation length of the limits"),
            "kappa_error": ((), kappa.error, "its error"),
        },
    )


if __name__ == "__main__":
    produce(variance, snakemake, threads=snakemake.threads)
