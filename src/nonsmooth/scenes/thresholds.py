"""The levels whose crossing is asked for: one number for both sides, or one level for each."""

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
    if levels.shape not in ((), (2,)):
        raise SceneError(
            f"threshold is {quoted(threshold)}; give a number or a pair (lower, upper)"
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
