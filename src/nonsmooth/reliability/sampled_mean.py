"""The mean time of the first passage by Monte Carlo.

Paths run with a step and with half of it up to a time at which hardly any is left. The few that are
left are censored: their times are prolonged by the inverse of the rate at which late paths cross,
as if it were constant from then on, and all of what this adds is part of the error.
"""

import math

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.paths.absorption.passages import coupled_passages
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import bias_over_change
from nonsmooth.paths.resolution import coarse_step, paths_for, refined_step, require_possible
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.reliability import tuning
from nonsmooth.scenes.scene import Scene


def sampled_mean_time(
    scene: Scene,
    lower: float,
    upper: float,
    tol: float,
    seed: int | tuple,
    threads: int | None,
    step: float | None = None,
    paths: int | None = None,
) -> tuple[float, float]:
    """E tau, tau the first time at which int g leaves (lower, upper).

    Parameters
    ----------
    scene : Scene
    lower, upper : float
        lower < 0 < upper.
    tol : float
        Relative error wanted: three standard errors are at most three quarters of it, and the bias
        of the step a quarter.
    seed, threads
        As for `crossing_probability`.
    step : float, optional
        Longer one of the two time steps, "1"; from `tol` unless given.
    paths : int, optional
        From `tol` unless given.

    Returns
    -------
    value, error : float
        The error is the standard error, the bias of the step, and what censored paths add.

    Raises
    ------
    ToleranceError
        If too many paths do not cross within a time that can be simulated, or `tol` takes too many
        steps.
    """
    order = registry.scheme(scene, "strang").weak_order(scene)

    def sample(step, paths, horizon, label):
        sampling = Sampling(step, paths, labelled(seed, label), threads=threads)
        passage = coupled_passages(scene, [horizon], sampling, (lower, upper))
        return _Sample(passage, horizon, order)

    settings, first = tuning.SAMPLED_MEAN, coarse_step(scene) if step is None else step
    horizon = tuning.SCALE.longest / scene.damping
    while True:
        pilot = sample(first, settings.paths, horizon, "pilot")
        if pilot.left <= settings.left * settings.paths:
            break
        horizon *= settings.longer
        if horizon / first > settings.most_steps:
            raise ToleranceError(
                f"{pilot.left / settings.paths:.0%} of the paths have not crossed by t = "
                f"{horizon / settings.longer:.1e}; choose nearer thresholds: the mean time is "
                "longer than can be simulated, or infinite"
            )
    mean = pilot.mean
    if step is None:
        bias = abs(pilot.bias) + pilot.bias_error
        allowed = (1 - MONTE_CARLO.spread_share) * tol * mean
        step = refined_step(first, bias, allowed, order)
    if paths is None:
        paths = max(paths_for(pilot.deviation / mean, tol), settings.paths)
    horizon = pilot.time_of(settings.tail * tol)
    told = f"the mean time {mean:.3g} has an error of {pilot.error:.1g}"
    require_possible(3 * paths, horizon / step, told, tol, result=(mean, pilot.error))
    found = sample(step, paths, horizon, "run")
    return found.mean, found.error


class _Sample:
    """Passage times up to a horizon, with half of a step and with it.

    Parameters
    ----------
    passage : numpy.ndarray, shape (2, paths)
        inf if there is none.
    horizon : float
    order : float
        Weak order of the scheme.
    """

    def __init__(self, passage: np.ndarray, horizon: float, order: float):
        fine, coarse = np.minimum(passage, horizon)
        count = len(fine)
        self.left = int(np.sum(~np.isfinite(passage[0])))
        self._late = float(np.median(fine))
        crossed = np.sum((fine > self._late) & np.isfinite(passage[0]))
        exposure = np.sum(np.maximum(fine - self._late, 0.0))
        self._rate = max(float(crossed), 0.5) / max(exposure, np.finfo(float).tiny)
        # one path more than are left: it may be chance that none is
        self._tail = (self.left + 1) / count / self._rate
        self.deviation = float(fine.std())
        self.mean = float(fine.mean()) + self.left / count / self._rate
        change = coarse - fine
        factor = bias_over_change(order) - 1  # of half the step
        self.bias = factor * float(change.mean())
        self.bias_error = factor * float(change.std()) / math.sqrt(count)
        spread = self.deviation / math.sqrt(count)
        self.error = self._tail + abs(self.bias) + math.hypot(spread, self.bias_error)

    def time_of(self, share: float) -> float:
        """Return the time at which so many of the paths are left, by the rate of late ones."""
        return self._late + max(math.log(0.5 / share), 1.0) / self._rate
