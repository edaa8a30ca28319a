"""The mean time to failure, the integral of the survival probability over all times."""

import math
import time
from functools import partial

import numpy as np

from nonsmooth.checks import (
    require_choice,
    require_count,
    require_positive,
    require_seed,
    require_threads,
    require_tolerance,
)
from nonsmooth.errors import SceneError, answered, first_answer
from nonsmooth.estimate import Estimate
from nonsmooth.linear_algebra.effort import limited
from nonsmooth.reliability import transformed_mean, tuning
from nonsmooth.reliability.sampled_mean import sampled_mean_time
from nonsmooth.scenes.scene import Scene, require_random
from nonsmooth.scenes.thresholds import bounds
from nonsmooth.statistics.mean import mean

METHODS = "deterministic", "monte_carlo"


def mean_time_to_failure(
    scene: Scene,
    threshold: float | tuple[float, float],
    p: float = 1.0,
    method: str | None = None,
    tol: float | None = None,
    step: float | None = None,
    paths: int | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
) -> Estimate:
    """Mean of the time T at which int_0^t g first leaves an interval, t = p T.

    Parameters
    ----------
    scene : Scene
    threshold : float or (float, float)
        As for `crossing_probability`. One-sided thresholds have a finite mean only if the mean of g
        points to them.
    p : float
        Scale, as for `crossing_probability`.
    method : {"deterministic", "monte_carlo"}, optional
        ``"deterministic"`` takes the transform of the passage time to z -> 0; it is for the scenes
        for which `crossing_probability` has it, with finite thresholds, unless the start is far in
        the tails, and is chosen for these unless `step` or `paths` is given. Where it misses the
        tolerance, ``"monte_carlo"`` is tried, too, unless a method is given or g grows faster than
        the theorems allow.
    tol : float, optional
        Relative error wanted; 1e-6 and 1e-3 (deterministic, one and two variables) or 2e-2 (Monte
        Carlo) unless given.
    step, paths : optional
        Time step and number of paths; ``"monte_carlo"`` only. From `tol` unless given.
    seed, threads
        As for `crossing_probability`.

    Returns
    -------
    Estimate
        In the unit of T. The error of ``"deterministic"`` is estimated from several resolutions;
        that of ``"monte_carlo"`` is the standard error, the bias of the step, and what the few
        paths are taken to add that have not crossed at the end.

    Raises
    ------
    SceneError
        If an argument is out of range, the mean is infinite, or the method does not take the scene.
    ToleranceError
        If `tol` cannot be met, and then the best is its `result`; or if the paths do not cross
        within a time that can be simulated.
    """
    began = time.perf_counter()
    require_random(scene)
    lower, upper = math.sqrt(require_positive("p", p)) * np.array(bounds(threshold))
    method = None if method is None else require_choice("method", method, METHODS)
    tol = None if tol is None else require_tolerance(tol)
    step = None if step is None else require_positive("step", step)
    paths = None if paths is None else require_count("paths", paths)
    seed, threads = require_seed(seed), require_threads(threads)
    one_sided = bool(np.isinf(lower) or np.isinf(upper))
    if one_sided:
        _require_drift(scene, 1 if np.isinf(lower) else -1, seed, threads)
    solvable = transformed_mean.applies(scene) and not one_sided
    if method is None:
        sampled = not solvable or step is not None or paths is not None
        ways = ["monte_carlo"] if sampled else ["deterministic"]
        # of a g that grows too fast, the bias of a step is not known well enough to be told
        if not sampled and not scene.grows_too_fast:
            ways.append("monte_carlo")
    else:
        ways = [method]
    if method == "deterministic" and (one_sided or step is not None or paths is not None):
        raise SceneError(
            "the deterministic mean time takes finite thresholds, no step and no paths; leave them "
            "out or use method='monte_carlo'"
        )

    def attempt(way):
        if way == "deterministic":
            wanted = transformed_mean.default_tolerance(scene) if tol is None else tol
            found = partial(transformed_mean.transformed_mean, scene, lower, upper, wanted)
        else:
            wanted = tuning.SAMPLED_MEAN.tolerance if tol is None else tol
            given = (wanted, seed, threads, step, paths)
            found = partial(sampled_mean_time, scene, lower, upper, *given)
        return answered(found, lambda pair: (way, *pair))

    def good_enough(found):
        """Whether Monte Carlo, which follows the transform, would not be better."""
        _, value, error = found
        return tol is None and error <= tuning.SAMPLED_MEAN.tolerance * value

    def present(found):
        way, value, error = found
        return Estimate(float(value / p), float(error / p), way, time.perf_counter() - began)

    def solve():
        attempts = [partial(attempt, way) for way in ways]
        return first_answer(attempts, error=lambda found: found[2], good_enough=good_enough)

    with limited(tol):
        return answered(solve, present, tol_given=tol is not None)


def _require_drift(scene, side, seed, threads):
    """Refuse a single threshold to which int g does not drift."""
    drift = mean(scene, seed=seed, threads=threads)
    if not side * drift.value > 3 * drift.error:
        raise SceneError(
            f"the mean time to one threshold is infinite, or paths may never cross it, as E g = "
            f"{drift.value:.3g} does not point to it; give a lower and an upper level, or ask for "
            "the median, failure_time"
        )
