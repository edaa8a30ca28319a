"""The kinetic equation of one state variable in few combinations of nodes, on a vertical line.

The line is one where transforms are not small: what a basis leaves out may reach the start by modes
that are wrong, and decay less than the solution does.

Solutions h of (z - A) h = g d_x h between two walls, at all depths and for all z on a line, lie
close to a space of few dimensions. A basis of it is taken from solutions at a few real z, and from
those of the adjoint equation with a source at the start: the error of h there is about the product
of what is left out of either. As A is self-adjoint in L^2(m), the adjoint equation differs from the
equation by the sign of g alone, and has the same modes.

Functions of the basis live on the nodes with g > 0 or on those with g < 0, so that what is given at
the walls is a combination of them. In the inner product of L^2(m |g|) they are orthonormal, and
Galerkin's method leaves (z M - S) c = mu G c with G = 1 or -1. As M and -S are positive, there are
as many modes with Re mu > 0 as functions with G = 1, for every z with Re z > 0.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.bases.reduced_ordinates import Fields, joined, with_constants
from nonsmooth.kinetic.case_modes import ModesOfWalls, modes, modes_at_real
from nonsmooth.kinetic.ordinates_line import Ordinates


@dataclass(frozen=True)
class ReducedLine:
    """A whole grid in a basis; `case_modes.modes` takes it for a grid.

    Its nodes are the functions of the basis, and the nodes of the grid with g = 0.

    Attributes
    ----------
    stiffness, weights : numpy.ndarray, shape (k, k)
        -S and M.
    g : numpy.ndarray, shape (k,)
        1 or -1 for functions of the basis, 0 for nodes.
    ones : numpy.ndarray, shape (r,)
        The function 1 in the basis.
    start : dict
        A row that interpolates at the start.
    """

    stiffness: np.ndarray
    weights: np.ndarray
    g: np.ndarray
    ones: np.ndarray
    start: dict
    mirrored: bool = False

    @property
    def moving(self) -> np.ndarray:
        """Indices of the functions of the basis."""
        return np.flatnonzero(self.g)

    @property
    def masses(self) -> np.ndarray:
        """Of functions that are orthonormal in L^2(m |g|): 1, shape (k,)."""
        return np.ones(len(self.g))

    def resolvent(self, z: complex, parity: int, values: np.ndarray) -> np.ndarray:
        """Solve (z M - S) u = f, shape (k, c); the parity is that of functions on a whole grid."""
        return np.linalg.solve(self.stiffness + z * self.weights, values)


def on_line(
    grid: Ordinates,
    intervals: Sequence[tuple[float, float]],
    exact: Callable[[complex], np.ndarray],
    abscissa: float,
    accuracy: float,
) -> tuple[ReducedLine, float, float] | None:
    """Choose a basis that is good enough on a vertical line, and fewer functions than nodes.

    It is compared with the grid at some heights, of which none was used to find it.

    Parameters
    ----------
    grid : Ordinates
        Whole.
    intervals : sequence of (float, float)
        Levels of opposite signs, both finite.
    exact : callable
        Takes a place z to what `ModesOfWalls.by_exit` has on the grid, for each of the intervals.
    abscissa : float
        Re z; positive.
    accuracy : float
        Wanted of a transform, relative to its value on the real axis.

    Returns
    -------
    found : ReducedLine
    highest : float
        Height up to which it is good enough. Few places are above it where transforms are not
        negligible.
    inexact : float
        Largest difference to transforms on the grid, relative to the value on the real axis.

    None is returned if there is no such basis.
    """
    settings = tuning.REDUCED_LINE
    size = np.abs(exact(complex(abscissa)).sum(axis=1, keepdims=True))
    places: list[complex] = []
    probes: list[np.ndarray] = []
    while not places or (
        len(places) < settings.most and np.any(np.abs(probes[-1]) > accuracy * size)
    ):
        places.append(complex(abscissa, abscissa * settings.apart ** len(places)))
        probes.append(exact(places[-1]))
    # where transforms are negligible, modes that are wrong reach farther than those that are right
    places, probes = places[:-1], probes[:-1]
    if not places:
        return None
    with suppress(np.linalg.LinAlgError):  # rounding may hide which modes decay
        solved = np.geomspace(abscissa, places[-1].imag, 2 + len(places) // 2)
        functions = _functions(grid, solved, intervals)
        for share in settings.shares:
            basis = _basis(grid, functions, share * accuracy)
            if sum(part.shape[1] for part in basis) > settings.fewer * len(grid.moving):
                break
            reduced = _reduced(grid, basis)
            found = [np.array([modes(reduced, z).by_exit(*i) for i in intervals]) for z in places]
            off = np.max(np.abs(np.subtract(found, probes)).sum(axis=-1) / size[:, 0], axis=-1)
            wrong = np.flatnonzero(~(off <= settings.checked * accuracy))
            good = wrong[0] if len(wrong) else len(places)
            if good >= max(1, len(places) - settings.spared):
                return reduced, places[good - 1].imag, float(np.max(off[:good]))
    return None


def _functions(grid, places, intervals):
    """Return solutions and adjoint solutions at many depths, in columns of norm 1."""
    fields = []
    for z in places:
        found, row = modes_at_real(grid, z), _at_start(grid, z)
        for lower, upper in intervals:
            own = _solutions(found, upper - lower), _adjoint(found, row, lower, upper)
            fields.append(Fields(*own))
    return joined(fields)


def _at_start(grid, z):
    """Return a row that interpolates at the start from the nodes that move alone.

    Where g = 0, functions follow from those at the other nodes, by (z - A) h = 0 there.
    """
    row, moving, still = grid.start[EVEN], grid.moving, np.flatnonzero(grid.g == 0)
    matrix = grid.stiffness[EVEN][still] + z * np.diag(grid.masses)[still]
    return row[moving] - row[still] @ np.linalg.solve(matrix[:, still], matrix[:, moving])


def _solutions(found, length):
    """Return h at many depths between two walls, for paths that leave at either."""
    return _between(found, length, *np.split(found.strengths(length), [len(found.above.rates)]))


def _adjoint(found, row, lower, upper):
    """Return solutions with a source at the start, at many depths above it and below it.

    Where the flow of the equation leaves, that of the adjoint one enters, and brings nothing.
    """
    grid, (above, below) = found.grid, _whole(found)
    g = grid.g[grid.moving]
    leaves, none = g > 0, np.zeros((len(g), len(g)))
    high, low = (above * np.exp(-found.above.rates * way) for way in (upper, -lower))
    near, far = (below * np.exp(-found.below.rates * way) for way in (upper, -lower))
    matrix = np.vstack(
        [
            np.hstack([above, near, -low, -below]),
            np.hstack([np.hstack([high, below]), none])[~leaves],
            np.hstack([none, np.hstack([above, far])])[leaves],
        ]
    )
    jump = row / (grid.ones * g)
    strengths = np.linalg.solve(matrix, np.append(jump, 0 * jump))[:, None]
    both = [np.split(part, [above.shape[1]]) for part in np.split(strengths, 2)]
    return np.hstack([_between(found, upper, *both[0]), _between(found, -lower, *both[1])])


def _between(found: ModesOfWalls, length, of_upper, of_lower):
    """Sum modes of both walls at many depths, times the root of m |g|, and scale sums to 1.

    Modes have some strengths, in columns, at the wall from which they decay.
    """
    settings, (above, below) = tuning.REDUCED_LINE, _whole(found)
    crowded = 2.0 ** -np.arange(1, settings.octaves + 1)
    even = np.arange(1, settings.even) / settings.even
    depths = length * np.unique(np.concatenate([[0, 1], crowded, 1 - crowded, even]))
    values = [
        above @ (np.exp(-found.above.rates * depth)[:, None] * of_upper)
        + below @ (np.exp(-found.below.rates * (length - depth))[:, None] * of_lower)
        for depth in depths
    ]
    flow = np.sqrt(np.abs(found.grid.g[found.grid.moving]))
    columns = flow[:, None] * np.hstack(values).real
    sizes = np.linalg.norm(columns, axis=0)
    seen = sizes > settings.vanishing * sizes.max()
    return columns[:, seen] / sizes[seen]


def _whole(found):
    """Modes of the upper and of the lower wall at all nodes, times the root of the masses."""
    leaves = found.grid.g[found.grid.moving] > 0
    whole = []
    for wall, here in ((found.above, leaves), (found.below, ~leaves)):
        values = np.empty((len(here), len(wall.rates)), wall.own.dtype)
        values[here], values[~here] = wall.own, wall.other
        whole.append(values)
    return whole


def _basis(grid, functions, accuracy):
    """Return functions on the nodes with g > 0, and on those with g < 0, in columns.

    They are times the root of m |g|, and orthonormal.
    """
    g = grid.g[grid.moving]
    left_out = accuracy, accuracy * tuning.REDUCED_LINE.adjoint
    in_units = np.hstack([part / size for part, size in zip(functions, left_out, strict=True)])
    parts = []
    for here in (g > 0, g < 0):
        own = with_constants((grid.ones * np.sqrt(np.abs(g)))[here], in_units[here])
        part = np.zeros((len(g), own.shape[1]))
        part[here] = own
        parts.append(part)
    return parts


def _reduced(grid, basis):
    """Return the grid in a basis, which keeps the nodes with g = 0."""
    moving, both = grid.moving, np.hstack(basis)
    flow = np.sqrt(np.abs(grid.g[moving]))
    still = np.flatnonzero(grid.g == 0)
    many = both.shape[1]
    columns = np.zeros((len(grid.g), many + len(still)))
    columns[moving, :many] = both / (grid.ones * flow)[:, None]
    columns[still, many + np.arange(len(still))] = 1.0
    signs = np.repeat([1.0, -1.0, 0.0], [*(part.shape[1] for part in basis), len(still)])
    return ReducedLine(
        columns.T @ grid.stiffness[EVEN] @ columns,
        columns.T @ (grid.masses[:, None] * columns),
        signs,
        (grid.ones * flow) @ both,
        {EVEN: grid.start[EVEN] @ columns},
    )
