"""First-passage times of int g with two steps on the same noise.

Most paths have crossed long before the last time that is asked for. They are dropped a few times on
the way, so that the rest, side by side, take the less work.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.paths import tuning
from nonsmooth.paths.cost import require_memory
from nonsmooth.paths.ensembles import compiled_pairs, require_finite
from nonsmooth.paths.kernels.panel import Panel, new_panel
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.time_loop import march_pair
from nonsmooth.scenes.scene import Scene


def coupled_passages(
    scene: Scene,
    times: ArrayLike,
    sampling: Sampling,
    levels: tuple[float, float],
    noise_of: Scene | None = None,
) -> np.ndarray:
    """Simulate paths with a step and with half of it until both have crossed, or until the end.

    Parameters
    ----------
    scene : Scene
    times : array_like, shape (t,)
        Increasing times that the steps meet, "1"; the last one is the end.
    sampling : Sampling
        With the longer of the two steps; it must begin with the first path.
    levels : (float, float)
        Lower and upper level of int g.
    noise_of : Scene, optional
        A scene from the same start whose random numbers are used, by which ensembles of
        scenes with other parameters are compared path by path; the scene's own unless given.

    Returns
    -------
    numpy.ndarray, shape (2, paths)
        First-passage times with step h/2 and h, interpolated within a step; inf if there is none.

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    """
    grid, pairs = compiled_pairs(scene, times, sampling)

    def panel(block):
        return new_panel(noise_of or scene, sampling.seed, block, sampling.precision)

    def run(job):
        block, count = job
        panels, passage = [panel(block), panel(block)], np.full((2, count), np.inf)
        left, began = np.arange(count), 0.0
        for steps, h in _pieces(grid):
            own = np.ascontiguousarray(passage[:, left])
            march_pair(*pairs[h], *panels, len(left), steps, *levels, began, own)
            passage[:, left] = own
            began += steps * h
            for each in panels:
                require_finite(each.total[:, : len(left)])
            waiting = np.isinf(own).any(axis=0)
            left = left[waiting]
            if not len(left):
                break
            _keep(panels, waiting)
        return passage

    require_memory(4 * sampling.paths)
    return np.concatenate(list(parallel(run, sampling, 3 * sum(n for n, _ in grid))), axis=1)


def _pieces(grid: list) -> Iterator[tuple[int, float]]:
    """Divide a grid of steps further, into pieces after which paths are dropped."""
    longest = -(-sum(steps for steps, _ in grid) // tuning.PASSAGES.pieces)
    for steps, h in grid:
        for first in range(0, steps, longest):
            yield min(longest, steps - first), h


def _keep(panels: list[Panel], lanes: np.ndarray) -> None:
    """Move the chosen lanes of panels to the front."""
    count, kept = len(lanes), np.count_nonzero(lanes)
    for panel in panels:
        for rows in (panel.words, panel.data, panel.total):
            rows[:, :kept] = rows[:, :count][:, lanes]
