"""The kinetic equation of two state variables by adding and doubling of slabs, without modes.

In (z - A) h = g d_x h, h is given where the flow leaves a slab: at the upper face for g > 0, at the
lower for g < 0. Its values where the flow enters depend linearly on these: the matrix S transmits
from the other face, R reflects from the same one. If g and the drift are odd, one R and one S serve
both faces. Two slabs are added to one of twice the thickness. This is stable, since no slab
amplifies for Re z >= 0, whereas the modes of `case_modes` are ill-conditioned for a generator that
is not self-adjoint. See van de Hulst, Multiple Light Scattering (1980), chapter 4.
"""

from dataclasses import dataclass

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates


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

    def doubled(self) -> "Slab":
        """Add two of them."""
        R, S = self.reflection, self.transmission
        one = np.eye(len(R))
        even = S @ np.linalg.solve(one - R, S)
        odd = S @ np.linalg.solve(one + R, S)
        return Slab(R + (even - odd) / 2, (even + odd) / 2)


def slab(grid: PlaneOrdinates, z: complex, thickness: float, doublings: int) -> Slab:
    """Make a slab by doubling a thin one.

    Its error falls like 8^-doublings where h changes little within the thin slab.

    Parameters
    ----------
    grid : PlaneOrdinates
    z : complex
    thickness : float
    doublings : int

    Returns
    -------
    Slab
    """
    thin = thickness / 2**doublings
    # Richardson extrapolation of implicit Euler steps to order 3, which damps what changes fast
    scattering = {parity: grid.scattering(z, parity) for parity in (EVEN, ODD)}
    one, two, four = (_step(scattering, grid.speeds, thin / k) for k in (1, 2, 4))
    two, four = two.doubled(), four.doubled().doubled()
    made = Slab(
        (one.reflection - 6 * two.reflection + 8 * four.reflection) / 3,
        (one.transmission - 6 * two.transmission + 8 * four.transmission) / 3,
    )
    for _ in range(doublings):
        made = made.doubled()
    return made


def half_space(made: Slab) -> np.ndarray:
    """Reflection of a half space, made by doubling a slab until nothing passes it.

    Raises
    ------
    ToleranceError
        If the slab does not absorb.
    """
    for _ in range(tuning.ADDING_DOUBLING.most):
        if np.max(np.abs(made.transmission)) < tuning.ADDING_DOUBLING.opaque:
            return made.reflection
        made = made.doubled()
    raise ToleranceError("the half space absorbs nothing; use method='monte_carlo'")


def _step(scattering, speeds, thickness):
    """Make the slab of one implicit Euler step: in it h is taken to be h where the flow enters."""
    many, sign = len(speeds), np.sign(speeds)
    rate = np.abs(speeds) / thickness
    found = []
    for parity in (EVEN, ODD):
        matrix = scattering[parity].copy()
        matrix[np.arange(many), np.arange(many)] += rate
        right = np.zeros((len(matrix), many), matrix.dtype)
        right[np.arange(many), np.arange(many)] = rate
        found.append(np.linalg.solve(matrix, right)[:many])
    even, odd = found[0], sign[:, None] * found[1] * sign
    return Slab((even - odd) / 2, (even + odd) / 2)
