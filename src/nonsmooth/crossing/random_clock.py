"""The random clock that disperses Brownian motion as the memory of the velocity does.

The greatest value that t + sqrt(2 b) W(t) has had, b > 0 the spread. Passages at the times s are
then seen at the times at which it reaches s, which are inverse Gaussian, of the mean s and the
variance 2 b s: exp(-z s) becomes exp(-w s) with z = w + b w^2.
"""

import numpy as np
from scipy.special import erfcx

_FARTHEST = 8.2  # standard deviations beyond which less than 1e-15 is left
_NODES = 80  # of the trapezoidal rule, exact to rounding for what is smooth and ends at 0


def averaged(function, times, spread):
    """Mean of a function at the random clock.

    Parameters
    ----------
    function : callable
        Takes clocks > 0 of any shape; bounded, and 0 with all its derivatives at 0.
    times : numpy.ndarray, shape (k,)
        "1"; 0 is returned where they are not positive.
    spread : float
        b >= 0; the clock is the time itself if it is 0.

    Returns
    -------
    numpy.ndarray, shape (k,)
    """
    mean = np.zeros(len(times))
    late = times > 0
    if not late.any():
        return mean
    if spread == 0:
        mean[late] = function(times[late])
        return mean
    t = times[late, None]
    root = 2 * np.sqrt(spread * t)  # standard deviations times sqrt(2)
    reach = _FARTHEST / np.sqrt(2) * root
    # equal steps of the square root: what the function rises over may be short against the reach
    first = np.sqrt(np.maximum(t - reach, 0.0))
    step = (np.sqrt(t + reach) - first) / _NODES
    place = first + step * np.arange(1, _NODES + 1)
    clock = place**2
    density = np.exp(-(((clock - t) / root) ** 2)) * (
        2 / (np.sqrt(np.pi) * root) - erfcx((clock + t) / root) / (2 * spread)
    )
    mean[late] = np.sum(2 * place * step * density * function(clock), axis=1)
    return mean
