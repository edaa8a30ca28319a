"""Solutions of the kinetic equation of two state variables at many depths, for real z.

The value at the start depends on what is left of the equation elsewhere by the solution of the
adjoint equation with a source there (`Fields`). In a basis that has both, its error is about the
product of what is left out of either.

The modes of all ordinates solve (z - A) h = g d_x h in a slab exactly in x. On the nodes where g is
small they decay so fast that rounding spoils the fastest of them; these only make up what is next
to the faces. That is enough for solutions whose space is wanted and not they themselves. Where
oscillations make slower modes nearly parallel, rounding spoils solutions at all depths; slabs are
doubled there (`doubled_slabs`).
"""

import math

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.bases.reduced_ordinates import Fields, ReducedModes, unreduced
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates, UnstableError


def fields(
    grid: PlaneOrdinates,
    z: float,
    thickness: float,
    least: float,
    source: float,
    halvings: int = 0,
) -> list[Fields]:
    """Solve the kinetic equation in a slab, with h = 1 where the flow leaves.

    Parameters
    ----------
    grid : PlaneOrdinates
    z : float
        Positive.
    thickness : float
        Infinite for a half space.
    least : float
        About the least depth. The faces are left out: where functions vary over much less than
        that, the generator amplifies in the basis that they span.
    source : float
        Distance of the start from the face of a half space; in a slab it is in the middle.
    halvings : int
        How often the slab is halved. The halves are solved, too, with the same modes.

    Returns
    -------
    list of Fields
        For each thickness, h at many depths, which crowd at the faces, and adjoint solutions.

    Raises
    ------
    UnstableError
        If h, which is between 0 and 1, is much larger.
    ToleranceError
        If the limit of the `effort` does not cover it.
    """
    ordinates = unreduced(grid)
    modes = ordinates.modes(z)
    adjoint, decays = _Adjoint(modes), modes.decays.real
    found, slowest = [], np.min(decays, where=decays > 0, initial=np.max(decays))
    for length in thickness / 2.0 ** np.arange(halvings + 1):
        wall = lu_factor(modes.at_wall(length), check_finite=False)
        strengths = lu_solve(wall, modes.ones, check_finite=False)[:, None]
        depths = _depths(length, least, slowest)
        above, below = (modes.along(ways) * strengths for ways in (depths, length - depths))
        solved = both_directions(modes.even @ (above + below), modes.odd @ (above - below))
        if math.isinf(length):
            length = 2 * source
            wall = lu_factor(modes.at_wall(length), check_finite=False)
        sourced = adjoint.values(length / 2, least, wall)
        found.append(Fields(*(ordinates.functions(EVEN) @ part for part in (solved, sourced))))
    require_bounded(grid, found)
    return found


class _Adjoint:
    """Solutions of the adjoint equation with a source at the start, in the middle of a slab.

    Its modes are the columns of the transposed inverses of odd and even parts. At the source, even
    parts of functions have odd parts that jump by their row, and odd parts even ones; at a face the
    odd part is minus the even one.

    Parameters
    ----------
    modes : ReducedModes
    """

    def __init__(self, modes: ReducedModes):
        self._modes = modes
        self._odd_factors, self._even_factors = (
            lu_factor(part, check_finite=False) for part in (modes.odd, modes.even)
        )

    def values(self, half: float, least: float, wall: tuple) -> np.ndarray:
        """Return values in both directions, between the source and a face at the distance `half`.

        The crossing of a face depends on them as it does on the solution. `wall` are the factors of
        `ReducedModes.at_wall` for the slab.
        """
        modes, found, across = self._modes, [], self._modes.left(half)
        near, even = _crowded(half / 2, least), np.linspace(0, half, tuning.FIELDS.sourced + 1)
        ways = np.unique(np.concatenate([near, half - near, even[1:-1]]))
        rows = modes.even_row, modes.odd_row
        for row, part, sign in zip(rows, (modes.even, modes.odd), (1, -1), strict=True):
            if not is_source(row, rows):
                continue
            same, other = 1 + modes.left(2 * half), -np.expm1(-2 * half * modes.decays)
            if sign == -1:
                same, other = other, same
                wall = lu_factor(modes.even * same + modes.odd * other, check_finite=False)
            source = part.T @ row / 2
            arriving = across * source
            # at the wall the matrix is that of the equation itself, transposed and in its own modes
            reflected = other * (arriving - modes.odd.T @ self._odd(arriving))
            strengths = -(modes.even.T @ lu_solve(wall, reflected, trans=1)) / other
            leaving = source + sign * across * strengths
            above = modes.along(half - ways) * strengths[:, None]
            below = modes.along(ways) * leaving[:, None]
            found.append(both_directions(self._even(above + below), self._odd(above - below)))
        return np.hstack(found)

    def _even(self, strengths):
        """Even parts of adjoint modes."""
        return lu_solve(self._odd_factors, strengths, trans=1, check_finite=False)

    def _odd(self, strengths):
        """Odd parts of adjoint modes."""
        return lu_solve(self._even_factors, strengths, trans=1, check_finite=False)


def is_source(row: np.ndarray, rows: tuple[np.ndarray, np.ndarray]) -> bool:
    """Whether a start has more of a parity than rounding: where it is 0 it has no odd part.

    Parameters
    ----------
    row : numpy.ndarray, shape (k,)
        It interpolates functions of the parity at the start.
    rows : tuple of numpy.ndarray, shape (k,)
        Those of both parities.
    """
    return np.linalg.norm(row) > tuning.FIELDS.rounding * np.linalg.norm(rows)


def both_directions(even: np.ndarray, odd: np.ndarray) -> np.ndarray:
    """Values where g > 0 and where g < 0.

    Values at a node's mirror image are those at the node, as far from the other face.

    Parameters
    ----------
    even, odd : numpy.ndarray, shape (k, m)
        Parts of functions on the nodes with g > 0.

    Returns
    -------
    numpy.ndarray, shape (k, 2 m)
    """
    return np.hstack([even + odd, even - odd]).real


def require_bounded(grid: PlaneOrdinates, found: list[Fields]) -> None:
    """Refuse solutions that are much larger than 1.

    Parameters
    ----------
    grid : PlaneOrdinates
    found : list of Fields
        As `fields` returns them.

    Raises
    ------
    UnstableError
        If one is.
    """
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    size = max(np.linalg.norm(flow[:, None] * of.solutions, axis=0).max() for of in found)
    size /= np.linalg.norm(flow * grid.ones[: len(flow)])
    if not (size < tuning.FIELDS.unstable and all(np.all(np.isfinite(of.adjoint)) for of in found)):
        raise UnstableError(f"the solutions on {len(flow)} ordinates amplify by {size:.2g}")


def rounding(grid: PlaneOrdinates, z: float, thickness: float) -> float:
    """Estimate the relative errors of `fields` by rounding, from the strengths of the modes.

    Parameters
    ----------
    grid, z, thickness
        As for `fields`.
    """
    modes = unreduced(grid).modes(z)
    strengths = np.linalg.solve(modes.at_wall(thickness), modes.ones)
    return np.finfo(float).eps * np.max(np.abs(strengths)) / np.linalg.norm(modes.ones)


def _depths(length, least, slowest):
    """Return depths up to the middle, or to where the slowest mode has decayed."""
    settings = tuning.FIELDS
    end = min(length / 2, settings.decayed / slowest)
    even = np.linspace(0, end, settings.even + 1)[1:]
    return np.unique(np.concatenate([_crowded(end, least), even]))


def _crowded(end, least):
    """Depths that crowd at 0, from about the least one on."""
    per_octave = tuning.FIELDS.per_octave
    count = max(1, math.ceil(per_octave * math.log2(max(end / least, 1.0))))
    return end * 2.0 ** (-np.arange(count) / per_octave)
