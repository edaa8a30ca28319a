"""The kinetic equation of two state variables in the few combinations of ordinates that matter.

The solutions h(x, .; z) of (z - A) h = g d_x h in a slab, at all depths x and for all z of
interest, lie close to a space of few dimensions. A basis V of it is taken from solutions at a few
real z (`fields`), and from those of the adjoint equation with a source at the start, by a singular
value decomposition. It holds values where g > 0 and their mirror images, so that what is given at
the faces is a combination of V, too. In the inner product weighted by the invariant measure times
|g|, V is orthonormal, and Galerkin's method leaves

    E e = o',    O o = e',    E = V'(z - A)V on even functions, O on odd ones,

for even and odd parts e, o of h in the state. The modes of this small system solve it exactly in x.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates
from nonsmooth.linear_algebra.effort import of_modes, spend

Matrix: TypeAlias = np.ndarray | sp.sparray


class Fields(NamedTuple):
    """Functions from which a basis is taken, on the nodes with g > 0 or their mirror images.

    Attributes
    ----------
    solutions : numpy.ndarray, shape (k, m)
        h at many depths.
    adjoint : numpy.ndarray, shape (k, l)
        Solutions of the adjoint equation with a source at the start, by which values of h there
        depend on what is left of the equation elsewhere. Their scale does not matter.
    """

    solutions: np.ndarray
    adjoint: np.ndarray


def joined(fields: Sequence[Fields]) -> Fields:
    """Put functions of several z or slabs together."""
    return Fields(*(np.hstack(part) for part in zip(*fields, strict=True)))


@dataclass(frozen=True)
class ReducedOrdinates:
    """A grid and a basis.

    Attributes
    ----------
    grid : PlaneOrdinates
    basis : numpy.ndarray or sparse array, shape (k, r)
        Functions on the nodes with g > 0 or their mirror images.
    """

    grid: PlaneOrdinates
    basis: Matrix

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
        modes = self.modes(z)
        return np.array([modes.at_start(*interval) for interval in intervals])

    def functions(self, parity: int) -> Matrix:
        """Basis of even or of odd functions, on the nodes that move; shape (k, r)."""
        return self.basis if parity == EVEN else np.sign(self.grid.speeds)[:, None] * self.basis

    def tests(self, parity: int) -> Matrix:
        """Functions by which equations are tested, weighted by the masses; shape (r, k)."""
        return (self.grid.masses[:, None] * self.functions(parity)).T

    def eliminated(self, z: complex) -> dict[int, "Eliminated"]:
        """Compute E and O from the parities of functions, at a place z."""
        return {parity: part.at(z) for parity, part in self._projected.items()}

    @cached_property
    def _projected(self):
        """The generator between the functions of each parity and the nodes that stand still."""
        return {p: _Projected(self.grid, p, self.functions(p), self.tests(p)) for p in (EVEN, ODD)}

    def modes(self, z: complex) -> "ReducedModes":
        """Compute the modes at a place z.

        Raises
        ------
        ToleranceError
            If the limit of the `effort` does not cover it.
        """
        eliminated = self.eliminated(z)
        on_even, on_odd = eliminated[EVEN], eliminated[ODD]
        flow = np.abs(self.grid.speeds) * self.grid.ones[: len(self.grid.speeds)]
        spend(of_modes(on_even.matrix))
        rates, even = _modes(on_even.matrix, on_odd.matrix)
        odd = on_even.matrix @ even / rates
        ones, decays = self.tests(EVEN) @ flow, _decaying(rates, self.grid.way)
        return ReducedModes(rates, even, odd, ones, on_even.row, on_odd.row, decays, eliminated)


class Eliminated(NamedTuple):
    """(z - A) h on the nodes that move, tested, for functions h that solve it at the others.

    Attributes
    ----------
    matrix : numpy.ndarray, shape (r, r)
    row : numpy.ndarray, shape (r,)
        It interpolates at the start.
    still : scipy.sparse.linalg.SuperLU, optional
        Factors of z - A on the nodes that stand still, if there are any.
    inside : numpy.ndarray, shape (s, r), optional
        The functions there.
    out : numpy.ndarray or sparse array, shape (r, s), optional
        A from there to the tests.
    """

    matrix: np.ndarray
    row: np.ndarray
    still: spla.SuperLU | None = None
    inside: np.ndarray | None = None
    out: Matrix | None = None


class _Projected:
    """The generator between functions of one parity, tests, and the nodes that stand still.

    What does not depend on z is computed once, so that the time for each z does not grow with the
    number of nodes that move.

    Parameters
    ----------
    grid : PlaneOrdinates
    parity : {ODD, EVEN}
    functions, tests : numpy.ndarray or sparse array, shape (k, r) and (r, k)
    """

    def __init__(self, grid: PlaneOrdinates, parity: int, functions: Matrix, tests: Matrix):
        A, row, many = grid.generator[parity].tocsr(), grid.start[parity], len(grid.speeds)
        self._masses = _dense(tests @ functions)
        self._moving = _dense(tests @ (A[:many, :many] @ functions))
        self._out, self._into = (A[:many, many:].T @ tests.T).T, A[many:, :many] @ functions
        self._still = A[many:, many:].tocsc()
        self._row, self._row_inside = functions.T @ row[:many], row[many:]

    def at(self, z: complex) -> Eliminated:
        """Eliminate the nodes that stand still."""
        matrix, many = z * self._masses - self._moving, self._still.shape[0]
        if many == 0:
            return Eliminated(matrix, self._row)
        standing = (z * sp.eye_array(many, format="csc") - self._still).tocsc()
        still = spla.splu(standing)
        inside = still.solve(_dense(self._into).astype(standing.dtype))
        row = self._row + self._row_inside @ inside
        return Eliminated(matrix - self._out @ inside, row, still, inside, self._out)


def _dense(matrix):
    """Return a matrix that may be sparse as an array."""
    return matrix.toarray() if sp.issparse(matrix) else matrix


@dataclass(frozen=True)
class ReducedModes:
    """Solutions of E e = o' and O o = e' that change in x as exp(rate x), at a place z.

    Attributes
    ----------
    rates : numpy.ndarray, shape (r,)
        Of positive real part; for each of them, the mode with the opposite rate is this one with
        the opposite sign of its odd part.
    even, odd : numpy.ndarray, shape (r, r)
        Modes in columns.
    ones : numpy.ndarray, shape (r,)
        The function 1.
    even_row, odd_row : numpy.ndarray, shape (r,)
        They interpolate at the start.
    decays : numpy.ndarray, shape (r,)
        Rates at which the modes are taken to decay.
    eliminated : dict
        E and O from parities.
    """

    rates: np.ndarray
    even: np.ndarray
    odd: np.ndarray
    ones: np.ndarray
    even_row: np.ndarray
    odd_row: np.ndarray
    decays: np.ndarray
    eliminated: dict[int, Eliminated]

    def at_start(self, lower: float, upper: float) -> complex:
        """Value at x = 0 and the start, if it is 1 where the flow leaves an interval."""
        if np.isinf(upper):
            return self.mirrored().at_start(-np.inf, -lower)
        strengths = np.linalg.solve(self.at_wall(upper - lower), self.ones)
        return self.value(self.left(upper) * strengths, self.left(-lower) * strengths)

    def mirrored(self) -> "ReducedModes":
        """Exchange above and below, for one wall: the other one is infinitely far."""
        return replace(self, odd_row=-self.odd_row)

    def left(self, distance: float) -> np.ndarray:
        """Parts of the modes that are left at a distance, 0 at an infinite one."""
        return np.exp(-self.decays * distance) if np.isfinite(distance) else 0.0 * self.decays

    def along(self, distances: np.ndarray) -> np.ndarray:
        """Parts of the modes that are left at several distances; shape (r, m)."""
        return np.array([self.left(distance) for distance in distances]).T

    def at_wall(self, length: float) -> np.ndarray:
        """Values where the flow leaves at one wall, if the strengths at both walls are the same."""
        across = self.left(length)
        return self.even * (1 + across) + self.odd * (1 - across)

    def value(self, above: np.ndarray, below: np.ndarray) -> complex:
        """Value at the start, of parts of the modes that decay from above and from below."""
        even, odd = self.even @ (above + below), self.odd @ (above - below)
        return self.even_row @ even + self.odd_row @ odd


def reduced(
    grid: PlaneOrdinates, fields: Fields, accuracy: float, adjoint: float
) -> ReducedOrdinates:
    """Choose a basis.

    Parameters
    ----------
    grid : PlaneOrdinates
    fields : Fields
        At several z.
    accuracy, adjoint : float
        Relative sizes of what is left out of solutions, and of adjoint ones. An error at the start
        is about the product of both.

    Returns
    -------
    ReducedOrdinates
    """
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    ones = flow * grid.ones[: len(flow)]
    in_units = []
    for part, left_out in ((fields.solutions, accuracy), (fields.adjoint, adjoint)):
        weighted = flow[:, None] * part
        in_units.append(weighted / (left_out * np.linalg.norm(weighted, axis=0).max()))
    return ReducedOrdinates(grid, with_constants(ones, np.hstack(in_units)) / flow[:, None])


def with_constants(ones: np.ndarray, functions: np.ndarray) -> np.ndarray:
    """Return orthonormal functions that span others, but for what is less than 1 of them.

    Constants are kept as they are, so that nothing is lost but at the rate z.

    Parameters
    ----------
    ones : numpy.ndarray, shape (k,)
        The function 1, or a multiple of it.
    functions : numpy.ndarray, shape (k, m)

    Returns
    -------
    numpy.ndarray, shape (k, r)
    """
    ones = ones / np.linalg.norm(ones)
    rest = functions - np.outer(ones, ones @ functions)
    left, sizes, _ = np.linalg.svd(rest, full_matrices=False)
    return np.column_stack([ones, left[:, sizes > 1]])


def unreduced(grid: PlaneOrdinates) -> ReducedOrdinates:
    """Take all ordinates."""
    return ReducedOrdinates(grid, sp.diags_array(1 / np.sqrt(grid.masses * np.abs(grid.speeds))))


def _modes(even, odd):
    """Rates and even parts of the modes, which change in x as exp(rate x).

    Rates squared are eigenvalues of O E and lie many decades apart. They are taken from its
    inverse: rounding spoils the fastest ones then, which are seen next to the walls only.
    """
    inverse = np.linalg.solve(even, np.linalg.inv(odd))
    values, modes = np.linalg.eig(inverse)
    return 1 / np.sqrt(values.astype(complex)), modes


def _decaying(rates, way):
    """Let fast modes decay that hardly do, because of rounding or of a generator that amplifies.

    In a basis the generator may amplify what is narrow, although it does not on the nodes; such a
    mode would go from wall to wall.
    """
    settings = tuning.REDUCED_ORDINATES
    fast = np.abs(rates) * way > settings.fast
    return np.where(fast & (rates.real < settings.least * np.abs(rates)), np.abs(rates), rates)
