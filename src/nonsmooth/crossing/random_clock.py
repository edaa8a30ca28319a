"""The random clock on which Brownian motion disperses like the integral of g, to order 2.

The clock shows the greatest value that t + sqrt(2 beta) W(t) has had so far; beta > 0 is its
spread. It reaches s at an inverse Gaussian time of the mean s and the variance 2 beta s. A passage
that Brownian motion makes at the time s is seen at that time, and the Laplace transform exp(-z s)
of its law becomes exp(-w s) with z = w + beta w^2. See `docs/methods/crossing.md`.
"""

from collections.abc import Callable

import numpy as np
from scipy.special import erfcx

from nonsmooth.crossing import tuning


def averaged(
    function: Callable[[np.ndarray], np.ndarray], times: np.ndarray, spread: float
) -> np.ndarray:
    """Mean of a function at the random clock.

    Parameters
    ----------
    function : callable
        Takes clocks > 0 of any shape; bounded, and 0 with all its derivatives at 0.
    times : numpy.ndarray, shape (k,)
        "1"; 0 is returned where they are not positive.
    spread : float
        beta >= 0, "1"; the clock is the time itself if it is 0.

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
    root = 2 * np.sqrt(spread * t)  # standard deviation times sqrt(2)
    reach = tuning.RANDOM_CLOCK.reach / np.sqrt(2) * root
    # equal steps of the square root: the function may rise over a time much shorter than the reach.
    # Distances are from its middle: the reach may be as small as the rounding of the time
    middle = np.sqrt(t)
    before = np.minimum(reach, t) / (middle + np.sqrt(np.maximum(t - reach, 0.0)))
    step = (before + reach / (middle + np.sqrt(t + reach))) / tuning.RANDOM_CLOCK.nodes
    beyond = step * np.arange(1, tuning.RANDOM_CLOCK.nodes + 1) - before
    place, later = middle + beyond, beyond * (2 * middle + beyond)
    clock = t + later
    density = np.exp(-((later / root) ** 2)) * (
        2 / (np.sqrt(np.pi) * root) - erfcx((clock + t) / root) / (2 * spread)
    )
    mean[late] = np.sum(2 * place * step * density * function(clock), axis=1)
    return mean
