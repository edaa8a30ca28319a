"""How far int g typically gets: a guess from few paths, with which searches begin."""

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
        "1"; beyond some relaxation times, the level is taken to grow like its square root.
    probability : float
        What is rarer than the paths can tell is taken from a normal tail.
    seed, threads
        As for `crossing_probability`.

    Returns
    -------
    float
        Positive.
    """
    scale = tuning.SCALE
    simulated = min(time, scale.longest / scene.damping)
    step = coarse_step(scene)
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
