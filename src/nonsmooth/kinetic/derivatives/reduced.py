"""Derivatives of E exp(-z tau) for two state variables, in the basis of few ordinates.

Even and odd parts solve E e = o' and O o = e' (`kinetic.bases.reduced_ordinates`). If E and O
change by dE and dO, the parts change by solutions of

    E de = do' - dE e,    O do = de' - dO o,    0 where the flow leaves.

In the modes, e = M (a + b) and o = N (a - b), where a' = r a decays from the upper wall and
b' = -r b from the lower one. Their changes have the sources

    da' = r da + P a + Q b,    db' = -r db - Q a - P b,    P, Q = (N^-1 dE M +- M^-1 dO N) / 2,

and what these add up to are integrals of products of exponentials. On given nodes and in a given
basis this is the derivative of what `reduced_ordinates` computes.
"""

import numpy as np

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic.bases.reduced_ordinates import ReducedModes, ReducedOrdinates
from nonsmooth.kinetic.derivatives.exponentials import against, along


def differentiated(
    ordinates: ReducedOrdinates,
    z: complex,
    levels: tuple[float, float],
    moved: tuple[float, float],
) -> complex:
    """Differentiate E exp(-z tau) with respect to a parameter.

    Parameters
    ----------
    ordinates : ReducedOrdinates
        Of a grid that knows the change of its generator, if this changes.
    z : complex
    levels : tuple of float
        Of opposite signs; one may be infinite.
    moved : tuple of float
        Derivatives of the distances of the lower and of the upper level from 0.

    Returns
    -------
    complex
    """
    modes, (lower, upper) = ordinates.modes(z), levels
    if np.isinf(upper):
        modes, side = modes.mirrored(), -1
        solution = _Solution(modes, np.inf, -lower)
        value = solution.by_levels(0.0, moved[0])
    else:
        side, solution = 1, _Solution(modes, -lower, upper)
        value = solution.by_levels(*moved)
    if ordinates.grid.change is None:
        return value
    (even, even_row), (odd, odd_row) = (
        _changes(ordinates, p, modes.eliminated[p]) for p in (EVEN, ODD)
    )
    return value + solution.by_matrices(even, odd) + solution.by_rows(even_row, side * odd_row)


def _changes(ordinates, parity, eliminated):
    """Differentiate E or O, and the row that interpolates at the start.

    Functions on the nodes that move solve (z - A) h = 0 at the others. If A changes there, they
    change as if it were a source; so what reaches the tests and the start is by the transposed.
    """
    grid, many = ordinates.grid, len(ordinates.grid.speeds)
    functions, tests = ordinates.functions(parity), ordinates.tests(parity)
    if eliminated.still is None:
        return -tests @ (grid.change[parity] @ functions), np.zeros(functions.shape[1])
    continued = np.vstack([functions, eliminated.inside])
    moving, standing = np.split(grid.change[parity] @ continued, [many])
    seen_by = np.column_stack([-eliminated.out.T, grid.start[parity][many:]])
    seen = eliminated.still.solve(seen_by.astype(eliminated.inside.dtype), trans="T").T @ standing
    return seen[:-1] - tests @ moving, seen[-1]


class _Solution:
    """h in an interval, and its derivatives at the start.

    Parameters
    ----------
    modes : ReducedModes
    down, up : float
        Distances of the lower level, which may be infinite, and of the upper one.
    """

    def __init__(self, modes: ReducedModes, down: float, up: float):
        self._modes, self._down, self._up = modes, down, up
        self._wall = modes.at_wall(down + up)
        self._strengths = np.linalg.solve(self._wall, modes.ones)
        self._fall = modes.left(up), modes.left(down)

    def by_levels(self, down, up):
        """Differentiate by a change of both distances."""
        modes, strengths = self._modes, self._strengths
        moved = modes.rates * strengths
        at_wall = self._at_wall(modes.left(self._down + self._up) * moved) * (down + up)
        above, below = self._fall
        return modes.value(above * (at_wall - up * moved), below * (at_wall - down * moved))

    def by_rows(self, even, odd):
        """Differentiate by a change of the interpolation at the start."""
        modes, (above, below) = self._modes, (fall * self._strengths for fall in self._fall)
        return even @ modes.even @ (above + below) + odd @ modes.odd @ (above - below)

    def by_matrices(self, even, odd):
        """Differentiate by a change of E and O."""
        modes, strengths, (above, below) = self._modes, self._strengths, self._fall
        first = np.linalg.solve(modes.odd, even @ modes.even)
        second = np.linalg.solve(modes.even, odd @ modes.odd)
        same, other = (first + second) / 2, (first - second) / 2

        def arriving(length, falling):
            """Add up the sources within a length; `falling` is left of the other wall."""
            return (same * against(modes.rates, length)) @ strengths + (
                other * along(modes.rates, length)
            ) @ (falling * strengths)

        whole = self._at_wall(arriving(self._down + self._up, 1.0))
        return modes.value(
            above * whole - arriving(self._up, below), below * whole - arriving(self._down, above)
        )

    def _at_wall(self, arriving):
        """Strengths at the walls that undo what arrives there from the opposite one."""
        return np.linalg.solve(self._wall, (self._modes.even - self._modes.odd) @ arriving)
