"""Paths with two steps under an envelope, and how many of them have left intervals of the state."""

import functools
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.paths.absorption.envelope import scales
from nonsmooth.paths.absorption.loop import (
    STATIONARY,
    Intervals,
    compile_march_survival,
    march_survival,
)
from nonsmooth.paths.ensembles import pairs_of_steps, require_finite
from nonsmooth.paths.kernels.panel import DELTA, STATE, new_panel
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


def crossed(
    scene: Scene,
    variable: str | None,
    levels: ArrayLike,
    times: ArrayLike,
    sampling: Sampling,
    envelope: str | None = None,
) -> np.ndarray:
    """Sum up the probabilities of paths to have left intervals.

    Parameters
    ----------
    scene : Scene
    variable : str or None
        The variable of the state that leaves them; None stands for int g, which is then added up in
        the precision of the steps.
    levels : array_like, shape (m, 2)
        Lower and upper ends, between which it starts.
    times : array_like, shape (t,)
        Increasing.
    sampling : Sampling
        With the shorter of the two steps; its scheme must share the noise of two steps.
    envelope : str, optional
        Of the noise, see `envelope.scales`.

    Returns
    -------
    numpy.ndarray, shape (t, 3, m)
        Sums over the paths of C, C' - C and (C' - C)^2; C is the probability to have left the
        interval with the step, and C' that with twice the step.

    Raises
    ------
    SceneError
        If a path diverges, or the envelope is negative.
    """

    def sums(_panels, survival, _count):
        change = survival[0] - survival[1]
        return np.array([np.sum(part, axis=-1) for part in (1 - survival[0], change, change**2)])

    intervals = _intervals(scene, variable, np.asarray(levels, dtype=float))
    return functools.reduce(np.add, over_blocks(scene, intervals, times, sampling, envelope, sums))


def over_blocks(
    scene: Scene,
    intervals: Intervals,
    times: ArrayLike,
    sampling: Sampling,
    envelope: str | None,
    reduce: Callable,
) -> Iterator[np.ndarray]:
    """Simulate every block of paths with two steps and collect results at the output times.

    Parameters
    ----------
    scene, times, sampling, envelope
        As for `crossed`.
    intervals : Intervals
    reduce : callable
        Takes a block's panels with the step and with twice the step, the probabilities of their
        paths to have stayed inside of the intervals, shape (2, m, count), and the number of paths;
        returns an array, which is kept.

    Yields
    ------
    numpy.ndarray
        One per block, in their order; the first axis is the output time.

    Raises
    ------
    SceneError
        As `crossed` does.
    """
    precision = sampling.precision
    grid = equal_steps(times, 2 * sampling.step)
    pairs = pairs_of_steps(scene, grid, sampling)
    factors = _factors(envelope, grid)
    compile_march_survival(*pairs[grid[0][1]], new_panel(scene, sampling.seed, 0, precision))

    def run(job):
        block, count = job
        panels = [new_panel(scene, sampling.seed, block, precision) for _ in range(2)]
        before = np.tile(panels[0].data[intervals.row, :count].astype(float), (2, 1))
        survival, kept = np.ones((2, len(intervals.lower), count)), []
        for (steps, h), own in zip(grid, factors, strict=True):
            march_survival(*pairs[h], *panels, count, steps, intervals, before, survival, own)
            kept.append(reduce(panels, survival, count))
        require_finite(before)
        return np.array(kept)

    yield from parallel(run, sampling, 3 * sum(steps for steps, _ in grid))


def _factors(envelope, grid):
    """Return the factors of the noise in the fine steps up to each output time."""
    if envelope is None:
        return [STATIONARY] * len(grid)
    ends = np.cumsum([steps * h for steps, h in grid])
    return [
        scales(envelope, end - steps * h, h / 2, 2 * steps)
        for end, (steps, h) in zip(ends, grid, strict=True)
    ]


def _intervals(scene, variable, levels):
    lower, upper = np.ascontiguousarray(levels.T)
    if variable is None:
        return Intervals(DELTA, lower, upper, 0.0)
    place = [symbol.name for symbol in STATE_VARIABLES].index(variable)
    driven = variable == scene.noise.driven.name
    return Intervals(STATE[place], lower, upper, scene.noise.sigma**2 if driven else 0.0)
