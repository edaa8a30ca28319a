"""The levels whose crossing is asked for: one number for both sides, or one level for each.

One threshold is a number or a pair, several are a list of numbers or of pairs.
"""

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.checks import require_numbers
from nonsmooth.errors import SceneError, quoted


def bounds(threshold: ArrayLike) -> tuple[float, float]:
    """Return the lower and the upper level of a threshold.

    Parameters
    ----------
    threshold : float or (float, float)
        A number b > 0 stands for -b and b, a pair for its lower and upper level, "1":
        lower < 0 < upper, one of which may be infinite (a one-sided threshold).

    Returns
    -------
    lower, upper : float

    Raises
    ------
    SceneError
        If it is neither, or 0 is not between the levels, or no path can cross it.
    """
    levels = require_numbers("threshold", threshold)
    if levels.shape not in ((), (2,)) or (levels.shape and levels[0] > 0):
        raise SceneError(
            f"threshold is {quoted(threshold)}; give one number b > 0, or one pair (lower, "
            "upper) with lower < 0 < upper"
        )
    lower, upper = (-levels, levels) if levels.shape == () else levels
    if not lower < 0 < upper:
        raise SceneError(
            f"a crossing needs threshold > 0, or lower < 0 < upper, got {quoted(threshold)}; "
            "choose levels on both sides of the start, 0"
        )
    if lower == -np.inf and upper == np.inf:
        raise SceneError(f"no path crosses threshold = {quoted(threshold)}; choose a finite level")
    return float(lower), float(upper)


def intervals(threshold: ArrayLike) -> tuple[np.ndarray, bool]:
    """Return the lower and the upper levels of one threshold or of several.

    Parameters
    ----------
    threshold : array_like
        One threshold as for `bounds`, or several: b > 0 in a list or an array of one dimension, or
        pairs in an array of shape (m, 2), "1". Two numbers of which the first is negative are one
        pair, and so is every tuple of two numbers.

    Returns
    -------
    levels : numpy.ndarray, shape (m, 2)
    several : bool
        Whether it is a list of thresholds.

    Raises
    ------
    SceneError
        If one of them is none, or the list is empty.
    """
    found = require_numbers("threshold", threshold)
    pair = found.shape == (2,) and (isinstance(threshold, tuple) or found[0] < 0)
    if found.ndim == 0 or pair:
        return np.array([bounds(threshold)]), False
    if found.ndim > 2 or found.size == 0 or (found.ndim == 2 and found.shape[1] != 2):
        raise SceneError(
            f"threshold is {quoted(threshold)}; give a number, a pair (lower, upper), a list of "
            "numbers or an array of pairs of the shape (m, 2)"
        )
    return np.array([bounds(one) for one in found.tolist()]), True
