"""Inverse Laplace transform on hyperbolic contours.

f(t) = 1/(2 pi i) int exp(z t) F(z) dz by the trapezoidal rule on z(u) = z_0 + mu sin(iu - a), which
converges geometrically for F analytic off a sector around the negative axis. The parameters for
all t in [first, last] are those of Weideman and Trefethen, Math. Comp. 76 (2007) 1341; where f is
small, a contour through the saddle point of exp(z t) F(z) keeps relative accuracy.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

_SPARE = 3  # times the nodes, where F grows off the axis
_FARTHEST = 7.0  # parameter of its last node, exp(7) / 2 saddles away


@dataclass(frozen=True)
class Contour:
    """Nodes in the upper half plane and their weights.

    Attributes
    ----------
    nodes, weights : numpy.ndarray of complex, shape (k,)
    """

    nodes: np.ndarray
    weights: np.ndarray

    def until(self, count):
        """Drop the nodes beyond the first `count`."""
        return Contour(self.nodes[:count], self.weights[:count])

    def invert(self, transform, times):
        """Sum the trapezoidal rule.

        Parameters
        ----------
        transform : numpy.ndarray of complex, shape (k,)
            F at the nodes; F is real on the real axis.
        times : numpy.ndarray, shape (t,)

        Returns
        -------
        numpy.ndarray, shape (t,)
        """
        return (np.exp(np.outer(times, self.nodes)) @ (self.weights * transform)).imag


def hyperbola(first, last, count, sector=0.0, pole=0.0):
    """Choose the contour for times between `first` and `last`.

    Parameters
    ----------
    first, last : float
    count : int
        Number of nodes in the upper half plane that times between would need, were F constant.
    sector : float
        F is analytic where |arg(pole - z)| > sector.
    pole : float
        Rightmost point of that sector, at most 0.

    Returns
    -------
    Contour
        Of more nodes than needed, from the axis on: stop where the terms are negligible.
    """
    ratio = last / first

    def reach(a):
        return np.arccosh(
            ((np.pi - 2 * a - 2 * sector) * ratio + 4 * a - np.pi + 2 * sector)
            / ((4 * a - np.pi + 2 * sector) * np.sin(a))
        )

    def slowness(a):
        return -(np.pi**2 - 2 * np.pi * a - 2 * np.pi * sector) / reach(a)

    least, most = np.pi / 4 - sector / 2, np.pi / 2 - sector
    margin = 1e-6 * (most - least)
    a = minimize_scalar(slowness, bounds=(least + margin, most - margin), method="bounded").x
    step = reach(a) / count
    mu = (4 * np.pi * a - np.pi**2 + 2 * np.pi * sector) / reach(a) * count / last
    u = (np.arange(_SPARE * count) + 0.5) * step
    nodes = pole + mu * (1 + np.sin(1j * u - a))
    return Contour(nodes, mu * step / np.pi * 1j * np.cos(1j * u - a))


def through_saddle(saddle, width, spacing, tilt):
    """Choose the contour that crosses the axis at the saddle point of exp(z t) F(z).

    Parameters
    ----------
    saddle : float
        Positive.
    width : float
        Standard deviation of exp(z t) F(z) along the contour, were it normal.
    spacing : float
        Of the nodes, relative to what ten digits need.
    tilt : float
        Angle of the asymptotes to the left of the vertical.

    Returns
    -------
    Contour
        Of more nodes than needed, from the axis on: stop where the terms are negligible.
    """
    # a normal integrand sampled at 0.85 standard deviations, a pole at 0 at a quarter of the saddle
    near = spacing * min(0.85 * width, 0.25 * saddle)
    # steep arms leave less room beside them in which F does not grow
    near *= min(1.0, 0.45 + tilt / 0.7)
    step = near / (saddle * np.cos(tilt))
    u = (np.arange(int(_FARTHEST / step)) + 0.5) * step
    bend = np.sin(1j * u - tilt)
    nodes = saddle * (1 + bend + np.sin(tilt))
    return Contour(nodes, saddle * step / np.pi * 1j * np.cos(1j * u - tilt))
