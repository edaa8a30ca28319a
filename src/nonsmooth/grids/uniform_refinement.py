"""Scenes with two state variables on a ladder of grids, all variables alike.

A grid of level 0 has an error of 1e-3, each level gains a digit or two: for most requests two or
three of them do what it takes more and larger ones to find out how fine each variable must be.
"""

import math
from dataclasses import replace

import numpy as np

from nonsmooth.grids import tensor_grid

_HIGHEST = 4
_SAFETY = 2.0  # times the difference of two levels
GAIN = 30.0  # of a level, at most; a change may be smaller because the error changes sign
_BOXED = 1  # level on which a larger box is tried; that matters less on finer ones


def applies(scene):
    """Whether the scene has two state variables and a finite n."""
    return scene.dimension == 2 and math.isfinite(scene.n)


def climb(grid, solve, share):
    """Raise the level of a grid until two levels agree.

    Parameters
    ----------
    grid : refinement.Grid
    solve : callable
        Takes a grid; returns values and what else than the grid makes inexact in them, arrays of
        one shape.
    share : callable
        Takes errors and values; returns the largest error as a part of the tolerance.

    Returns
    -------
    (values, errors) or None
        The error is twice the difference of the last two levels (or `GAIN` times less than twice
        the one before, if that is more), twice what a larger box changes, and twice what is
        inexact. None if the tolerance is out of reach, or levels do not converge: each must change
        the values by half of what the one before did.
    """
    grid = replace(grid, levels=dict.fromkeys(grid.levels, 0))
    values, _ = solve(grid)
    solved, change, size = [(grid, values)], 0.0, math.inf
    for left in reversed(range(_HIGHEST)):
        grid, previous = tensor_grid.raised(grid), values
        values, inexact = solve(grid)
        change = np.maximum(np.abs(values - previous), change / GAIN)
        larger, size = size, share(change, values)
        if not size <= min(larger / 2, GAIN**left / _SAFETY):
            return None
        error = _SAFETY * change + 2 * inexact
        if share(error, values) <= 1:
            coarse, there = solved[min(_BOXED, len(solved) - 1)]
            wider, _ = solve(replace(coarse, margin=tensor_grid.MARGIN))
            error = error + 2 * np.abs(wider - there)
            if share(error, values) <= 1:
                return values, error
        solved.append((grid, values))
    return None
