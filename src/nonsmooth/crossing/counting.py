"""Threshold crossing probabilities by counting paths."""

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from nonsmooth.checks import require_count, require_positive
from nonsmooth.errors import ToleranceError
from nonsmooth.paths import schemes
from nonsmooth.paths.ensembles import coupled, parallel, require_finite
from nonsmooth.paths.kernels.panel import TOTAL_DELTA, new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK, blocks, labelled
from nonsmooth.paths.moments import step_bias, variance_of_fine
from nonsmooth.paths.resolution import (
    MOST_STEPS,
    PILOT_PATHS,
    SIGMAS,
    SPREAD_SHARE,
    coarse_step,
    refined_step,
    require_possible,
    require_resolved,
)
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.paths.time_loop import march
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.thresholds import bounds

_CONFIDENCE = 0.997  # of the pilot's limits of the probability
_PILOT = 12.0  # paths of the pilot times the tolerance: one that changes sides is an eighth of it
_SKEW = 5.1  # counts by which the limits of the probability are off where nothing has crossed
_ENLARGE = 8  # times the paths, for a probability that has not been seen
_CHECKED = 1 + 3 / 8  # times the work of the paths: an eighth is run with half the step, too
_ATTEMPTS = 3  # at a step whose bias fits in

DESCRIPTIONS = {
    "probability": "probability of crossing sqrt(p) b by p T",
    "probability_error": "standard error of the probability",
    "lower": "lower 95 % confidence limit (Jeffreys)",
    "upper": "upper 95 % confidence limit (Jeffreys)",
}


def first_passage_counts(
    scene: Scene,
    threshold: float | tuple[float, float],
    horizons: ArrayLike,
    p: float,
    sampling: Sampling,
) -> np.ndarray:
    """Count the paths that cross sqrt(p) times the threshold between the horizons p T.

    A path is dropped once it has crossed.

    Parameters
    ----------
    scene : Scene
    threshold : float or (float, float)
        b or its lower and upper level, "1".
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    p : float
        Scale of the functional central limit theorem.
    sampling : Sampling
        The step is shortened to divide the intervals of p T.

    Returns
    -------
    numpy.ndarray of int, shape (k,)

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    """
    levels = np.sqrt(p) * np.array(bounds(threshold))
    grid = [
        (steps, schemes.coefficients(scene, sampling.scheme, h, sampling.precision))
        for steps, h in equal_steps(p * np.asarray(horizons, dtype=float), sampling.step)
    ]

    def run(job):
        block, lanes = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        left = [lanes]
        for steps, s in grid:
            left.append(march(s, panel, left[-1], steps, *levels))
        # a path that diverges never crosses
        require_finite([panel.total[TOTAL_DELTA, : left[-1]]])
        return -np.diff(left)

    counts = parallel(run, blocks(sampling.first_path, sampling.paths), sampling.threads)
    return np.asarray(sum(counts))


def first_passage_bias(
    scene: Scene,
    threshold: float | tuple[float, float],
    horizons: ArrayLike,
    p: float,
    sampling: Sampling,
) -> tuple[np.ndarray, np.ndarray]:
    """Measure what halving the time step changes in the crossing probability.

    Parameters
    ----------
    scene, threshold, horizons, p
        As for `first_passage_counts`.
    sampling : Sampling
        With the longer of the two steps.

    Returns
    -------
    bias, error : numpy.ndarray, shape (k,)
        Of the probability with the longer step, with its standard error.
    """
    times = p * np.asarray(horizons, dtype=float)
    levels = np.sqrt(p) * np.array(bounds(threshold))
    _, passage = coupled(scene, times, sampling, levels)
    return _bias_of_counts(scene, times, passage)


def _bias_of_counts(scene, times, passage):
    """Bias of the fraction crossed, from first-passage times with half the step and the step."""
    fine, coarse = passage
    paths = len(fine)
    change = (coarse[:, None] <= times).astype(float) - (fine[:, None] <= times)
    factor = 1 / (1 - 2 ** -schemes.scheme(scene, "strang").weak_order(scene))
    # where no path changed sides, as if one had
    error = np.sqrt(np.maximum(change.var(axis=0), 1 / paths) / paths)
    return factor * change.mean(axis=0), factor * error


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
    _, (fine, coarse) = coupled(scene, [p * horizon], sampling, levels)
    both = np.isfinite(fine) & np.isfinite(coarse)
    ratio = np.log(coarse[both] / fine[both])
    return np.array([len(ratio), ratio.sum(), np.sum(ratio**2)])


def proportion(successes, trials, level=0.95):
    """Estimate a probability with a confidence interval that holds down to rare events.

    The interval is Jeffreys' (Brown, Cai and DasGupta, Statist. Sci. 16, 2001), the quantiles of
    the beta law of the counts plus one half; its limits are 0 and 1 where nothing or everything
    was counted.

    Parameters
    ----------
    successes, trials : array_like of int
    level : float
        Confidence level of the two-sided interval.

    Returns
    -------
    estimate, lower, upper : numpy.ndarray
    """
    successes, trials = np.broadcast_arrays(successes, trials)
    a, b = successes + 0.5, trials - successes + 0.5
    lower = np.where(successes == 0, 0.0, scipy.special.betaincinv(a, b, (1 - level) / 2))
    upper = np.where(successes == trials, 1.0, scipy.special.betainccinv(a, b, (1 - level) / 2))
    return successes / trials, lower, upper


def least_steps(scene, time, tol):
    """Count the steps that `sampled_crossing` takes at least.

    Parameters
    ----------
    scene : Scene
    time : float
        Of a path, "1".
    tol : float

    Returns
    -------
    pilot, all : float
        Of the pilot, and of the fewest paths that meet the tolerance.
    """
    steps = time / coarse_step(scene)
    return 3 * min(PILOT_PATHS, _PILOT / tol) * steps, _SKEW / tol * steps


def sampled_crossing(
    scene,
    threshold,
    horizons,
    p,
    seed,
    threads,
    tol=1e-2,
    step=None,
    paths=None,
    precision="float32",
    most=MOST_STEPS,
):
    """Count paths; the step and the number of paths follow from `tol` unless given.

    A pilot runs paths with a coarse step and its half. Where hardly any of them cross, or nearly
    all, it is the answer. Otherwise there are as many paths as confidence limits show to be needed,
    with a step whose bias, extrapolated by the weak order, fits in; it is measured anew, and
    refined if it does not.

    Parameters
    ----------
    scene, threshold, horizons, p, seed, threads, tol, step, paths, precision
        As of `crossing.crossing_probability`, the threshold as a pair.
    most : float
        Steps of all paths, beyond which it is not tried.

    Returns
    -------
    values : dict
        As of `crossing_estimate`, and `step_bias` with its error.
    attributes : dict
        `step`, `paths`.

    Raises
    ------
    SceneError
        If a parameter is out of range, or a path diverges.
    ToleranceError
        If `tol` takes too many steps, or a step is so long that halving it does not measure its
        bias.
    """
    if step is not None:
        require_positive("step", step)
    if paths is not None:
        require_count("paths", paths)
    times, levels = p * horizons, np.sqrt(p) * np.array(threshold)
    order, allowed = schemes.scheme(scene).weak_order(scene), (1 - SPREAD_SHARE) * tol

    def halving(step, paths, label):
        own = Sampling(step, paths, labelled(seed, label), threads=threads, precision=precision)
        return _Halving(step, *coupled(scene, times, own, levels))

    def possible(paths, step, crossed, count):
        told = f"W = {crossed[-1] / count:.3g} has an error of {SIGMAS / 2 / np.sqrt(count):.1g}"
        require_possible(_CHECKED * paths, times[-1] / step, told, tol, most)

    def counted(step, wanted):
        """Numbers of crossed paths, and of as many paths as turn out to be wanted."""
        crossed, done = np.zeros(len(horizons), dtype=int), 0
        while done < wanted:
            more = Sampling(step, wanted - done, seed, done, threads, precision=precision)
            crossed = crossed + np.cumsum(first_passage_counts(scene, threshold, horizons, p, more))
            done = wanted
            if paths is None and _distance(crossed, done) > SPREAD_SHARE * tol:
                wanted = max(_paths_wanted(crossed, done, tol), done + BLOCK)
                possible(wanted, step, crossed, done)
        return crossed, done

    pilot, own_step, done, fewest = None, step, paths, PILOT_PATHS
    if step is None or paths is None:
        longest = coarse_step(scene) if step is None else step
        fewest = min(PILOT_PATHS, math.ceil(_PILOT / tol) if paths is None else paths)
        pilot = halving(longest, fewest, "pilot")
        crossed = pilot.crossed(times)
        bias, error = pilot.bias(scene, times)
        worst = np.max(np.abs(bias) + error)
        if step is None and paths is None:
            half = 2**-order
            if pilot.is_resolved(order) and _distance(crossed, fewest) + half * worst <= tol:
                return _outcome(crossed, fewest, longest / 2, half * bias, half * error)
        if paths is None:
            done = _paths_wanted(crossed, fewest, tol)
            possible(done, longest, crossed, fewest)
        if step is None:
            if worst > allowed and done // 8 > fewest:
                pilot = halving(longest, done // 8, "pilot")
                worst = np.max(np.abs(np.array(pilot.bias(scene, times))).sum(axis=0))
            own_step = refined_step(longest, worst, allowed, order)
            if paths is None:
                possible(done, own_step, crossed, fewest)
    for _ in range(_ATTEMPTS):
        crossed, done = counted(own_step, done)
        if paths is None and pilot.step == own_step:
            check = pilot
        else:
            check = halving(own_step, min(done, max(fewest, done // 8)), "halving")
        check.require_resolved(order)
        bias, error = check.bias(scene, times)
        if step is not None or np.max(np.abs(bias) - SIGMAS * error) <= allowed:
            return _outcome(crossed, done, own_step, bias, error)
        own_step = refined_step(own_step, np.max(np.abs(bias) + error), allowed, order)
    raise ToleranceError(
        f"W = {crossed[-1] / done:.3g} has a bias of {np.max(np.abs(bias)):.1e} by the step "
        f"{check.step:.1e}, which does not fall by the weak order; choose a step or loosen tol"
    )


def _outcome(crossed, paths, step, bias, error):
    values = crossing_estimate(crossed, paths) | {"step_bias": bias, "step_bias_error": error}
    return values, {"step": step, "paths": paths}


@dataclass(frozen=True)
class _Halving:
    """Paths with a step and with half of it on the same noise, see `trajectories.coupled`."""

    step: float
    change: np.ndarray
    passage: np.ndarray

    def crossed(self, times):
        """Count the paths that have crossed with half the step."""
        return np.sum(self.passage[0][:, None] <= times, axis=0)

    def bias(self, scene, times):
        """Bias of the fraction crossed, of the whole step, and its standard error."""
        return _bias_of_counts(scene, times, self.passage)

    def require_resolved(self, order):
        """Refuse a step at which halving does not measure the bias."""
        bias, error = step_bias(self.change, order)
        require_resolved(self.step, variance_of_fine(self.change)[-1], bias[-1], error[-1])

    def is_resolved(self, order):
        """Whether halving the step measures its bias."""
        try:
            self.require_resolved(order)
        except ToleranceError:
            return False
        return True


def _distance(crossed, paths):
    """Distance of the farthest confidence limit of the probabilities."""
    value, low, high = proportion(crossed, paths, _CONFIDENCE)
    return np.max(np.maximum(high - value, value - low))


def _paths_wanted(crossed, paths, tol):
    """Count paths, in whole blocks, whose limits should be as near as the tolerance asks for.

    Jeffreys' limits are SIGMAS standard deviations and _SKEW |1 - 2 W| counts away. W is taken a
    standard deviation nearer to 1/2, if that does not take more than _ENLARGE times the paths.
    """
    share = SPREAD_SHARE * tol

    def enough(W):
        spread, skew = SIGMAS * np.sqrt(W * (1 - W)), _SKEW * np.abs(1 - 2 * W)
        return ((spread + np.sqrt(spread**2 + 4 * skew * share)) / (2 * share)) ** 2

    W = crossed / paths
    error = crossing_estimate(crossed, paths)["probability_error"]
    careful = enough(np.where(W < 0.5, np.minimum(W + error, 0.5), np.maximum(W - error, 0.5)))
    wanted = np.max(np.maximum(enough(W), np.minimum(careful, _ENLARGE * paths)))
    return BLOCK * math.ceil(wanted / BLOCK)


def crossing_estimate(crossed, paths):
    """Turn numbers of crossed paths into `probability`, its standard error and 95 % limits.

    The standard error is that of Jeffreys' beta law, so that it is not 0 where none has crossed.
    """
    probability, lower, upper = proportion(crossed, paths)
    a, b = crossed + 0.5, paths - crossed + 0.5
    return {
        "probability": probability,
        "probability_error": np.sqrt(a * b / (a + b + 1)) / (a + b),
        "lower": lower,
        "upper": upper,
    }
