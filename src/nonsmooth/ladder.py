"""Scenes with two state variables on a ladder of grids, all variables alike.

A grid of level 0 has an error of 1e-3, each level gains a digit or two: for most requests two or
three of them do what it takes more and larger ones to find out how fine each variable must be.
"""

import math
from dataclasses import replace

import numpy as np

from nonsmooth import refinement

_HIGHEST = 4
_SAFETY = 2.0  # times the difference of two levels
_GAIN = 30.0  # of a level, at most
_RESIDUE = 1e-3  # of the tolerance, for rounding


def applies(scene):
    """Whether the scene has two state variables and a finite n."""
    return len(scene.state) == 2 and math.isfinite(scene.n)


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
        The error is twice the difference of the last two levels, twice what a larger box changes,
        and twice what is inexact. None if the tolerance is out of reach, or levels do not
        converge: each must change the values by half of what the one before did.
    """
    grid = replace(grid, levels=dict.fromkeys(grid.levels, 0))
    (values, _), step, beyond = solve(grid), math.inf, None
    for left in reversed(range(_HIGHEST)):
        below, grid = grid, refinement.raised(grid)
        previous, (values, inexact) = values, solve(grid)
        change = np.abs(values - previous)
        before, step = step, share(change, values)
        if not step <= min(before / 2, _GAIN**left / _SAFETY):
            return None
        error = _SAFETY * change + 2 * inexact
        if share(error, values) <= 1:
            if beyond is None:
                beyond = 2 * np.abs(solve(replace(below, margin=refinement.MARGIN))[0] - previous)
            if share(error + beyond, values) <= 1:
                return values, error + beyond
    return None


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
        As of `climb`.
    """

    def solve(grid):
        value = refinement.growth_rate(scene, grid, tol)
        return value, _RESIDUE / 2 * tol * abs(value)

    return climb(
        refinement.fitted(scene, math.log(1 / tol) + refinement.SPARE, 1),
        solve,
        lambda error, value: error / (tol * abs(value)),
    )
