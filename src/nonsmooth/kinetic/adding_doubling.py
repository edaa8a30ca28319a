"""Reflection and transmission of a slab of x' = g by adding and doubling, without modes.

In (z - A) h = g d_x h, h is known where the flow leaves a slab: at the upper face where g > 0, at
the lower where g < 0. Its values where the flow enters are linear in these: S transmits from the
other face, R reflects from the same. With the mirror symmetry of odd g and drift one R and one S
serve both faces. Two slabs make one of twice the thickness; since a slab is passive for Re z >= 0,
doubling is stable where the modes of `transport` are ill-conditioned. See van de Hulst, Multiple
Light Scattering (1980), chapter 4.
"""

from dataclasses import dataclass

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.grids.solver import EVEN, ODD

_OPAQUE = 1e-10  # transmission of what is as good as a half space
_MOST = 100  # doublings on the way there


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

    def doubled(self):
        """Put two together."""
        R, S = self.reflection, self.transmission
        one = np.eye(len(R))
        even = S @ np.linalg.solve(one - R, S)
        odd = S @ np.linalg.solve(one + R, S)
        return Slab(R + (even - odd) / 2, (even + odd) / 2)


def slab(grid, z, thickness, doublings):
    """Make a slab of finite thickness, its error of the order 8^-doublings in smooth modes.

    Parameters
    ----------
    grid : PlaneOrdinates
    z : float or complex
    thickness : float
    doublings : int

    Returns
    -------
    Slab
    """
    thin = thickness / 2**doublings
    # extrapolated from one step, two and four, which damps all that decays within the thin slab
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


def half_space(made):
    """Reflection of a half space, from a slab.

    Raises
    ------
    ToleranceError
        If the slab does not absorb.
    """
    for _ in range(_MOST):
        if np.max(np.abs(made.transmission)) < _OPAQUE:
            return made.reflection
        made = made.doubled()
    raise ToleranceError("the half space absorbs nothing; use method='monte_carlo'")


def _step(scattering, speeds, thickness):
    """Slab thinner than anything in it, where h is what it is on the side where the flow enters."""
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
