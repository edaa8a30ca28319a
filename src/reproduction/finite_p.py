"""Formulas for crossing probabilities at finite p, and how fast their errors fall as p grows."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.scenes.scene import Scene
from reproduction.errors import CheckError

ASYMPTOTIC = "asymptotic"  # the paper's formula, which states no distance to a finite p
FORMULAS = {
    ASYMPTOTIC: {"method": "asymptotic"},
    "order 1": {"method": "corrected", "order": 1},
    "order 2": {"method": "corrected", "order": 2},
    "order 3": {"method": "corrected", "order": 3},
}


def probabilities(
    scene: Scene, threshold: float, horizons: ArrayLike, p: np.ndarray, options: Mapping
) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate W(sqrt(p) b, p T) by one method.

    Parameters
    ----------
    scene : Scene
    threshold : float
        b.
    horizons : array_like
    p : numpy.ndarray
    options : mapping
        The method and its options, as for `crossing_probability`.

    Returns
    -------
    value, error : numpy.ndarray
        Over (p, horizon).
    """
    found = [crossing_probability(scene, threshold, horizons, scale, **options) for scale in p]
    # of the paper's formula the error that is its own, not the distance to a finite p
    errors = [run.get("limit_error", run["probability_error"]) for run in found]
    return np.array([run["probability"] for run in found]), np.array(errors)


def check_stated_errors(p: np.ndarray, off: np.ndarray, allowed: np.ndarray) -> None:
    """Check that no formula is farther from the exact value than it states.

    Parameters
    ----------
    p : numpy.ndarray
    off, allowed : numpy.ndarray
        Distances to the exact values, and the largest allowed ones, over (formula, p, horizon).

    Raises
    ------
    CheckError
        If one is farther; the message names the formula and the first such p.
    """
    for name, bad in zip(FORMULAS, off > allowed, strict=True):
        if name != ASYMPTOTIC and bad.any():
            raise CheckError(
                f"finite_p: the error of the formula {name!r} is larger than it states at p = "
                f"{p[bad.any(axis=-1)][0]:g}"
            )


def powers_of_p(
    p: np.ndarray, distance: np.ndarray, known: np.ndarray, fit_from: float
) -> tuple[list[float], list[float]]:
    """Fit, for each formula, a power of p to its distance from the exact value.

    Parameters
    ----------
    p : numpy.ndarray
    distance, known : numpy.ndarray
        The distances, and whether the exact values resolve them, over (formula, p).
    fit_from : float
        Smallest p of the fit.

    Returns
    -------
    slopes, deviations : list of float
        The powers, and the largest deviations from them of the powers between neighbouring p.

    Raises
    ------
    CheckError
        If fewer than two distances of a formula can be fitted.
    """
    slopes, deviations = [], []
    for name, row, seen in zip(FORMULAS, distance, known, strict=True):
        used = (p >= fit_from) & seen
        if used.sum() < 2:
            raise CheckError(
                f"finite_p: the error of the formula {name!r} is resolved at fewer than two "
                f"p >= {fit_from:g}; lower finite_p.fit_from or add values to finite_p.p"
            )
        scale, size = np.log(p[used]), np.log(row[used])
        slopes.append(np.polyfit(scale, size, 1)[0])
        deviations.append(np.abs(np.diff(size) / np.diff(scale) - slopes[-1]).max())
    return slopes, deviations
