"""Threshold crossing of Brownian motion."""

import numpy as np
import scipy

_TERMS = np.arange(12)
_SWITCH = 0.5  # in T/b^2: both series then need at most six terms for 16 digits


def brownian_crossing(b, T):
    """Probability that |W| reaches b before T, W_star of eq. (defFexplicit).

    For T/b^2 above 1/2 the paper's eigenfunction series; below, where that series loses all
    relative accuracy, its theta dual, 2 sum_k (-1)^k erfc((2k+1) b / sqrt(2T)).

    Parameters
    ----------
    b : array_like
        Threshold, "1"; positive.
    T : array_like
        Horizon, "1"; non-negative.

    Returns
    -------
    numpy.ndarray
        W_star(b, T), of the shape `b` and `T` broadcast to.
    """
    b, T = np.broadcast_arrays(np.asarray(b, dtype=float), np.asarray(T, dtype=float))
    ratio = (T / b**2)[..., None]
    odd, sign = 2 * _TERMS + 1, (-1.0) ** _TERMS
    with np.errstate(divide="ignore", under="ignore"):
        late = 1 - 4 / np.pi * np.sum(
            sign / odd * np.exp(-((odd * np.pi) ** 2) * ratio / 8), axis=-1
        )
        early = 2 * np.sum(sign * scipy.special.erfc(odd / np.sqrt(2 * ratio)), axis=-1)
    return np.where(ratio[..., 0] > _SWITCH, late, early)


def asymptotic_crossing(threshold, horizons, variance, variance_error):
    """W_star(b / gamma, T) and the error it inherits from gamma^2."""
    value, below, above = (
        brownian_crossing(threshold / np.sqrt(variance + shift), horizons)
        for shift in (0.0, -variance_error, variance_error)
    )
    return value, np.maximum(np.abs(above - value), np.abs(value - below)) + 4e-16
