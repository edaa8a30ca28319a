"""The kinetic equation of two variables without modes: slabs that are added and doubled.

In a slab h is given where the flow leaves. Its values where the flow enters depend linearly on
these: the matrix S transmits from the other face, R reflects from the same one. If g and the drift
are odd, one R and one S serve both faces. See van de Hulst, Multiple Light Scattering (1980),
chapter 4.
"""

import numpy as np

from nonsmooth.grids.solver import EVEN, ODD


def slab(grid, z, thickness, doublings):
    """Reflection and transmission of a slab that is doubled so many times.

    The first one is made by Richardson's extrapolation of implicit Euler steps to order 2.
    """
    scattering = {parity: scattered(grid, z, parity)[0] for parity in (EVEN, ODD)}
    thin = thickness / 2**doublings
    one, two = (_step(scattering, grid.speeds, thin / k) for k in (1, 2))
    made = tuple(2 * fine - coarse for fine, coarse in zip(_doubled(*two), one, strict=True))
    for _ in range(doublings):
        made = _doubled(*made)
    return made


def scattered(grid, z, parity):
    """Compute z - A on the nodes that move, and the row that interpolates there at the start.

    Values at the nodes that stand still follow from (z - A) h = 0.
    """
    many, A = len(grid.speeds), grid.generator[parity].toarray()
    matrix, row = z * np.eye(len(A)) - A, grid.start[parity]
    inside = np.linalg.solve(matrix[many:, many:], matrix[many:, :many])
    return matrix[:many, :many] - matrix[:many, many:] @ inside, row[:many] - row[many:] @ inside


def _doubled(reflection, transmission):
    one = np.eye(len(reflection))
    even, odd = (
        transmission @ np.linalg.solve(one - sign * reflection, transmission) for sign in (1, -1)
    )
    return reflection + (even - odd) / 2, (even + odd) / 2


def _step(scattering, speeds, thickness):
    """Take h in the slab to be h where the flow enters."""
    sign, rate = np.sign(speeds), np.diag(np.abs(speeds) / thickness)
    even, odd = (np.linalg.solve(scattering[p] + rate, rate) for p in (EVEN, ODD))
    odd = sign[:, None] * odd * sign
    return (even - odd) / 2, (even + odd) / 2
