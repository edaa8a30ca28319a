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
from nonsmooth.kinetic.fields import require_bounded
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates
from nonsmooth.kinetic.reduced_ordinates import unreduced
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
    """

    factors: tuple
    half: np.ndarray

    def values(self, below: np.ndarray, above: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return even and odd parts at it, from even parts at the outer faces."""
        even = lu_solve(self.factors, self.half @ (below + above) / 2, check_finite=False)
        return even, self.half @ (above - below) / 2


# fitted: operations of products that take as long as a doubling, and as the thin slab, over k^3
_DOUBLED, _THIN = 10.0, 26.0


def fields(
    grid: PlaneOrdinates, z: float, thickness: float, least: float, halvings: int = 0
) -> list[np.ndarray]:
    """Solve the kinetic equation in a slab, with h = 1 where the flow leaves.

    Parameters, results and what is raised are those of `kinetic.fields.fields`.
    """
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    ones = flow * grid.ones[: len(flow)]
    thin = least / tuning.DOUBLED_SLABS.parts
    doublings = tuning.DOUBLED_SLABS.most
    if math.isfinite(thickness):
        doublings = halvings + max(1, math.ceil(math.log2(thickness / thin / 2.0**halvings)))
        thin = thickness / 2.0**doublings
    slab, seams, solved = _thin(grid, z, thin), [], {}
    for left in reversed(range(doublings)):
        slab, seam = slab.doubled()
        seams.append(seam)
        opaque = math.isinf(thickness) and _opaque(slab, ones)
        if opaque or left <= halvings:
            solved[0 if opaque else left] = _solutions(slab, seams, ones, least / thin)
        if opaque:
            break
    found = [solved[k] / flow[:, None] for k in range(halvings + 1)]
    require_bounded(grid, found)
    return found


def _thin(grid, z, thickness):
    """Make a slab within which most solutions change little, by a fraction for tanh.

    tanh(a) = a (1 + a^2/15) / (1 + 2 a^2/5) up to a^7/1575.
    """
    ordinates, eliminated = unreduced(grid), grid.eliminated(z)
    matrices, _ = ordinates.matrices(eliminated, ordinates.continued(eliminated))
    even, odd = matrices[EVEN], matrices[ODD]
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
    settings, doublings = tuning.DOUBLED_SLABS, len(seams) - 1
    at_face = np.linalg.solve(np.eye(len(ones)) + slab.symmetric, ones)
    middle = seams[doublings].values(at_face, at_face)
    found = {2.0**doublings: middle}
    # parts: depth and even part at the lower end, doublings, even part at the upper end, halvings
    parts = [(0.0, at_face, doublings, middle[0], settings.even)]
    while parts:
        depth, below, doublings, above, halvings = parts.pop()
        half = 2.0 ** (doublings - 1)
        if half < max(least, 1.0) or (halvings == 0 and depth > 0):
            continue
        between = found[depth + half] = seams[doublings - 1].values(below, above)
        nearer = halvings - 1 if depth > 0 else max(halvings - 1, settings.near)
        parts.append((depth, below, doublings - 1, between[0], nearer))
        parts.append((depth + half, between[0], doublings - 1, above, halvings - 1))
    even, odd = (np.array([found[depth][k] for depth in sorted(found)]).T for k in (0, 1))
    return np.hstack([even - odd, even + odd])
