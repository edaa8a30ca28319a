"""gamma^2 of scenes whose potentials are given by formulas, with and without Monte Carlo."""

from dataclasses import replace

import numpy as np

from nonsmooth.paths.ensembles import integrals_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import by_formulas
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.sampled_gamma2 import gamma2_bias, slopes
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

DESCRIPTIONS = {
    "gamma2": "gamma^2, asymptotic variance of int_0^t g",
    "gamma2_error": "error bound of gamma^2",
    "monte_carlo": "gamma^2 by Monte Carlo",
    "monte_carlo_error": "standard error of gamma^2",
    "bias": "bias of gamma^2 by the time step",
    "bias_error": "standard error of the bias",
    "settling": "gamma^2 from the second half of the time less that from the first",
    "settling_error": "standard error of the difference",
    "correlation_time": "integral of the correlation of g over time",
    "correlation_time_error": "error of the correlation time",
}


def potentials(scenes, tolerance, times, paths, halving_paths, step, seed, threads):
    """Solve the Poisson equation of each scene, and sample the slope of its variance.

    Parameters
    ----------
    scenes : list of dict
    tolerance : list of float
        Relative, for one to four state variables.
    times : list of float
        Three; the slope is from the first to the last.
    paths, halving_paths, step, seed, threads
        Of Monte Carlo.

    Returns
    -------
    xarray.Dataset
        Over `scene`, the number in the list.
    """
    rows = []
    for number, parameters in enumerate(scenes):
        scene, own = by_formulas(parameters), (seed, "potentials", number)
        solved = asymptotic_variance(scene, tolerance[scene.dimension - 1], "deterministic")

        def sample(scene, paths, label, own=own):
            sampling = Sampling(step, paths, (*own, label), threads=threads)
            return slopes(integrals_at(scene, times, sampling), times)

        found = sample(scene, paths, "growth")
        halving = Sampling(step, halving_paths, (*own, "halving"), threads=threads)
        bias = gamma2_bias(scene, times, halving)
        square = sample(replace(scene, observable=f"({scene.observable})**2"), halving_paths, "g^2")
        spread = square.mean - found.mean**2
        unsure = np.hypot(square.mean_error, 2 * found.mean * found.mean_error) / spread
        time = solved.value / (2 * spread)
        rows.append(
            [
                *(solved.value, solved.error, found.gamma2, found.gamma2_error, *bias),
                *(found.settling, found.settling_error),
                *(time, time * (unsure + solved.error / solved.value)),
            ]
        )
    return artifact.dataset(
        "Asymptotic variance of the integrated observable under general potentials",
        f"Poisson equation, and {paths} paths from t = {times[0]:g} to {times[-1]:g}",
        {"scene": ("scene", np.arange(len(scenes)), "number of the scene in the configuration")},
        {
            name: ("scene", values, DESCRIPTIONS[name])
            for name, values in zip(DESCRIPTIONS, np.transpose(rows), strict=True)
        },
    )


if __name__ == "__main__":
    produce(potentials, snakemake, threads=snakemake.threads)
