"""Composite Gauss-Legendre quadrature: intervals with 20 points each, and running integrals.

A function is known by its values at the Gauss points. On each interval it is replaced by the
polynomial through them, whose Legendre coefficients tell whether the interval is short enough.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

POINTS = 20  # Gauss points of an element; `tuning.QUADRATURE.steepest` says why so many suffice

NODES, WEIGHTS = legendre.leggauss(POINTS)
# matrices that act on values at the nodes: to Legendre coefficients, to integrals from the left
# end of the element up to each node, to integrals from each node to the right end, to derivatives
MODES = legendre.legvander(NODES, POINTS - 1).T * WEIGHTS * (np.arange(POINTS)[:, None] + 0.5)
FROM_LEFT = legendre.legval(NODES, legendre.legint(np.eye(POINTS), lbnd=-1)).T @ MODES
FROM_RIGHT = WEIGHTS - FROM_LEFT
SLOPES = legendre.legval(NODES, legendre.legder(np.eye(POINTS))).T @ MODES


@dataclass(frozen=True)
class GaussElements:
    """Intervals, increasing, with an edge at 0, and two functions at their Gauss points.

    Attributes
    ----------
    left, right : numpy.ndarray, shape (k,)
        Ends of the intervals.
    points : numpy.ndarray, shape (k, POINTS)
        Gauss points.
    depth, g : numpy.ndarray, shape (k, POINTS)
        Phi, of `potential`, and the observable.
    """

    left: np.ndarray
    right: np.ndarray
    points: np.ndarray
    depth: np.ndarray
    g: np.ndarray

    @property
    def half(self) -> np.ndarray:
        """Half the lengths, shape (k, 1)."""
        return (self.right - self.left)[:, None] / 2

    @property
    def mass(self) -> np.ndarray:
        """Quadrature weights times exp(-Phi)."""
        return self.half * WEIGHTS * np.exp(-self.depth)

    @property
    def first_right(self) -> int:
        """Index of the first interval right of 0."""
        return int(np.searchsorted(self.left, 0.0))

    def from_ends(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Integrate from a point to the end of the axis on its own side of 0.

        Parameters
        ----------
        values : numpy.ndarray, shape (k, POINTS)
            The integrand times half the length of the element.

        Returns
        -------
        at_points : numpy.ndarray, shape (k, POINTS)
            int_y^end for y > 0, int_-end^y for y < 0.
        at_edges : numpy.ndarray, shape (k,)
            The same, at the edge of each element that is farther from 0.
        """
        zero = self.first_right
        left, left_edges = _running(values[:zero], False)
        right, right_edges = _running(values[zero:], True)
        return np.concatenate([left, right]), np.concatenate([left_edges, right_edges])

    def from_middle(self, values: np.ndarray) -> np.ndarray:
        """Integrate between 0 and a point: int_0^y for y > 0, int_y^0 for y < 0.

        Parameters
        ----------
        values : numpy.ndarray, shape (k, POINTS)
            The integrand times half the length of the element.

        Returns
        -------
        numpy.ndarray, shape (k, POINTS)
        """
        zero = self.first_right
        return np.concatenate([_running(values[:zero], True)[0], _running(values[zero:], False)[0]])


def _running(values, backward):
    """Integrals from the left end, or to the right end, at the Gauss points and at the edges."""
    whole = values @ WEIGHTS
    if backward:
        edge = np.append(np.cumsum(whole[:0:-1])[::-1], 0.0)
        return values @ FROM_RIGHT.T + edge[:, None], edge
    edge = np.append(0.0, np.cumsum(whole[:-1]))
    return values @ FROM_LEFT.T + edge[:, None], edge
