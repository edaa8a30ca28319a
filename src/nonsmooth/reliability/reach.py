"""How far int g typically gets: a guess from few paths, with which searches begin."""

from collections.abc import Callable

import numpy as np

from nonsmooth.paths.ensembles import over_blocks
from nonsmooth.paths.kernels.panel import PEAK
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.resolution import coarse_step
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.reliability import tuning
from nonsmooth.scenes.scene import Scene


def typical_reach(
    scene: Scene, time: float, probability: float, seed: int | tuple, threads: int | None
) -> float:
    """Guess the level that max |int g| exceeds with a probability by a time.

    Parameters
    ----------
    scene : Scene
    time : float
        "1"; beyond some relaxation times, or many steps, the level is taken to grow like its square
        root.
    probability : float
        What is rarer than the paths can tell is taken from a normal tail.
    seed, threads
        As for `crossing_probability`.

    Returns
    -------
    float
        Positive.
    """
    scale, step = tuning.SCALE, coarse_step(scene)
    simulated = min(time, scale.longest / scene.damping, scale.steps * step)
    sampling = Sampling(step, scale.paths, labelled(seed, "reach"), threads=threads)

    def peaks(panel, lanes):
        return panel.data[PEAK, :lanes].astype(float)

    grid = equal_steps([simulated], step)
    found = np.hstack(list(over_blocks(scene, grid, sampling, peaks, control=False)))[0]
    least = scale.counted / scale.paths
    known = np.clip(probability, least, 1 - least)
    near, far = np.quantile(found, [1 - np.sqrt(known), 1 - known])
    if probability < known and near < far:  # log W = a - c b^2 through both quantiles
        slope = (far**2 - near**2) / (np.log(np.sqrt(known)) - np.log(known))
        far = np.sqrt(far**2 + slope * np.log(known / probability))
    return float(max(far, np.finfo(float).tiny) * np.sqrt(time / simulated))


def typical_time(reach: Callable[[float], float], level: float, start: float) -> float:
    """Guess when a level is reached, by the secant method in logarithms.

    Parameters
    ----------
    reach : callable
        Takes a time > 0 and returns the typical reach by then.
    level : float
        "1".
    start : float
        Time to begin with, "1".

    Returns
    -------
    float
    """
    scale, time, before = tuning.SCALE, np.log(start), None
    for _ in range(scale.attempts):
        gap = np.log(level / reach(np.exp(time)))
        if abs(gap) < np.log(scale.near):
            break
        # late, int g spreads like the root of the time; early, like a power up to 3/2
        power = scale.powers[int(gap < 0)]
        if before is not None:
            found = (before[1] - gap) / (time - before[0])
            power = np.clip(found, *scale.powers)
        before = time, gap
        time += gap / power
    return float(np.exp(time))
