"""The kinetic equation of two state variables by adding and doubling of slabs, without modes.

In (z - A) h = g d_x h, h is given where the flow leaves a slab: at the upper face for g > 0, at the
lower for g < 0. Its values where the flow enters depend linearly on these: the matrix S transmits
from the other face, R reflects from the same one. If g and the drift are odd, one R and one S serve
both faces. Two slabs are added to one of twice the thickness. This is stable, since no slab
amplifies for Re z >= 0. See van de Hulst, Multiple Light Scattering (1980), chapter 4.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates, UnstableError


@dataclass(frozen=True)
class Slab:
    """A slab that is its own mirror image.

    Attributes
    ----------
    reflection, transmission : numpy.ndarray, shape (k, k)
        From values where the flow leaves to values where it enters at the same and at the other
        face, at the nodes with g > 0 or their mirror images.
    """

    reflection: np.ndarray
    transmission: np.ndarray

    @cached_property
    def _factors(self):
        """Of 1 - R and 1 + R: what two faces that look at each other do to even and odd parts."""
        one = np.eye(len(self.reflection))
        return [lu_factor(one - sign * self.reflection, check_finite=False) for sign in (1, -1)]

    def doubled(self) -> "Slab":
        """Add two of them."""
        R, S = self.reflection, self.transmission
        even, odd = (S @ lu_solve(factors, S, check_finite=False) for factors in self._factors)
        return Slab(R + (even - odd) / 2, (even + odd) / 2)

    def between(self, below: np.ndarray, above: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values at the face between two of them.

        Parameters
        ----------
        below, above : numpy.ndarray, shape (k,)
            Where the flow leaves at the outer faces.

        Returns
        -------
        up, down : numpy.ndarray, shape (k,)
            Where the flow enters the slab above, and that below.
        """
        even, odd = (
            lu_solve(factors, self.transmission @ values, check_finite=False)
            for factors, values in zip(self._factors, (above + below, above - below), strict=True)
        )
        return (even + odd) / 2, (even - odd) / 2


def slabs(grid: PlaneOrdinates, z: complex, thickness: float) -> Iterator[Slab]:
    """Yield slabs, each twice as thick as the one before.

    Parameters
    ----------
    grid : PlaneOrdinates
    z : complex
    thickness : float
        Of the first slab. Its error falls like the cube of it where h changes little within the
        slab.
    """
    # Richardson extrapolation of implicit Euler steps to order 2, which damps what changes fast
    ones = np.eye(len(grid.speeds))
    scattering = {parity: part.applied(ones) for parity, part in grid.eliminated(z).items()}
    one, two = (_step(scattering, grid.speeds, thickness / k) for k in (1, 2))
    two = two.doubled()
    made = Slab(2 * two.reflection - one.reflection, 2 * two.transmission - one.transmission)
    while True:
        yield made
        made = made.doubled()


def fields(
    grid: PlaneOrdinates, z: complex, thickness: float, thin: float, halvings: int = 0
) -> list[np.ndarray]:
    """Solve the kinetic equation in a slab, with h = 1 where the flow leaves.

    Parameters
    ----------
    grid : PlaneOrdinates
    z : complex
        With Re z > 0.
    thickness : float
        Infinite for a half space.
    thin : float
        Thickness, at most, of the first slab, from which the others are made.
    halvings : int
        How often a slab of finite thickness is halved. The halves are solved, too: their slabs are
        made on the way.

    Returns
    -------
    list of numpy.ndarray, shape (k, m)
        For each thickness, h at many depths, on the nodes with g > 0 or their mirror images; depths
        crowd at the faces. Once a slab is opaque, it stands for thicker ones.

    Raises
    ------
    UnstableError
        If h, which is between 0 and 1, is much larger.
    """
    settings, ones = tuning.ADDING_DOUBLING, grid.ones[: len(grid.speeds)]
    made: list[Slab] = []
    doublings = 0
    if math.isfinite(thickness):
        doublings = max(settings.fewest, math.ceil(math.log2(thickness / thin)))
        thin = thickness / 2**doublings
    for slab in slabs(grid, z, thin):
        made.append(slab)
        if math.isfinite(thickness) and len(made) > doublings:
            break
        if len(made) > settings.fewest and np.max(np.abs(slab.transmission)) < settings.opaque:
            break
    # what is thicker than the last, opaque one is as good as it
    counts = [
        min(len(made), 1 + doublings - k) if doublings else len(made) for k in range(halvings + 1)
    ]
    solved = {count: np.array(_fields(made[:count], ones)).T for count in counts}
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))[:, None]
    size = max(np.linalg.norm(flow * h, axis=0).max() for h in solved.values())
    size /= np.linalg.norm(flow[:, 0] * ones)
    if not size < settings.unstable:
        raise UnstableError(f"the slabs of {len(ones)} ordinates amplify by {size:.2g}")
    return [solved[count] for count in counts]


def _fields(made, ones):
    """Solutions in the last of some slabs, each of which is twice as thick as the one before."""
    found = [ones, (made[-1].reflection + made[-1].transmission) @ ones]
    parts = [(len(made) - 2, ones, ones)]
    while parts:
        size, below, above = parts.pop()
        up, down = made[size].between(below, above)
        found += [up, down]
        if size > 0:  # the part at the face, and in the middle only large ones
            parts.append((size - 1, below, down))
            if size > len(made) - tuning.ADDING_DOUBLING.resolved:
                parts.append((size - 1, up, above))
    return found


def _step(scattering, speeds, thickness):
    """Make the slab of one implicit Euler step: in it h is taken to be h where the flow enters."""
    sign, rate = np.sign(speeds), np.diag(np.abs(speeds) / thickness)
    even, odd = (np.linalg.solve(scattering[p] + rate, rate) for p in (EVEN, ODD))
    odd = sign[:, None] * odd * sign
    return Slab((even - odd) / 2, (even + odd) / 2)
