"""gamma^2 of scenes with two state variables on a ladder of grids, all variables alike.

A grid of level 0 has an error of 1e-3, each level gains a digit or two: for most requests two or
three of them do what `refinement`, which finds out how fine each variable must be, does on seven
larger ones.
"""

import math
from dataclasses import replace

from nonsmooth import refinement

_HIGHEST = 4
_MARGIN = 0.15  # of the box, to see whether it matters
_SAFETY = 2.0  # times the difference of two levels
_RESIDUE = 1e-3  # of the tolerance, for rounding


def applies(scene):
    """Whether the scene has two state variables and a finite n."""
    return len(scene.state) == 2 and math.isfinite(scene.n)


def growth_on_ladder(scene, tol):
    """Compute gamma^2 of a scene to which this `applies`.

    Parameters
    ----------
    scene : Scene
    tol : float
        Relative.

    Returns
    -------
    (value, error) or None
        The error is twice the difference of the last two levels, and twice what a larger box
        changes. None if `tol` is not met on the ladder, or levels do not converge: each must
        change gamma^2 by half of what the one before did.
    """
    grid = refinement.fitted(scene, math.log(1 / tol) + refinement.SPARE, 1)
    grid = replace(grid, levels=dict.fromkeys(grid.levels, 0))
    last, change, beyond = refinement.growth_rate(scene, grid, tol), math.inf, None
    for _ in range(_HIGHEST):
        below, grid = grid, refinement.raised(grid)
        previous, last = last, refinement.growth_rate(scene, grid, tol)
        before, change = change, abs(last - previous)
        if change > before / 2:
            return None
        error = _SAFETY * change + _RESIDUE * tol * abs(last)
        if error <= tol * abs(last):
            if beyond is None:
                larger = replace(below, margin=_MARGIN)
                beyond = 2 * abs(refinement.growth_rate(scene, larger, tol) - previous)
            if error + beyond <= tol * abs(last):
                return last, error + beyond
    return None
