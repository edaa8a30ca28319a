"""Spectral elements in one variable: nodal polynomials between edges, with their derivatives.

A variable that noise drives gets continuous elements, on which the second derivative is the weak
one. A variable that is only transported gets discontinuous elements. There the sign of the drift on
a face decides from which side a value is taken (upwinding), so that a function may jump at a face
without oscillating in the elements next to it.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from numpy.polynomial import legendre
from numpy.typing import ArrayLike
from scipy.special import roots_jacobi

from nonsmooth.errors import ToleranceError


@dataclass(frozen=True)
class Axis:
    """Nodes of one variable and the matrices that act on functions of it.

    Attributes
    ----------
    edges : numpy.ndarray, shape (e + 1,)
        Of the elements.
    local : tuple of numpy.ndarray, shapes (d + 1,)
        Nodes of each element, mapped to [-1, 1].
    nodes, weights : numpy.ndarray, shape (k,)
        Increasing nodes and the quadrature weights that belong to them.
    slope : scipy.sparse.csr_array, shape (k, k)
        First derivative: within the elements, averaged at the edges of continuous ones.
    curvature : scipy.sparse.csr_array, shape (k, k), or None
        Weak second derivative with zero slope at both ends; None on discontinuous elements.
    release : scipy.sparse.csr_array, shape (k, k), or None
        What is added to `curvature` at an end where the slope is not set to zero.
    faces : numpy.ndarray, shape (f,)
        Where functions may jump.
    jump : scipy.sparse.csr_array, shape (f, k)
        Value right of each face minus the value left of it.
    lift_left, lift_right : scipy.sparse.csr_array, shape (k, f)
        What a unit jump adds to the derivative in the element left of the face, if that element
        takes its value from the right; and in the element right of it, if from the left.
    normal : float or None
        Standard deviation of the normal law to which the weights belong, if they do not belong to
        lengths.
    """

    edges: np.ndarray
    local: tuple[np.ndarray, ...]
    nodes: np.ndarray
    weights: np.ndarray
    slope: sp.csr_array
    curvature: sp.csr_array | None
    release: sp.csr_array | None
    faces: np.ndarray
    jump: sp.csr_array
    lift_left: sp.csr_array
    lift_right: sp.csr_array
    normal: float | None = None

    def densities(self, points: ArrayLike) -> np.ndarray:
        """Matrix that takes masses at the nodes to the density of their measure at points.

        Parameters
        ----------
        points : array_like, shape (q,)

        Returns
        -------
        numpy.ndarray, shape (q, k)
        """
        found = self.interpolation(points).toarray() / self.weights
        if self.normal is None:
            return found
        z = np.asarray(points, dtype=float) / self.normal
        return np.exp(-(z**2) / 2)[:, None] / (np.sqrt(2 * np.pi) * self.normal) * found

    def interpolation(self, points: ArrayLike) -> sp.csr_array:
        """Matrix that takes nodal values to values at points, 0 outside.

        Parameters
        ----------
        points : array_like, shape (q,)

        Returns
        -------
        scipy.sparse.csr_array, shape (q, k)
        """
        points = np.atleast_1d(np.asarray(points, dtype=float))
        inside = (points >= self.edges[0]) & (points <= self.edges[-1])
        element = np.clip(np.searchsorted(self.edges, points, "right") - 1, 0, len(self.local) - 1)
        shared = self.curvature is not None  # neighbouring continuous elements share a node
        first = np.cumsum([0] + [len(local) - shared for local in self.local])
        values, rows, columns = [np.empty(0)], [np.empty(0, int)], [np.empty(0, int)]
        for e in np.unique(element[inside]):
            here = np.flatnonzero(inside & (element == e))
            left, right = self.edges[e : e + 2]
            of_element, _ = lagrange(
                self.local[e], (2 * points[here] - left - right) / (right - left)
            )
            nodes = first[e] + np.arange(len(self.local[e]))
            values.append(of_element.ravel())
            rows.append(np.repeat(here, len(nodes)))
            columns.append(np.tile(nodes, len(here)))
        entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
        return sp.csr_array(entries, shape=(len(points), len(self.nodes)))


@lru_cache(maxsize=64)
def lobatto(degree: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gauss-Lobatto nodes, weights and the derivative matrix on [-1, 1]."""
    inner, _ = roots_jacobi(degree - 1, 1, 1)  # the zeros of the Legendre polynomial's slope
    nodes = np.concatenate([[-1.0], inner, [1.0]])
    last = legendre.legval(nodes, [0] * degree + [1])
    return nodes, 2 / (degree * (degree + 1) * last**2), lagrange(nodes, nodes)[1]


def lagrange(nodes: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values and slopes at `points` of the polynomials that are 1 at one node, 0 at the others.

    Parameters
    ----------
    nodes : numpy.ndarray, shape (k,)
    points : numpy.ndarray, shape (q,)
        Both in [-1, 1].

    Returns
    -------
    values, slopes : numpy.ndarray, shape (q, k)
    """
    degree = len(nodes) - 1
    modes = np.linalg.inv(legendre.legvander(nodes, degree))
    values = legendre.legvander(points, degree) @ modes
    return values, legendre.legval(points, legendre.legder(modes)).T


def summed(blocks: Iterable[np.ndarray]) -> np.ndarray:
    """Assemble the matrix of continuous elements from the matrices of the single elements.

    Parameters
    ----------
    blocks : iterable of numpy.ndarray, shape (d + 1, d + 1)
        From left to right; the last node of each element is the first of the next.

    Returns
    -------
    numpy.ndarray, shape (e d + 1, e d + 1)

    Raises
    ------
    ToleranceError
        If the memory does not hold it.
    """
    blocks = list(blocks)
    degree = len(blocks[0]) - 1
    size = len(blocks) * degree + 1
    try:
        matrix = np.zeros((size, size))
    except MemoryError:
        raise ToleranceError(
            f"the memory does not hold a matrix of {size} equations; choose parameters of more "
            "similar sizes, a larger tol or Monte Carlo"
        ) from None
    for e, block in enumerate(blocks):
        here = slice(e * degree, (e + 1) * degree + 1)
        matrix[here, here] += block
    return matrix


def energy(slopes: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Integrate products of slopes over one element, sum_q w_q phi_i'(q) phi_j'(q).

    Constants have no energy, so that the rows sum to zero. This is enforced, because rounding in
    the narrowest elements costs digits.

    Parameters
    ----------
    slopes : numpy.ndarray, shape (q, d + 1)
        At the points of quadrature.
    weights : numpy.ndarray, shape (q,)

    Returns
    -------
    numpy.ndarray, shape (d + 1, d + 1)
    """
    block = slopes.T @ (weights[:, None] * slopes)
    return block - np.diag(block.sum(axis=1))


def continuous(edges: np.ndarray, degree: int, closed: bool = False) -> Axis:
    """Make continuous elements with Gauss-Lobatto nodes (lumped mass matrix).

    Parameters
    ----------
    edges : numpy.ndarray, shape (e + 1,)
    degree : int
        At least 2.
    closed : bool
        Whether no slope is ever released, so that no mass passes the ends.

    Returns
    -------
    Axis
        With e * degree + 1 nodes and no faces.
    """
    points, quadrature, derivative = lobatto(degree)
    half, middle = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
    size = len(half) * degree + 1
    nodes, weights = np.empty(size), np.zeros(size)
    for e in range(len(half)):
        here = slice(e * degree, (e + 1) * degree + 1)
        nodes[here] = middle[e] + half[e] * points
        weights[here] += half[e] * quadrature
    first = summed([quadrature[:, None] * derivative] * len(half))
    square = derivative.T @ (quadrature[:, None] * derivative)
    second = summed([-square / h for h in half])
    release = np.zeros((size, size))
    if not closed:
        release[0, : degree + 1] -= derivative[0] / half[0]
        release[-1, -degree - 1 :] += derivative[-1] / half[-1]
    none = sp.csr_array((0, size))
    return Axis(
        edges,
        (points,) * len(half),
        nodes,
        weights,
        sp.csr_array(first / weights[:, None]),
        sp.csr_array(second / weights[:, None]),
        sp.csr_array(release / weights[:, None]),
        np.empty(0),
        none,
        none.T.tocsr(),
        none.T.tocsr(),
    )


def discontinuous(edges: np.ndarray, degrees: int | np.ndarray) -> Axis:
    """Make discontinuous elements with Gauss nodes, exact for drifts linear in each element.

    Parameters
    ----------
    edges : numpy.ndarray, shape (e + 1,)
    degrees : int or numpy.ndarray of int, shape (e,)
        Of all elements, or of each.

    Returns
    -------
    Axis
        With degree + 1 nodes for each element, and e - 1 faces.
    """
    degrees = np.broadcast_to(degrees, len(edges) - 1)
    half, middle = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
    elements = [_gauss(int(degree)) for degree in degrees]
    ends = np.cumsum(degrees + 1)
    jump = np.zeros((len(half) - 1, ends[-1]))
    lift_left, lift_right = np.zeros((2, ends[-1], len(half) - 1))
    for f in range(len(half) - 1):
        before = slice(ends[f] - degrees[f] - 1, ends[f])
        after = slice(ends[f], ends[f + 1])
        right, left = elements[f].right, elements[f + 1].left
        jump[f, before], jump[f, after] = -right, left
        lift_left[before, f] = right / (elements[f].weights * half[f])
        lift_right[after, f] = left / (elements[f + 1].weights * half[f + 1])
    slopes = [element.slope / h for element, h in zip(elements, half, strict=True)]
    return Axis(
        edges,
        tuple(element.nodes for element in elements),
        np.concatenate([m + h * e.nodes for m, h, e in zip(middle, half, elements, strict=True)]),
        np.concatenate([h * e.weights for h, e in zip(half, elements, strict=True)]),
        sp.csr_array(sp.block_diag(slopes)),
        None,
        None,
        edges[1:-1],
        sp.csr_array(jump),
        sp.csr_array(lift_left),
        sp.csr_array(lift_right),
    )


@dataclass(frozen=True)
class _Gauss:
    """Gauss nodes on [-1, 1], weights, derivative, and the rows of the values at both ends."""

    nodes: np.ndarray
    weights: np.ndarray
    slope: np.ndarray
    left: np.ndarray
    right: np.ndarray


@lru_cache(maxsize=64)
def _gauss(degree):
    nodes, weights = legendre.leggauss(degree + 1)
    left, right = lagrange(nodes, np.array([-1.0, 1.0]))[0]
    return _Gauss(nodes, weights, lagrange(nodes, nodes)[1], left, right)
