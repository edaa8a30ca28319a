"""Integrals of products of two exponentials over a stretch of x, for all pairs of rates."""

import numpy as np

from nonsmooth.kinetic import tuning


def along(rates: np.ndarray, length: float) -> np.ndarray:
    """Integrate exp(-r s) exp(-q s) over 0 < s < length.

    Parameters
    ----------
    rates : numpy.ndarray of complex, shape (m,)
        Of positive real part, if the length is infinite.
    length : float

    Returns
    -------
    numpy.ndarray of complex, shape (m, m)
        r in rows, q in columns.
    """
    total = rates[:, None] + rates
    if np.isinf(length):
        return 1 / total
    fall = np.exp(-rates * length)
    return (1 - fall[:, None] * fall) / total


def against(rates: np.ndarray, length: float) -> np.ndarray:
    """Integrate exp(-r s) exp(-q (length - s)) over 0 < s < length; see `along`."""
    if np.isinf(length):
        return np.zeros((len(rates), len(rates)))
    fall, apart = np.exp(-rates * length), rates[:, None] - rates
    middle = np.exp(-(rates[:, None] + rates) / 2 * length)
    near = np.abs(apart) * length < tuning.ADJOINT.near
    near_value = length * middle * (1 + (apart * length) ** 2 / 24)
    return np.where(near, near_value, (fall - fall[:, None]) / np.where(near, 1.0, apart))
