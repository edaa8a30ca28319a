"""Ensembles of paths: blocks of lanes marched in parallel and summed in order."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from nonsmooth.checks import require_count
from nonsmooth.errors import SceneError
from nonsmooth.paths import schemes
from nonsmooth.paths.control_variate import poisson_slope
from nonsmooth.paths.kernels.panel import STATE, TOTAL_DELTA, new_panel
from nonsmooth.paths.kernels.random_numbers import blocks
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.paths.time_loop import march, march_pair
from nonsmooth.scenes.symbols import STATE_VARIABLES

_EVERYWHERE = (-np.inf, np.inf)  # levels that no path reaches


def parallel(work, jobs, threads=None):
    """Map `work` over `jobs` on `threads` threads (default: all cores); results in order."""
    require_count("threads", threads or os.cpu_count())
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        return list(pool.map(work, jobs))


def gram(
    scene,
    times,
    step,
    paths,
    seed,
    first_path=0,
    threads=None,
    scheme="strang",
    precision="float32",
    control=True,
    parts=1,
):
    """Simulate a part of an ensemble and add up what its moments are made of.

    Parameters
    ----------
    scene : Scene
    times : array_like, shape (t,)
        Increasing output times, "1".
    step : float
        Longest time step, "1".
    paths : int
        Number of paths.
    seed : int or tuple
    first_path : int
        Number of the first path of this part, a multiple of the block size.
    threads : int, optional
    scheme, precision : str
    control : bool
        Whether to run the control variate, where there is one.
    parts : int
        Into how many each step is divided.

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

    def products(panel, count):
        delta, martingale, variation = panel.total[:, :count]
        vector = np.ones((5, count))
        with np.errstate(over="ignore", invalid="ignore"):  # refused afterwards
            vector[1:] = delta, delta**2, martingale, martingale**2 - variation
            return vector @ vector.T

    grid = [(parts * steps, h / parts) for steps, h in equal_steps(times, step)]
    return sum(
        over_blocks(
            scene, grid, paths, seed, products, first_path, threads, scheme, precision, control
        )
    )


def over_blocks(scene, grid, paths, seed, reduce, first_path, threads, scheme, precision, control):
    """March every block of paths over a grid of `equal_steps`.

    Parameters
    ----------
    grid : list of (int, float)
    reduce : callable
        Takes a block's panel at an output time and the number of its paths, returns an array to
        be kept.
    scene, paths, seed, first_path, threads, scheme, precision, control
        As for `gram`.

    Returns
    -------
    list of numpy.ndarray
        One per block, with the output time in front.
    """
    slope = poisson_slope(scene) if control else None
    coefficients = {
        h: schemes.coefficients(scene, scheme, h, precision, slope) for h in {h for _, h in grid}
    }

    def run(job):
        block, count = job
        panel = new_panel(scene, seed, block, precision)
        kept = []
        for steps, h in grid:
            march(coefficients[h], panel, count, steps, *_EVERYWHERE)
            kept.append(reduce(panel, count))
        return np.array(kept)

    results = parallel(run, blocks(first_path, paths), threads)
    require_finite(results)
    return results


def paths_at(scene, times, step, paths, seed, scheme="strang", threads=None):
    """Simulate paths in double precision and keep them at the output times.

    Returns
    -------
    numpy.ndarray, shape (t + 1, k + 1, paths)
        The scene's k state variables and D, time 0 included.
    """
    rows = [row for row, s in zip(STATE, STATE_VARIABLES, strict=True) if s.name in scene.state]

    def state(panel, count):
        return np.vstack([panel.data[rows, :count], panel.total[TOTAL_DELTA, :count]])

    grid = equal_steps(times, step)
    kept = over_blocks(scene, grid, paths, seed, state, 0, threads, scheme, "float64", False)
    start = state(new_panel(scene, seed, 0, "float64"), 1)
    return np.concatenate(
        [np.broadcast_to(start, (1, len(start), paths)), np.concatenate(kept, axis=2)]
    )


def coupled(
    scene,
    times,
    step,
    paths,
    seed,
    threads=None,
    levels=_EVERYWHERE,
    scheme="strang",
    precision="float32",
):
    """Simulate paths with a step and with half of it on the same noise.

    Parameters
    ----------
    scene, times, paths, seed, threads, scheme, precision
        As for `gram`.
    step : float
        The longer of the two steps, "1".
    levels : (float, float)
        Lower and upper level whose first passage by D is timed.

    Returns
    -------
    change : numpy.ndarray, shape (t, 4, 4)
        Sums over the paths of the products of (1, D_h - D_h/2, D_h^2 - D_h/2^2, D_h/2).
    passage : numpy.ndarray, shape (2, paths)
        First-passage times with step h/2 and h, inf if there is none.
    """
    grid = equal_steps(times, step)
    pairs = [
        tuple(schemes.coefficients(scene, scheme, length, precision) for length in (h / 2, h))
        for _, h in grid
    ]

    def run(job):
        block, count = job
        panel, other = (new_panel(scene, seed, block, precision) for _ in range(2))
        passage = np.full((2, count), np.inf)
        products = np.empty((len(grid), 4, 4))
        vector = np.ones((4, count))
        began = 0.0
        for k, ((steps, h), (fine, coarse)) in enumerate(zip(grid, pairs, strict=True)):
            given = schemes.on_given_increments(coarse)
            march_pair(fine, given, panel, other, count, steps, *levels, began, passage)
            began += steps * h
            half, whole = panel.total[TOTAL_DELTA, :count], other.total[TOTAL_DELTA, :count]
            vector[1:] = whole - half, whole**2 - half**2, half
            products[k] = vector @ vector.T
        return products, passage

    results = parallel(run, blocks(0, paths), threads)
    require_finite([change for change, _ in results])
    return sum(change for change, _ in results), np.hstack([passage for _, passage in results])


def require_finite(results):
    """Refuse results of paths that left every bound.

    Raises
    ------
    SceneError
    """
    if not all(np.all(np.isfinite(result)) for result in results):
        raise SceneError(
            "the simulation diverged: the drift is not confining or too steep for the step; "
            "mend the potentials or choose a smaller step"
        )
