"""Inverse Laplace transform on hyperbolic contours.

f(t) = 1/(2 pi i) int exp(z t) F(z) dz by the trapezoidal rule on z(u) = mu (1 + sin(iu - a)), which
converges geometrically for F analytic off a sector around the negative axis. The parameters for
all t in [first, last] are those of Weideman and Trefethen, Math. Comp. 76 (2007) 1341.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar


@dataclass(frozen=True)
class Contour:
    """Nodes in the upper half plane and their weights.

    Attributes
    ----------
    nodes, weights : numpy.ndarray of complex, shape (k,)
    """

    nodes: np.ndarray
    weights: np.ndarray

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


def hyperbola(first, last, count, sector=0.0):
    """Choose the contour for times between `first` and `last`.

    Parameters
    ----------
    first, last : float
    count : int
        Number of nodes in the upper half plane.
    sector : float
        F is analytic where |arg(-z)| > sector.

    Returns
    -------
    Contour
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
    u = (np.arange(count) + 0.5) * step
    return Contour(mu * (1 + np.sin(1j * u - a)), mu * step / np.pi * 1j * np.cos(1j * u - a))
