"""Order 1 of the corrected formula for a g of nonzero mean: Brownian motion with a drift.

With the mean m of g and the constants D and C of g - m, the logarithm of E exp(q int_0^t g) grows
like Lambda(q) t, Lambda = m q + D q^2 + C q^3. Weighted by exp(q int_0^t g - Lambda(q) t), paths
have the drift Lambda'(q). At the minimum of Lambda none is left, and the formulas without a drift
hold, with the diffusion Lambda''(q) / 2 and the same C. Each passage of a level a at a time t then
counts exp(Lambda(q) t - q a).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.crossing import tuning

_gauss = cache(np.polynomial.legendre.leggauss)


@dataclass(frozen=True)
class Tilt:
    """The weight that takes the drift away.

    Attributes
    ----------
    exponent : float
        q.
    rate : float
        Lambda(q), not positive.
    diffusion : float
        That of the weighted paths.
    """

    exponent: float
    rate: float
    diffusion: float

    def passed(
        self, still: Callable[[np.ndarray], np.ndarray], level: float, times: np.ndarray
    ) -> np.ndarray:
        """Probability of a passage with the drift.

        Parameters
        ----------
        still : callable
            Probability that weighted paths have passed the level before times of any shape.
        level : float
            From the start; negative for the lower one.
        times : numpy.ndarray, shape (k,)
            "1", positive.

        Returns
        -------
        numpy.ndarray, shape (k,)
            The integral of exp(Lambda t - q a) with respect to the passages, by parts.
        """
        settings = tuning.DRIFT
        first = np.minimum(level**2 / (4 * self.diffusion * settings.deepest), times)
        nodes, weights = _gauss(settings.nodes)
        width = np.log(times / first)[:, None]
        at = first[:, None] * np.exp(width * (nodes + 1) / 2)
        shrunk = np.exp(self.rate * at - self.exponent * level) * still(at)
        now = np.exp(self.rate * times - self.exponent * level) * still(times)
        return now - self.rate * np.sum(width * weights / 2 * at * shrunk, axis=1)


def tilt(constants: LayerConstants) -> Tilt:
    """Find the minimum of Lambda; not a number if the drift is so large that it has none.

    Parameters
    ----------
    constants : LayerConstants
    """
    m, D, C = constants.mean, constants.diffusion, constants.skewness
    square = D**2 - 3 * m * C
    diffusion = math.sqrt(square) if square > 0 else math.nan
    q = -m / (D + diffusion)
    return Tilt(q, m * q + D * q**2 + C * q**3, diffusion)
