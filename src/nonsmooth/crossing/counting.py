"""Counting paths that cross a threshold."""

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.paths.absorption.passages import coupled_passages
from nonsmooth.paths.ensembles import require_finite
from nonsmooth.paths.kernels.panel import TOTAL_DELTA, extremes, new_panel
from nonsmooth.paths.moments import bias_over_change
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.paths.time_loop import compile_march, march
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.thresholds import bounds, intervals


def first_passage_counts(
    scene: Scene,
    threshold: ArrayLike,
    horizons: ArrayLike,
    p: float,
    sampling: Sampling,
) -> np.ndarray:
    """Count the paths that cross sqrt(p) times the threshold between the horizons p T.

    A path is dropped once it has crossed all thresholds.

    Parameters
    ----------
    scene : Scene
    threshold : float, (float, float) or array_like
        b or its lower and upper level, or several of them, see `thresholds.intervals`, "1". All
        are counted on the same paths.
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    p : float
        Scale of the functional central limit theorem.
    sampling : Sampling
        The step is shortened to divide the intervals of p T.

    Returns
    -------
    numpy.ndarray of int, shape (k,)
        Or (m, k) for m thresholds in a list.

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    """
    thresholds, several = intervals(threshold)
    levels = np.sqrt(p) * thresholds
    symmetric = bool(np.all(levels[:, 0] == -levels[:, 1]))
    outermost = _outermost(levels, symmetric)
    lower, upper = levels.T[:, :, None]
    grid = [
        (steps, registry.coefficients(scene, sampling.scheme, h, sampling.precision))
        for steps, h in equal_steps(p * np.asarray(horizons, dtype=float), sampling.step)
    ]
    compile_march(grid[0][1], new_panel(scene, sampling.seed, 0, sampling.precision))

    def run(job):
        block, lanes = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        left, inside = lanes, [np.full(len(levels), lanes)]
        for steps, s in grid:
            left = march(s, panel, left, steps, *outermost)
            low, high = extremes(panel, left, symmetric)
            inside.append(np.sum((low > lower) & (high < upper), axis=1))
        # A path that diverges never crosses.
        require_finite(panel.total[TOTAL_DELTA, :left])
        return -np.diff(inside, axis=0).T

    counts = np.asarray(sum(parallel(run, sampling, sum(steps for steps, _ in grid))))
    return counts if several else counts[0]


def _outermost(levels, symmetric):
    """Return levels beyond which a path has left all intervals."""
    lower, upper = levels[:, 0].min(), levels[:, 1].max()
    if not symmetric and lower == -upper:
        # the time loop takes opposite levels as the sign that max |int g| is enough
        upper = min(np.nextafter(upper, np.inf), np.finfo(float).max)
    return lower, upper


def first_passage_shift(
    scene: Scene,
    threshold: float | tuple[float, float],
    horizon: float,
    p: float,
    sampling: Sampling,
) -> np.ndarray:
    """Measure how halving the time step shifts the first-passage times.

    Parameters
    ----------
    scene, threshold, p
        As for `first_passage_counts`.
    horizon : float
        T; paths that have not crossed by p T with both steps are left out.
    sampling : Sampling
        With the longer of the two steps.

    Returns
    -------
    numpy.ndarray, shape (3,)
        Sums over the paths of the powers 0 to 2 of log(time with step / time with step/2).
    """
    levels = np.sqrt(p) * np.array(bounds(threshold))
    fine, coarse = coupled_passages(scene, [p * horizon], sampling, levels)
    both = np.isfinite(fine) & np.isfinite(coarse)
    ratio = np.log(coarse[both] / fine[both])
    return np.array([len(ratio), ratio.sum(), np.sum(ratio**2)])


def bias_of_counts(
    times: np.ndarray, passage: np.ndarray, order: float
) -> tuple[np.ndarray, np.ndarray]:
    """Bias of the fraction crossed, from first-passage times on the same noise.

    Parameters
    ----------
    times : numpy.ndarray, shape (k,)
    passage : numpy.ndarray, shape (2, paths)
        First-passage times with half the step and with the step, from `coupled_passages`.
    order : float
        The bias is of this order in the step.

    Returns
    -------
    bias, error : numpy.ndarray, shape (k,)
        Of the fraction with the longer step, with its standard error.
    """
    fine, coarse = passage
    paths = len(fine)
    change = (coarse[:, None] <= times).astype(float) - (fine[:, None] <= times)
    factor = bias_over_change(order)
    # Even if all paths have the same outcome with both steps, the error is not 0: it is then that
    # of a single path with different outcomes.
    error = np.sqrt(np.maximum(change.var(axis=0), 1 / paths) / paths)
    return factor * change.mean(axis=0), factor * error
