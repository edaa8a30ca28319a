"""Grids of two variables that are refined in both, until three levels agree.

A grid of level 0 has an error of about 1e-3, and each level gains a digit or two. For most requests
three such grids suffice. To find out how fine each variable must be, as the combination technique
does, would take more and larger ones.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from nonsmooth.grids import tuning
from nonsmooth.grids.mesh.box_effect import BoxEffect
from nonsmooth.grids.tensor_grid import Grid
from nonsmooth.refine import Refined, until_agreement
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class _Solved:
    """Values on one grid, and the part of their error that is not due to the grid."""

    level: int
    values: np.ndarray
    inexact: np.ndarray


@dataclass(frozen=True)
class _Error:
    """The error of values, whether levels agree, and whether finer ones have no hope to."""

    bound: np.ndarray
    agreed: bool
    hopeless: bool


def applies(scene: Scene) -> bool:
    """Whether the scene has two state variables and a finite n."""
    return scene.dimension == 2 and math.isfinite(scene.n)


def refined(grid: Grid, solve: Callable, share: Callable) -> Refined:
    """Raise the level of a grid until three levels agree.

    Parameters
    ----------
    grid : Grid
        Its levels do not matter.
    solve : callable
        Takes a grid; returns values and the part of their error that is not due to the grid, such
        as that of the solver, in arrays of one shape.
    share : callable
        Takes errors and values; returns the largest error as a part of the tolerance.

    Returns
    -------
    Refined
        The error is the sum of three parts: twice the difference of the last two levels, twice
        what a larger box changes on one of the levels, and twice the error that is not due to the
        grid. Errors may change their sign between levels, so that two levels agree by chance.
        Therefore the first two are not enough, and the difference is taken to be at least that of
        the two levels before, divided by the largest factor that a level gains; or not divided, if
        the level changes the values by more than half of what the one before did. The refinement
        ends without success if the tolerance is out of reach, or if the third difference or a later
        one is that large.
    """
    chosen = tuning.UNIFORM_REFINEMENT

    def solved(level):
        return _Solved(level, *solve(grid.at_level(level)))

    found: list[_Solved] = []

    def change_by_box(level):
        wider, _ = solve(grid.at_level(level).enlarged())
        return 2 * np.abs(wider - found[level].values)

    box = BoxEffect(change_by_box, lambda change: share(change, found[-1].values))

    def error(solutions):
        found[:] = solutions
        last = found[-1]
        changes = _changes([level.values for level in found])
        size = share(changes[-1], last.values)
        falling = len(changes) < 2 or size <= share(changes[-2], found[-2].values) / 2
        reach = chosen.gain ** (chosen.highest - last.level) / chosen.safety
        change = changes[-1] if falling else np.maximum(*changes[-2:])
        bound = chosen.safety * change + 2 * last.inexact
        agreed = len(changes) > 1 and share(bound, last.values) <= 1
        if agreed:
            bound = bound + box.below(
                min(chosen.boxed, last.level - 1),
                last.level,
                lambda effect: share(bound + effect, last.values) <= 1,
            )
            agreed = share(bound, last.values) <= 1
        hopeless = size > reach or (len(changes) > 2 and not falling)
        return _Error(bound, bool(agreed), bool(hopeless))

    result = until_agreement(
        range(chosen.highest + 1),
        solved,
        error,
        met=lambda _, error: error.agreed,
        hopeless=lambda _, error: error.hopeless,
    )
    return Refined(result.value.values, result.error.bound, result.met)


def _changes(values):
    """Return how much each level changes the values.

    It is taken to be at least the change by the level before, divided by the largest factor that a
    level gains.
    """
    changes = []
    for coarse, fine in pairwise(values):
        gained = changes[-1] / tuning.UNIFORM_REFINEMENT.gain if changes else 0.0
        changes.append(np.maximum(np.abs(fine - coarse), gained))
    return changes
