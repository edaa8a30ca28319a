"""The martingale of the Poisson solution as a control variate.

A control variate is a random variable of known mean that is correlated with the one whose mean is
wanted; subtracting a multiple of it reduces the standard error. From -A u = g - E g follows

    int_0^t g - t E g = u(Z_0) - u(Z_t) + M(t),    M(t) = int_0^t sigma u'(Y) dW.

M and M^2 - <M> have the mean zero and, over long times, carry almost all of the variance of the
integral and of its square. Their means are exactly zero for the time-stepping scheme, too: each
step adds to M a polynomial of the step's noise whose mean is zero given the past.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.polynomial import Polynomial, chebyshev

from nonsmooth.line import eigenfunctions, potential
from nonsmooth.paths import tuning
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene

DEGREE = 4  # of the polynomials in place of u' that kernels evaluate; they are off by 1 % or so


@dataclass(frozen=True)
class PoissonSlope:
    """A table of u', the slope of the Poisson solution of a scene.

    Attributes
    ----------
    reach : float
        The table covers [-reach, reach].
    values, density : numpy.ndarray
        u' and the invariant density, up to a factor, at equidistant points.
    """

    reach: float
    values: np.ndarray
    density: np.ndarray

    def polynomials(self, spread: float) -> np.ndarray:
        """Fit u', averaged over a normal kick, by polynomials in |y| / reach.

        A kick changes u by a random amount. Its part that is linear in the kick has the averaged u'
        as its coefficient, and its quadratic part the averaged u''. Each side of y = 0 has a
        polynomial of its own, because u' bends at the kink of dry friction.

        Parameters
        ----------
        spread : float
            Standard deviation of the kick, "1".

        Returns
        -------
        numpy.ndarray, shape (2, DEGREE + 1)
            Coefficients for y < 0 and for y >= 0, the constants first.
        """
        spacing = 2 * self.reach / (len(self.values) - 1)
        averaged = scipy.ndimage.gaussian_filter1d(self.values, spread / spacing, mode="nearest")
        weight = np.sqrt(self.density)
        middle = len(averaged) // 2
        fits = [
            chebyshev.Chebyshev.fit(
                np.linspace(0, 1, middle + 1), averaged[side], DEGREE, [0, 1], w=weight[side]
            )
            for side in (slice(middle, None, -1), slice(middle, None))
        ]
        return np.array([fit.convert(kind=Polynomial).coef for fit in fits])


@lru_cache(maxsize=64)
def poisson_slope(scene: Scene) -> PoissonSlope | None:
    """Tabulate u' of a one-dimensional scene with white noise.

    The equation (m u')' = -2/sigma^2 (g - E g) m is integrated from the nearer end of the axis.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    PoissonSlope or None
        None if the scene has another state or noise.
    """
    if not scene.is_line:
        return None
    depth = potential.depth(scene)
    reach = 1.0
    while depth(reach / 1.1) > tuning.CONTROL_VARIATE.depth:
        reach /= 1.1
    while depth(reach) < tuning.CONTROL_VARIATE.depth:
        reach *= 1.1
    y = np.linspace(-reach, reach, tuning.CONTROL_VARIATE.points)
    density = np.exp(-depth(y))
    g = vectorised(scene.numerical_observable(), (symbols.y,))(y) - eigenfunctions.mean(scene)
    left = scipy.integrate.cumulative_simpson(g * density, x=y, initial=0)
    flux = np.where(y < 0, -left, left[-1] - left)
    return PoissonSlope(reach, 2 / scene.noise.sigma**2 * flux / density, density)
