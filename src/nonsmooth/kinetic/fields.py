"""Solutions of the kinetic equation of two state variables at many depths, for real z.

The modes of all ordinates solve (z - A) h = g d_x h in a slab exactly in x. On the nodes where g is
small they decay so fast that rounding spoils the fastest of them; these only make up what is next
to the faces. That is enough for solutions whose space is wanted and not they themselves. Where
oscillations make slower modes nearly parallel, rounding spoils solutions at all depths; slabs are
doubled there (`doubled_slabs`).
"""

import math

import numpy as np

from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates, UnstableError
from nonsmooth.kinetic.reduced_ordinates import unreduced


def fields(
    grid: PlaneOrdinates, z: float, thickness: float, least: float, halvings: int = 0
) -> list[np.ndarray]:
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
    halvings : int
        How often the slab is halved. The halves are solved, too, with the same modes.

    Returns
    -------
    list of numpy.ndarray, shape (k, m)
        For each thickness, h at many depths, on the nodes with g > 0 or their mirror images; depths
        crowd at the faces.

    Raises
    ------
    UnstableError
        If h, which is between 0 and 1, is much larger.
    ToleranceError
        If the limit of the `effort` does not cover it.
    """
    ordinates = unreduced(grid)
    eliminated = grid.eliminated(z)
    modes = ordinates.modes(eliminated, ordinates.continued(eliminated))
    decays = modes.decays.real
    found, slowest = [], np.min(decays, where=decays > 0, initial=np.max(decays))
    for length in thickness / 2.0 ** np.arange(halvings + 1):
        strengths = np.linalg.solve(modes.at_wall(length), modes.ones)
        depths = _depths(length, least, slowest)
        above, below = (
            np.array([modes.left(way) * strengths for way in ways]).T
            for ways in (depths, length - depths)
        )
        even, odd = (modes.even @ (above + below)).real, (modes.odd @ (above - below)).real
        # values at a node's mirror image are those at the node, as far from the other face
        found.append(ordinates.functions(EVEN) @ np.hstack([even + odd, even - odd]))
    require_bounded(grid, found)
    return found


def require_bounded(grid: PlaneOrdinates, found: list[np.ndarray]) -> None:
    """Refuse solutions that are much larger than 1.

    Parameters
    ----------
    grid : PlaneOrdinates
    found : list of numpy.ndarray, shape (k, m)
        As `fields` returns them.

    Raises
    ------
    UnstableError
        If one is.
    """
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    size = max(np.linalg.norm(flow[:, None] * h, axis=0).max() for h in found)
    size /= np.linalg.norm(flow * grid.ones[: len(flow)])
    if not size < tuning.FIELDS.unstable:
        raise UnstableError(f"the solutions on {len(flow)} ordinates amplify by {size:.2g}")


def rounding(grid: PlaneOrdinates, z: float, thickness: float) -> float:
    """Estimate the relative errors of `fields` by rounding, from the strengths of the modes.

    Parameters
    ----------
    grid, z, thickness
        As for `fields`.
    """
    ordinates, eliminated = unreduced(grid), grid.eliminated(z)
    modes = ordinates.modes(eliminated, ordinates.continued(eliminated))
    strengths = np.linalg.solve(modes.at_wall(thickness), modes.ones)
    return np.finfo(float).eps * np.max(np.abs(strengths)) / np.linalg.norm(modes.ones)


def _depths(length, least, slowest):
    """Return depths up to the middle, or to where the slowest mode has decayed."""
    settings = tuning.FIELDS
    end = min(length / 2, settings.decayed / slowest)
    count = max(1, math.ceil(settings.per_octave * math.log2(max(end / least, 1.0))))
    near = end * 2.0 ** (-np.arange(count) / settings.per_octave)
    return np.unique(np.concatenate([near, np.linspace(0, end, settings.even + 1)[1:]]))
