"""Whether leading paths to a threshold is quicker than counting those that reach it by chance.

Both errors fall with the root of the number of paths. For one path, that of counting is
sqrt(W (1 - W)), that of led ones a multiple of W. So led paths win where W is small against the
tolerance's inverse square, which the Brownian limit tells beforehand.
"""

from contextlib import suppress

import numpy as np

from nonsmooth.crossing import tuning
from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.paths.resolution import coarse_step, paths_for
from nonsmooth.paths.tilted import poisson
from nonsmooth.scenes.scene import Scene


def leading_is_quicker(
    scene: Scene, thresholds: np.ndarray, horizons: np.ndarray, p: float, tol: float
) -> bool:
    """Predict which of the two ways of sampling takes fewer steps.

    Parameters
    ----------
    scene : Scene
    thresholds : numpy.ndarray, shape (m, 2)
        Lower and upper levels, "1".
    horizons : numpy.ndarray, shape (k,)
    p : float
    tol : float
        Absolute error.
    """
    chosen = tuning.METHOD_CHOICE
    steps = p * horizons[-1] / coarse_step(scene)
    fewest = tuning.COUNTING.skew / tol
    slow = max(1.0, 1 / scene.damping)  # the fit follows paths for some relaxation times
    if max(fewest, paths_for(0.5, tol)) * steps < chosen.counted_steps * slow:
        return False  # counting takes no time, whatever the probability is
    # int g does not spread like a Brownian motion, or the fit would take too many steps
    with suppress(SceneError, ToleranceError):
        guide = poisson.fitted(scene, coarse_step(scene) / 2, 0)
        centres = guide.mean * np.sqrt(p) * horizons[-1] + guide.ahead / np.sqrt(p)
        lower, upper = (thresholds - centres).T / guide.gamma
        if np.any((lower >= 0) | (upper <= 0)):
            return False  # paths reach a threshold in the mean
        W = brownian_crossing(upper, horizons[-1], lower)
        counted = max(fewest, *(paths_for(np.sqrt(w * (1 - w)), tol) for w in W))
        fitted = chosen.fitted_steps * slow
        led = [fitted + paths_for(chosen.spread_led * w, tol) * steps for w in W]
        return bool(chosen.dearer * sum(led) < counted * steps)
    return False
