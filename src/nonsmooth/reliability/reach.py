"""How far int g typically gets: a guess from few paths, with which searches begin."""

from collections.abc import Callable

import numpy as np

from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.errors import SceneError
from nonsmooth.paths.ensembles import over_blocks
from nonsmooth.paths.kernels.panel import PEAK
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.resolution import coarse_step
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.reliability import tuning
from nonsmooth.reliability.roots import FALLING, equivalent
from nonsmooth.scenes.scene import Scene


def typical_reach(
    scene: Scene, time: float, brownian: float, seed: int | tuple, threads: int | None
) -> tuple[float, float]:
    """Guess the level that max |int g| exceeds by a time as often as Brownian motion another one.

    Parameters
    ----------
    scene : Scene
    time : float
        "1"; beyond some relaxation times, or many steps, the level is taken to grow like its square
        root.
    brownian : float
        The level of Brownian motion by the time 1, "1". Where it is rarer, or more frequent, than
        the paths can tell, the level is extrapolated.
    seed, threads
        As for `crossing_probability`.

    Returns
    -------
    level : float
        0 if int g stays 0 so often.
    slope : float
        Of the logarithm of the level of Brownian motion over that of the level.
    """
    scale, step = tuning.SCALE, coarse_step(scene)
    simulated = min(time, scale.longest / scene.damping, scale.steps * step)
    sampling = Sampling(step, scale.paths, labelled(seed, "reach"), threads=threads)

    def peaks(panel, lanes):
        return panel.data[PEAK, :lanes].astype(float)

    grid = equal_steps([simulated], step)
    found = np.hstack(list(over_blocks(scene, grid, sampling, peaks, control=False)))[0]
    least = scale.counted / scale.paths
    known = np.clip(brownian_crossing(brownian, 1.0), least, 1 - least)
    both = np.array([np.sqrt(known), known])
    near, far = np.quantile(found, 1 - both)
    levels = [equivalent(_two_sided, W, FALLING) for W in both]
    slope = 1.0
    if 0 < near < far:
        slope = float(np.clip(np.diff(levels)[0] / np.log(far / near), *scale.slopes))
    change = np.log(brownian) - levels[1]
    # towards 0 the slope is that of large levels no longer: the level may not be near by far
    far *= np.exp(change / (slope if change > 0 else max(slope, 1.0)))
    return float(far * np.sqrt(time / simulated)), slope


def _two_sided(b):
    return float(brownian_crossing(b, 1.0))


def typical_time(
    reach: Callable[[float], float], level: float, start: float
) -> tuple[float, float]:
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
    time : float
    power : float
        Of the time, with which the reach grows.

    Raises
    ------
    SceneError
        If the reach is 0 at the start or later.
    """
    scale, time, points = tuning.SCALE, np.log(start), []
    power = scale.powers[0]
    for _ in range(scale.attempts):
        typical = reach(np.exp(time))
        if typical == 0 and time >= np.log(start):
            raise SceneError(
                f"int g stays 0 on most paths up to t = {np.exp(time):g}, so that no time is known "
                f"by which it reaches {level:g}; choose another observable or more noise"
            )
        gap = np.log(level) - np.log(max(typical, np.finfo(float).tiny))
        points.append((gap, time))
        near = abs(gap) < np.log(scale.near)
        # late, int g spreads like the root of the time; early, like a power up to 3/2
        if len(points) > 1:
            found = (points[-2][0] - gap) / (time - points[-2][1])
            power = float(np.clip(found, *scale.powers))
        elif not near:
            power = scale.powers[int(gap < 0)]
        farthest = np.log(scale.farthest)
        time += np.clip(gap / power, -farthest, farthest)
        if near:
            return float(np.exp(time)), power
    return float(np.exp(min(points, key=lambda point: abs(point[0]))[1])), power
