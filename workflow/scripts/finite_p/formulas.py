"""The asymptotic formula and its corrections against the exact probability, for growing p."""

from dataclasses import asdict

import numpy as np

from nonsmooth.boundary_layer.symmetric_line import expansion
from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.errors import CheckError
from nonsmooth.scenes.scene import Scene
from reproduction import artifact
from reproduction.jobs import produce

EXACT = {"method": "deterministic", "tol": 1e-8}  # at p = 1e6 errors of order 1 are 1e-7
LIMIT = "plain"  # states no distance to a finite p
FORMULAS = {
    LIMIT: {"method": "asymptotic"},
    "order 1": {"method": "corrected", "order": 1},
    "order 2": {"method": "corrected", "order": 2},
    "order 3": {"method": "corrected", "order": 3},
}
CONSTANTS = {
    "diffusion": "D = gamma^2 / 2",
    "kappa": "extrapolation length",
    "dispersion": "dispersion B",
    "corner": "dipole S of the corner between initial time and threshold",
    "stretch": "kappa_3, by which short waves see another extrapolation length",
    "poisson": "Poisson solution u at the start",
    "start": "h at the start",
    "third": "r at the start",
}
RESOLVED = 10  # an error is resolved where it is as many times that of the exact value


def formulas(scene, threshold, horizons, p, fit_from):
    """Evaluate every formula at every p, and fit powers of p to their errors.

    Parameters
    ----------
    scene : dict
    threshold : float
    horizons, p : list of float
        Increasing.
    fit_from : float
        Smallest p of the fit.

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

    def evaluate(options):
        found = [crossing_probability(scene, threshold, horizons, s, **options) for s in p]
        return np.array([[d["probability"], d["probability_error"]] for d in found]).swapaxes(0, 1)

    exact, exact_error = evaluate(EXACT)
    value, error = np.array([evaluate(options) for options in FORMULAS.values()]).swapaxes(0, 1)
    off = np.abs(value - exact)
    for name, bad in zip(FORMULAS, off > error + exact_error, strict=True):
        if name != LIMIT and bad.any():
            raise CheckError(
                f"finite_p: the error of the formula {name!r} is larger than it states at p = "
                f"{p[bad.any(axis=-1)][0]:g}"
            )
    distance = off.max(axis=-1)
    distance_error = np.broadcast_to(exact_error.max(axis=-1), distance.shape)
    resolved = off > RESOLVED * exact_error
    slopes, deviations = [], []
    for name, row, known in zip(FORMULAS, distance, resolved.any(axis=-1), strict=True):
        used = (p >= fit_from) & known
        if used.sum() < 2:
            raise CheckError(
                f"finite_p: the error of the formula {name!r} is resolved at fewer than two "
                f"p >= {fit_from:g}; lower finite_p.fit_from or add values to finite_p.p"
            )
        scale, size = np.log(p[used]), np.log(row[used])
        slopes.append(np.polyfit(scale, size, 1)[0])
        deviations.append(np.abs(np.diff(size) / np.diff(scale) - slopes[-1]).max())
    every = ("formula", "p", "horizon")
    variables = {
        "probability": (every, value, "probability by the formula"),
        "probability_error": (
            every,
            error,
            "error that it states; of the plain formula, from gamma^2 only",
        ),
        "exact": (every[1:], exact, "probability by the deterministic method"),
        "exact_error": (every[1:], exact_error, "difference of two resolutions"),
        "distance": (every[:2], distance, "largest error of the formula over T"),
        "distance_error": (every[:2], distance_error, "largest error of the exact value over T"),
        "resolved": (
            every,
            resolved.astype(np.int8),
            f"1 where the error is {RESOLVED} times that of the exact value",
        ),
        "slope": ("formula", slopes, "power of p that fits the distance"),
        "slope_error": ("formula", deviations, "largest deviation of a slope between neighbours"),
    }
    constants, errors = map(asdict, expansion(scene))
    for found in (constants, errors):
        found["kappa"] = found.pop("length")
    for name, text in CONSTANTS.items():
        variables[name] = ((), constants[name], text)
        variables[f"{name}_error"] = ((), errors[name], "difference of two polynomial degrees")
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
