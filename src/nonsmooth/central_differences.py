"""Central differences of the orders 4 and 6, and an error that covers both sources.

The order 6 is used. What it changes, compared with the order 4, is far above its own error. What
the errors of the function become is added.
"""

import numpy as np

_FOURTH = np.array([8, -1, 0]) / 12  # weights of f(x + k h) - f(x - k h), k = 1, 2, 3, over h
_SIXTH = np.array([45, -9, 1]) / 60


def central(
    below: np.ndarray, above: np.ndarray, inexact: np.ndarray, spacing: float
) -> tuple[np.ndarray, np.ndarray]:
    """Differentiate a function that is known at neighbouring points.

    Parameters
    ----------
    below, above : numpy.ndarray, shape (3, k)
        f(x - j h) and f(x + j h), j = 1, 2, 3.
    inexact : numpy.ndarray, shape (3, k)
        Errors of f(x - j h) and f(x + j h) together.
    spacing : float
        h.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
    """
    rise = (above - below) / spacing
    value = _SIXTH @ rise
    return value, np.abs(value - _FOURTH @ rise) + np.abs(_SIXTH) @ inexact / spacing
