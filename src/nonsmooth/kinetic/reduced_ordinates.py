"""The kinetic equation of two state variables in the few combinations of ordinates that matter.

The solutions h(x, .; z) of (z - A) h = g d_x h in a slab, at all depths x and for all z of
interest, lie close to a space of few dimensions. A basis V of it is taken from solutions at a few
real z, found by doubling slabs, by a singular value decomposition. It holds values where g > 0 and
their mirror images, so that what is given at the faces is a combination of V, too. In the inner
product weighted by the invariant measure times |g|, V is orthonormal, and Galerkin's method leaves

    E e = o',    O o = e',    E = V'(z - A)V on even functions, O on odd ones,

for even and odd parts e, o of h in the state. The modes of this small system solve it exactly in x.
"""

from dataclasses import dataclass

import numpy as np

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates


@dataclass(frozen=True)
class ReducedOrdinates:
    """A grid and a basis.

    Attributes
    ----------
    grid : PlaneOrdinates
    basis : numpy.ndarray, shape (k, r)
        Functions on the nodes with g > 0 or their mirror images.
    """

    grid: PlaneOrdinates
    basis: np.ndarray

    def first_passage(self, z: complex, intervals: np.ndarray) -> np.ndarray:
        """E exp(-z tau), tau the first time that int_0^t g leaves an interval.

        Parameters
        ----------
        z : complex
        intervals : numpy.ndarray, shape (m, 2)
            Levels of opposite signs; one of the two may be infinite.

        Returns
        -------
        numpy.ndarray of complex, shape (m,)
        """
        grid, signs = self.grid, np.sign(self.grid.speeds)[:, None]
        parts, weights = grid.eliminated(z), grid.masses[:, None] * self.basis
        even = weights.T @ parts[EVEN].applied(self.basis)
        odd = (signs * weights).T @ parts[ODD].applied(signs * self.basis)
        ones = weights.T @ (np.abs(grid.speeds) * grid.ones[: len(signs)])
        rates, modes = _modes(even, odd)
        rows = parts[EVEN].start_row(), parts[ODD].start_row()
        values = []
        for interval in intervals:
            e, o = _at_start(rates, modes, even, ones, *interval)
            values.append(rows[0] @ (self.basis @ e) + rows[1] @ (signs[:, 0] * (self.basis @ o)))
        return np.array(values).reshape(len(intervals))


def reduced(grid: PlaneOrdinates, fields: np.ndarray, accuracy: float) -> ReducedOrdinates:
    """Choose a basis.

    Parameters
    ----------
    grid : PlaneOrdinates
    fields : numpy.ndarray, shape (k, m)
        Solutions at several depths and z.
    accuracy : float
        Relative size of what is left out.

    Returns
    -------
    ReducedOrdinates
    """
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    ones = flow * grid.ones[: len(flow)]
    ones /= np.linalg.norm(ones)
    weighted = flow[:, None] * fields
    # constants are kept as they are, so that nothing is lost but at the rate z
    left, sizes, _ = np.linalg.svd(weighted - np.outer(ones, ones @ weighted), full_matrices=False)
    kept = left[:, sizes > accuracy * np.linalg.norm(weighted, axis=0).max()]
    return ReducedOrdinates(grid, np.column_stack([ones, kept]) / flow[:, None])


def _at_start(rates, modes, even, ones, lower, upper):
    """Even and odd parts at x = 0, if h = 1 where the flow leaves."""
    other = even @ modes / rates
    if not (np.isfinite(lower) and np.isfinite(upper)):
        decay, side = np.exp(-rates * min(upper, -lower)), 1 if np.isfinite(upper) else -1
        amplitudes = np.linalg.solve(modes + other, ones) * decay
        return modes @ amplitudes, side * other @ amplitudes
    # h is its own mirror image at the centre: e is even in the distance to it, and o is odd
    across, near, far = (np.exp(-rates * d) for d in (upper - lower, upper, -lower))
    amplitudes = np.linalg.solve(modes * (1 + across) + other * (1 - across), ones)
    return modes @ (amplitudes * (near + far)), other @ (amplitudes * (near - far))


def _modes(even, odd):
    """Rates and even parts of the modes, which change in x as exp(rate x).

    Rates squared are eigenvalues of a product, and lie many decades apart. Rounding spoils those
    far below the largest; the inverse of the product has these, and spoils the large ones. Both
    lists are put together where they agree and leave the widest gap.
    """
    fast, fast_modes = _ascending(odd @ even, 1)
    slow, slow_modes = _ascending(np.linalg.solve(even, np.linalg.inv(odd)), -1)
    with np.errstate(divide="ignore", invalid="ignore"):  # what is not a number does not agree
        agree = np.abs(slow / fast - 1) < tuning.REDUCED_ORDINATES.agree
        ratios = np.abs(fast[1:] / fast[:-1])
    gaps = np.where(agree[1:] & agree[:-1], ratios, 0.0)
    cut = 1 + int(np.argmax(gaps)) if len(gaps) else 1  # constants alone have one mode
    squares = np.append(slow[:cut], fast[cut:])
    return np.sqrt(squares), np.hstack([slow_modes[:, :cut], fast_modes[:, cut:]])


def _ascending(matrix, power):
    """Eigenvalues, raised to a power, in ascending order, and eigenvectors."""
    values, vectors = np.linalg.eig(matrix)
    values = values.astype(complex) ** power
    order = np.argsort(np.abs(values))
    return values[order], vectors[:, order].astype(complex)
