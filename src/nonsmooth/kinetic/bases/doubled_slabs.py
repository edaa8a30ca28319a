"""Solutions of the kinetic equation of two state variables at many depths, by doubling of slabs.

Even and odd parts in the state solve E e = o' and O o = e' (`reduced_ordinates`), in all ordinates.
A solution that is symmetric about the middle of a slab has o = T e at the upper face, one that is
antisymmetric o = C e. With X^2 = O E and the thickness d of the slab,

    T = E X^{-1} tanh(X d/2),    C = E X^{-1} coth(X d/2).

Twice the slab has the arithmetic mean of both in the place of C, the harmonic mean in that of T:
the iteration of Denman and Beavers for square roots, Appl. Math. Comput. 2 (1976) 63-94. It is
stable where modes are nearly parallel, and solutions would be small differences of large multiples
of them; elsewhere modes take two thirds of the time.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.bases.fields import both_directions, is_source, require_bounded
from nonsmooth.kinetic.bases.reduced_ordinates import Fields, unreduced
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates
from nonsmooth.linear_algebra.effort import spend


@dataclass(frozen=True)
class Slab:
    """A slab, by what it does to even parts at its upper face.

    Attributes
    ----------
    symmetric, antisymmetric : numpy.ndarray, shape (k, k)
        The odd part there, of solutions that are symmetric about the middle of the slab, and of
        those that are antisymmetric.
    """

    symmetric: np.ndarray
    antisymmetric: np.ndarray

    def doubled(self) -> tuple["Slab", "Seam"]:
        """Put two of them together; return what they make, and the seam between them."""
        spend(_DOUBLED * len(self.symmetric) ** 3)
        mean = (self.antisymmetric + self.symmetric) / 2
        factors = lu_factor(mean, check_finite=False)
        harmonic = self.antisymmetric @ lu_solve(factors, self.symmetric, check_finite=False)
        return Slab(harmonic, mean), Seam(factors, (self.antisymmetric - self.symmetric) / 2)


@dataclass(frozen=True)
class Seam:
    """The face between two equal slabs.

    Attributes
    ----------
    factors : tuple
        Of the mean of what each slab does to antisymmetric and to symmetric solutions.
    half : numpy.ndarray, shape (k, k)
        Half of their difference.
    transposed : bool
        Whether the factors are those of the transposed mean.
    """

    factors: tuple
    half: np.ndarray
    transposed: bool = False

    def adjoint(self) -> "Seam":
        """Seam of the adjoint equation."""
        return Seam(self.factors, self.half.T, not self.transposed)

    def solve(self, values: np.ndarray) -> np.ndarray:
        """Apply the inverse of the mean."""
        return lu_solve(self.factors, values, trans=self.transposed, check_finite=False)

    def values(self, below: np.ndarray, above: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return even and odd parts at it, from even parts at the outer faces."""
        even = self.solve(self.half @ (below + above) / 2)
        return even, self.half @ (above - below) / 2


# fitted: operations of products that take as long as a doubling, and as the thin slab, over k^3
_DOUBLED, _THIN = 10.0, 26.0


def fields(
    grid: PlaneOrdinates,
    z: float,
    thickness: float,
    least: float,
    source: float,
    halvings: int = 0,
) -> list[Fields]:
    """Solve the kinetic equation in a slab, with h = 1 where the flow leaves.

    Parameters, results and what is raised are those of `kinetic.bases.fields.fields`.
    """
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    ones = flow * grid.ones[: len(flow)]
    thin = least / tuning.DOUBLED_SLABS.parts
    doublings = tuning.DOUBLED_SLABS.most
    if math.isfinite(thickness):
        doublings = halvings + max(2, math.ceil(math.log2(thickness / thin / 2.0**halvings)))
        thin = thickness / 2.0**doublings
    # doublings of the slab of a half space that has the source in its middle: half of it is as
    # thick as the start is far from the face, or at least half as thick
    nearest = 0 if math.isfinite(thickness) else max(2, math.floor(math.log2(2 * source / thin)))
    eliminated = unreduced(grid).eliminated(z)
    even, odd = eliminated[EVEN], eliminated[ODD]
    slab, seams, solved = _thin(even.matrix, odd.matrix, thin), [], {}
    for left in reversed(range(doublings)):
        slab, seam = slab.doubled()
        seams.append(seam)
        opaque = math.isinf(thickness) and _opaque(slab, ones)
        half = left <= halvings
        if half or len(seams) == nearest or (opaque and len(seams) < nearest):
            sourced = _sourced(slab, seams, (even.row, odd.row), least / thin)
        if half or opaque:
            solutions = _solutions(slab, seams, ones, least / thin)
            solved[0 if opaque else left] = solutions, sourced
        if opaque:
            break
    found = [Fields(*(part / flow[:, None] for part in solved[k])) for k in range(halvings + 1)]
    require_bounded(grid, found)
    return found


def _thin(even, odd, thickness):
    """Make a slab within which most solutions change little, by a fraction for tanh.

    tanh(a) = a (1 + a^2/15) / (1 + 2 a^2/5) up to a^7/1575.
    """
    spend(_THIN * len(even) ** 3)
    one, square = np.eye(len(even)), (thickness / 2) ** 2 * (odd @ even)
    above, below = one + square / 15, one + square * 2 / 5
    symmetric = even @ np.linalg.solve(below, above) * (thickness / 2)
    antisymmetric = np.linalg.solve(odd, np.linalg.solve(above, below)) * (2 / thickness)
    return Slab(symmetric, antisymmetric)


def _opaque(slab, ones):
    """Whether neither face of a slab is seen at the other."""
    there = slab.antisymmetric @ ones
    across = np.linalg.norm(there - slab.symmetric @ ones)
    return across < tuning.DOUBLED_SLABS.opaque * np.linalg.norm(there)


def _solutions(slab, seams, ones, least):
    """Solve a slab that was doubled at seams, up to its middle; depths are in first slabs."""
    at_face = np.linalg.solve(np.eye(len(ones)) + slab.symmetric, ones)
    middle = seams[-1].values(at_face, at_face)
    found = _between(seams[:-1], at_face, middle[0], (True, False), least)
    # at the lower face the odd part points away from the slab
    return _joined([(even, -odd) for even, odd in (*found, middle)])


def _sourced(slab, seams, rows, least):
    """Solve the adjoint equation with a source in the middle, from there to the upper face.

    At the face the odd part is minus the even one; at the source even parts of functions have odd
    parts that jump by their row, and odd parts even ones.
    """
    seams, found = [seam.adjoint() for seam in seams], []
    least = min(least, 2.0 ** (len(seams) - 2))
    one, half = np.eye(len(slab.symmetric)), seams[-1].half
    even, odd = rows
    if is_source(even, rows):
        source = even / 2
        at_face = np.linalg.solve(one + slab.symmetric.T, half @ seams[-1].solve(source))
        at_source = seams[-1].solve(source + half @ at_face)
        found += _between(seams[:-1], at_source, at_face, (True, True), least)
    if is_source(odd, rows):
        at_source = odd / 2
        at_face = np.linalg.solve(one + slab.antisymmetric.T, half @ at_source)
        found += _between(seams[:-1], at_source, at_face, (True, True), least)
    return _joined(found)


def _between(seams, below, above, near, least):
    """Return even and odd parts at many depths of a slab that was doubled at seams.

    `near` tells whether depths crowd at the lower and at the upper face, whose even parts are
    known; depths are in first slabs.
    """
    settings, found = tuning.DOUBLED_SLABS, {}
    # parts: depth and even part at the lower end, doublings, even part at the upper end, halvings
    parts = [(0.0, below, len(seams), above, settings.even, near)]
    while parts:
        depth, below, doublings, above, halvings, near = parts.pop()
        half = 2.0 ** (doublings - 1)
        if half < max(least, 1.0) or (halvings == 0 and not any(near)):
            continue
        between = found[depth + half] = seams[doublings - 1].values(below, above)
        lower, upper = (max(halvings - 1, settings.near if crowd else 0) for crowd in near)
        parts.append((depth, below, doublings - 1, between[0], lower, (near[0], False)))
        parts.append((depth + half, between[0], doublings - 1, above, upper, (False, near[1])))
    return [found[depth] for depth in sorted(found)]


def _joined(found):
    """Put pairs of even and odd parts together."""
    return both_directions(*(np.array(part).T for part in zip(*found, strict=True)))
