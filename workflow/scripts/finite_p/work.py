"""Time against error of the methods for crossing probabilities. What it measures is time."""

import time

import numpy as np

from nonsmooth import artifact
from nonsmooth.crossing import crossing_probability
from nonsmooth.jobs import produce
from nonsmooth.scene import Scene

FORMULAS = {
    "plain": {"method": "asymptotic"},
    "order 1": {"method": "corrected", "order": 1},
    "order 2": {"method": "corrected", "order": 2},
}


def work(scene, threshold, horizon, p, monte_carlo, spectral, reference, repeats, seed):
    """Measure seconds and errors on one core.

    Parameters
    ----------
    scene : dict
    threshold, horizon : float
    p : list of float
    monte_carlo, spectral : list of float
        Tolerances.
    reference : float
        Tolerance of the spectral value that errors are measured by.
    repeats : int
        The time is the median of as many runs, the error their root mean square: those of Monte
        Carlo have their own seeds.
    seed : int

    Returns
    -------
    xarray.Dataset
        Over p and run, a run being a method with its tolerance. No error is below the reference's.
        The time of the plain formula is without gamma^2, which is solved for once per scene.
    """
    scene = Scene(**scene)
    runs = [("Monte Carlo", tol, {"method": "monte_carlo", "tol": tol}) for tol in monte_carlo]
    runs += [("spectral", tol, {"method": "spectral", "tol": tol}) for tol in spectral]
    runs += [(name, 0.0, options) for name, options in FORMULAS.items()]
    seconds, errors, floors = [], [], []
    for scale in p:
        problem = (scene, threshold, [horizon], scale)
        truth = crossing_probability(*problem, method="spectral", tol=reference)
        floors.append(float(truth["probability_error"][0]))
        for _, _, options in runs:
            # compiles, and loads libraries, at the first
            crossing_probability(*problem, **options, threads=1)
            spent, off = [], []
            for k in range(repeats):
                began = time.perf_counter()
                found = crossing_probability(*problem, **options, seed=(seed, k), threads=1)
                spent.append(time.perf_counter() - began)
                off.append(float((found["probability"] - truth["probability"])[0]))
            seconds.append(np.median(spent))
            errors.append(max(np.sqrt(np.mean(np.square(off))), floors[-1]))
    shape = (len(p), len(runs))
    return artifact.dataset(
        "Time against error for crossing probabilities",
        f"{scene}, b = {threshold}, T = {horizon}; medians of {repeats} runs on one core",
        {
            "p": ("p", np.array(p, dtype=float), "scale p"),
            "method": ("run", [name for name, _, _ in runs], "method"),
            "tolerance": ("run", [tol for _, tol, _ in runs], "tolerance, 0 if there is none"),
        },
        {
            "seconds": (("p", "run"), np.reshape(seconds, shape), "median time in seconds"),
            "distance": (("p", "run"), np.reshape(errors, shape), "root mean square error"),
            "floor": ("p", floors, "error of the reference, below which no error is seen"),
        },
    )


if __name__ == "__main__":
    produce(work, snakemake)
