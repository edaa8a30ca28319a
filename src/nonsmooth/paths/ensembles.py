"""Ensembles of paths: blocks are simulated in parallel and their results added in order."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import SceneError
from nonsmooth.paths.control_variate import poisson_slope
from nonsmooth.paths.cost import require_memory
from nonsmooth.paths.kernels.histogram import count_pairs, place
from nonsmooth.paths.kernels.panel import STATE, TOTAL_DELTA, extremes, new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.parallel import kept_at_once, parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.paths.time_loop import (
    EVERYWHERE,
    compile_march,
    compile_march_pair,
    march,
    march_and_sum,
    march_pair_and_sum,
)
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


def gram(
    scene: Scene, times: ArrayLike, sampling: Sampling, control: bool = True, parts: int = 1
) -> np.ndarray:
    """Simulate an ensemble, or a part of it, and return the sums that its moments are made of.

    Parameters
    ----------
    scene : Scene
    times : array_like, shape (t,)
        Increasing output times, "1".
    sampling : Sampling
    control : bool
        Whether to run the control variate, where there is one.
    parts : int
        Number of shorter steps into which each step is divided.

    Returns
    -------
    numpy.ndarray, shape (t, 5, 5)
        Sums over the paths of the products of (1, D, D^2, M, M^2 - <M>), D = int_0^t g and M
        its martingale part.

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    """
    grid = [(parts * steps, h / parts) for steps, h in equal_steps(times, sampling.step)]
    require_memory(25 * len(grid) * kept_at_once(sampling))
    coefficients = _coefficients(scene, grid, sampling, control)
    joined = registry.scheme(scene, sampling.scheme).gains_in_kicks(scene)

    def run(job):
        block, count = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        sums, first = np.zeros((len(grid), 5, 5)), 0
        for (steps, h), alike in groupby(grid):
            last = first + len(list(alike))
            march_and_sum(coefficients[h], panel, count, steps, sums[first:last], joined)
            first = last
        return sums

    total = np.zeros((len(grid), 5, 5))
    for sums in parallel(run, sampling, sum(steps for steps, _ in grid)):
        require_finite(sums)
        total += sums
    return total


def _coefficients(scene, grid, sampling, control):
    """Return the coefficients of the steps of each length, having compiled the loop for them."""
    slope = poisson_slope(scene) if control else None
    coefficients = {
        h: registry.coefficients(scene, sampling.scheme, h, sampling.precision, slope)
        for h in {h for _, h in grid}
    }
    compile_march(coefficients[grid[0][1]], new_panel(scene, sampling.seed, 0, sampling.precision))
    return coefficients


def over_blocks(
    scene: Scene, grid: list, sampling: Sampling, reduce: Callable, control: bool = True
) -> Iterator[np.ndarray]:
    """Simulate every block of paths and collect results at the output times.

    Parameters
    ----------
    scene : Scene
    grid : list of (int, float)
        Number of steps up to each output time and their length, as from `equal_steps`.
    sampling : Sampling
        Its step is not used: the grid has the steps.
    reduce : callable
        Takes a block's panel (`kernels.panel`) at an output time and the number of its paths;
        returns an array, which is kept.
    control : bool
        Whether to run the control variate, where there is one.

    Yields
    ------
    numpy.ndarray
        One per block, in their order; the first axis is the output time.

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    ToleranceError
        If the simulation would take too long.
    """
    coefficients = _coefficients(scene, grid, sampling, control)

    def run(job):
        block, count = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        kept = []
        for steps, h in grid:
            march(coefficients[h], panel, count, steps, *EVERYWHERE)
            kept.append(reduce(panel, count))
        return np.array(kept)

    for result in parallel(run, sampling, sum(steps for steps, _ in grid)):
        require_finite(result)
        yield result


def occupation(
    scenes: Sequence[Scene],
    times: ArrayLike,
    sampling: Sampling,
    edges: Mapping[str, np.ndarray],
    keys: Sequence[tuple[str, ...]],
) -> Iterator[dict[tuple[str, ...], np.ndarray]]:
    """Simulate paths and count how many are in which cell, at output times together.

    Parameters
    ----------
    scenes : sequence of Scene
        Equal but for their starts, which blocks of paths take in turn.
    times : array_like, shape (t,)
        Increasing output times, "1".
    sampling : Sampling
    edges : dict
        Maps the names of variables to the edges of their cells.
    keys : sequence of tuple of str
        Names of one or two variables, whose cells are counted.

    Yields
    ------
    dict
        Maps keys to counts, first over the earlier half of the times and then over the later, for
        one block after the other. Cells contain their lower edges, the last one its upper, too.

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    ToleranceError
        If the simulation would take too long.
    """
    grid = equal_steps(times, sampling.step)
    cells = sum(math.prod(len(edges[name]) for name in key) for key in keys)
    require_memory(4 * cells * sampling.paths / BLOCK)
    ends = {name: np.append(e[:-1], np.nextafter(e[-1], np.inf)) for name, e in edges.items()}
    coefficients = _coefficients(scenes[0], grid, sampling, control=False)
    rows = {s.name: row for row, s in zip(STATE, STATE_VARIABLES, strict=True) if s.name in edges}

    def run(job):
        block, count = job
        panel = new_panel(scenes[block % len(scenes)], sampling.seed, block, sampling.precision)
        # counts beyond the cells are in the first and last entries, which are cut off
        counts = {key: np.zeros([2, *(len(ends[name]) + 1 for name in key)], int) for key in keys}
        cells = {name: np.zeros(count, int) for name in rows}
        nowhere = np.zeros(count, int)  # the column of a single variable
        for number, (steps, h) in enumerate(grid):
            half = 2 * number // len(grid)
            march(coefficients[h], panel, count, steps, *EVERYWHERE)
            for name, row in rows.items():
                place(panel.data[row, :count], ends[name], cells[name])
            for key, found in counts.items():
                own = found[half].reshape(found.shape[1], -1)
                count_pairs(own, cells[key[0]], cells[key[1]] if len(key) > 1 else nowhere)
        require_finite(panel.data[list(rows.values()), :count])
        return {key: found[:, *(slice(1, -1),) * len(key)] for key, found in counts.items()}

    yield from parallel(run, sampling, sum(steps for steps, _ in grid))


def paths_at(scene: Scene, times: ArrayLike, sampling: Sampling) -> np.ndarray:
    """Simulate paths and keep them at the output times.

    Returns
    -------
    numpy.ndarray, shape (t + 1, k + 1, paths)
        The scene's k state variables and D = int_0^t g, time 0 included.
    """
    rows = [row for row, s in zip(STATE, STATE_VARIABLES, strict=True) if s.name in scene.state]
    require_memory(2 * (len(rows) + 1) * (np.size(times) + 1) * sampling.paths)

    def state(panel, count):
        return np.vstack([panel.data[rows, :count], panel.total[TOTAL_DELTA, :count]])

    kept = list(
        over_blocks(scene, equal_steps(times, sampling.step), sampling, state, control=False)
    )
    start = state(new_panel(scene, sampling.seed, 0, sampling.precision), 1)
    later = np.concatenate(kept, axis=2)
    return np.concatenate([np.broadcast_to(start, (1, *later.shape[1:])), later])


def integrals_at(
    scene: Scene, times: ArrayLike, sampling: Sampling, control: bool = True
) -> np.ndarray:
    """Simulate D = int_0^t g and its martingale part, and keep them at the output times.

    Parameters
    ----------
    scene, times, sampling, control
        As for `gram`.

    Returns
    -------
    numpy.ndarray, shape (t, 3, paths)
        D, its martingale part M and the quadratic variation <M>; the last two are 0 without a
        control variate.
    """

    def totals(panel, count):
        return panel.total[:, :count].copy()

    require_memory(6 * np.size(times) * sampling.paths)
    kept = over_blocks(scene, equal_steps(times, sampling.step), sampling, totals, control)
    return np.concatenate(list(kept), axis=2)


def coupled(
    scene: Scene,
    times: ArrayLike,
    sampling: Sampling,
    levels: tuple[float, float] = EVERYWHERE,
) -> tuple[np.ndarray, np.ndarray]:
    """Simulate paths with a step and with half of it on the same noise.

    Parameters
    ----------
    scene, times
        As for `gram`.
    sampling : Sampling
        With the longer of the two steps; it must begin with the first path.
    levels : (float, float)
        Lower and upper level whose first passage by D is timed.

    Returns
    -------
    change : numpy.ndarray, shape (t, 4, 4)
        Sums over the paths of the products of (1, D_h - D_h/2, D_h^2 - D_h/2^2, D_h/2).
    passage : numpy.ndarray, shape (2, paths)
        First-passage times with step h/2 and h, inf if there is none; of no paths if both levels
        are infinite.
    """
    grid, pairs = compiled_pairs(scene, times, sampling)
    followed = tuple(levels) != EVERYWHERE
    joined = registry.scheme(scene, sampling.scheme).gains_in_kicks(scene)

    def run(job):
        block, count = job
        panel, other = (_new_panel(scene, sampling, block) for _ in range(2))
        passage = np.full((2, count if followed else 0), np.inf)
        sums, first, began = np.zeros((len(grid), 4, 4)), 0, 0.0
        for (steps, h), alike in groupby(grid):
            last = first + len(list(alike))
            both = (*pairs[h], panel, other, count, steps, levels)
            march_pair_and_sum(*both, began, steps * h, passage, sums[first:last], joined)
            began += (last - first) * steps * h
            first = last
        return sums, passage

    require_memory(4 * sampling.paths)
    return _gathered(run, grid, sampling)


def coupled_crossings(
    scene: Scene, times: ArrayLike, sampling: Sampling, intervals: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Simulate paths as `coupled` does and note by which output times they leave intervals.

    Parameters
    ----------
    scene, times, sampling
        As for `coupled`.
    intervals : numpy.ndarray, shape (m, 2)
        Lower and upper levels.

    Returns
    -------
    change : numpy.ndarray, shape (t, 4, 4)
        As from `coupled`.
    passage : numpy.ndarray, shape (m, 2, paths)
        First output times by which D has reached one of the levels, with step h/2 and h; inf if
        there is none.
    """
    grid, pairs = compiled_pairs(scene, times, sampling)
    lower, upper = intervals.T[:, :, None]

    def run(job):
        block, count = job
        panels = [_new_panel(scene, sampling, block) for _ in range(2)]
        passage, untimed = np.full((2, len(intervals), count), np.inf), np.full((2, count), np.inf)
        sums, began = np.zeros((len(grid), 4, 4)), 0.0
        for time, (steps, h), own in zip(np.asarray(times), grid, sums, strict=True):
            both = (*pairs[h], *panels, count, steps, EVERYWHERE)
            march_pair_and_sum(*both, began, steps * h, untimed, own[None], joined=False)
            began += steps * h
            for panel, found in zip(panels, passage, strict=True):
                low, high = extremes(panel, count, symmetric=False)
                found[np.isinf(found) & ((low <= lower) | (high >= upper))] = time
        return sums, passage.swapaxes(0, 1)

    require_memory(4 * len(intervals) * sampling.paths)
    return _gathered(run, grid, sampling)


def compiled_pairs(
    scene: Scene, times: ArrayLike, sampling: Sampling
) -> tuple[list[tuple[int, float]], dict[float, tuple[Any, Any]]]:
    """Return the grid of times and `pairs_of_steps` on it, having compiled the loop for them.

    Parameters
    ----------
    scene, times, sampling
        As for `coupled`.
    """
    grid = equal_steps(times, sampling.step)
    pairs = pairs_of_steps(scene, grid, sampling)
    compile_march_pair(*pairs[grid[0][1]], _new_panel(scene, sampling, 0))
    return grid, pairs


def pairs_of_steps(scene: Scene, grid: list, sampling: Sampling) -> dict[float, tuple[Any, Any]]:
    """Return the coefficients of half of each step and of the step, on the same noise.

    Parameters
    ----------
    scene : Scene
    grid : list of (int, float)
        Numbers of steps and their lengths, as from `equal_steps`.
    sampling : Sampling
        Its step is not used: the grid has the steps.
    """
    scheme, precision = sampling.scheme, sampling.precision
    return {
        h: (
            registry.coefficients(scene, scheme, h / 2, precision),
            registry.on_given_increments(registry.coefficients(scene, scheme, h, precision)),
        )
        for h in {h for _, h in grid}
    }


def _new_panel(scene, sampling, block):
    return new_panel(scene, sampling.seed, block, sampling.precision)


def _gathered(run, grid, sampling):
    """Run the blocks of coupled paths; add up their changes and join their passages."""
    total, passages = np.zeros((len(grid), 4, 4)), []
    for change, passage in parallel(run, sampling, 3 * sum(steps for steps, _ in grid)):
        require_finite(change)
        total += change
        passages.append(passage)
    return total, np.concatenate(passages, axis=-1)


def require_finite(result: np.ndarray) -> None:
    """Refuse a result that is not finite, because paths have diverged.

    Raises
    ------
    SceneError
    """
    if not np.all(np.isfinite(result)):
        raise SceneError(
            "the simulation diverged: the drift is not confining or too steep for the step; "
            "mend the potentials or choose a smaller step"
        )
