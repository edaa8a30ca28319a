"""The asymptotic formula and its corrections against the exact probability, for growing p."""

import numpy as np

from nonsmooth.boundary_layer.symmetric_line import layer_constants
from nonsmooth.scenes.scene import Scene
from reproduction.finite_p import FORMULAS, check_stated_errors, powers_of_p, probabilities
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

CONSTANTS = {
    "diffusion": "D = gamma^2 / 2",
    "kappa": "extrapolation length",
    "dispersion": "dispersion B",
    "dipole": "dipole S that the start of time leaves at the threshold",
    "kappa3": "kappa_3, by which short waves see another extrapolation length",
    "u": "Poisson solution u at the start",
    "h": "h at the start",
    "r": "r at the start",
}


def formulas(scene, threshold, horizons, p, fit_from, exact_tolerance, resolved):
    """Evaluate every formula at every p, and fit powers of p to their errors.

    Parameters
    ----------
    scene : dict
    threshold : float
    horizons, p : list of float
        Increasing.
    fit_from : float
        Smallest p of the fit.
    exact_tolerance : float
        Absolute error allowed of the exact probabilities.
    resolved : float
        An error is shown and fitted where it is as many times that of the exact value.

    Returns
    -------
    xarray.Dataset
        Over the formula, p and T; the largest distances over T and their powers of p; and the
        constants of the formulas.

    Raises
    ------
    CheckError
        If fewer than two distances can be fitted, or one is larger than stated.
    """
    scene, p = Scene(**scene), np.array(p, dtype=float)
    options = {"method": "deterministic", "tol": exact_tolerance}
    exact, exact_error = probabilities(scene, threshold, horizons, p, options)
    found = [probabilities(scene, threshold, horizons, p, way) for way in FORMULAS.values()]
    value, error = np.array(found).swapaxes(0, 1)
    off = np.abs(value - exact)
    check_stated_errors(p, off, error + exact_error)
    distance = off.max(axis=-1)
    seen = off > resolved * exact_error
    slopes, deviations = powers_of_p(p, distance, seen.any(axis=-1), fit_from)
    every = ("formula", "p", "horizon")
    variables = {
        "probability": (every, value, "probability by the formula"),
        "probability_error": (
            every,
            error,
            "error that it states; of the asymptotic formula, from gamma^2 only",
        ),
        "exact": (every[1:], exact, "probability by the deterministic method"),
        "exact_error": (every[1:], exact_error, "difference of two resolutions"),
        "distance": (every[:2], distance, "largest error of the formula over T"),
        "distance_error": (
            every[:2],
            np.broadcast_to(exact_error.max(axis=-1), distance.shape),
            "largest error of the exact value over T",
        ),
        "resolved": (
            every,
            seen.astype(np.int8),
            f"1 where the error is {resolved:g} times that of the exact value",
        ),
        "slope": ("formula", slopes, "power of p that fits the distance"),
        "slope_error": ("formula", deviations, "largest deviation of a slope between neighbours"),
    }
    constants, errors = layer_constants(scene)
    for name, text in CONSTANTS.items():
        # kappa, the dipole and kappa3 are pairs, equal for odd g
        value, uncertainty = (float(np.max(getattr(c, name))) for c in (constants, errors))
        variables[name] = ((), value, text)
        variables[f"{name}_error"] = ((), uncertainty, "difference of two polynomial degrees")
    return artifact.dataset(
        "Corrected asymptotic formulas",
        f"crossing probabilities of {scene}, b = {threshold}",
        {
            "formula": ("formula", list(FORMULAS), "formula"),
            "p": ("p", p, "scale p"),
            "horizon": ("horizon", np.array(horizons, dtype=float), "T"),
        },
        variables,
    )


if __name__ == "__main__":
    produce(formulas, snakemake)
