"""Crossing probabilities by Monte Carlo; a tolerance decides on paths and time step."""

import math
from dataclasses import dataclass

import numpy as np

from nonsmooth.crossing import tuning
from nonsmooth.crossing.counting import bias_of_counts, first_passage_counts
from nonsmooth.crossing.proportions import crossing_estimate, limits_less_bias, proportion
from nonsmooth.errors import ToleranceError
from nonsmooth.paths.ensembles import coupled, coupled_crossings
from nonsmooth.paths.kernels.random_numbers import BLOCK, labelled
from nonsmooth.paths.moments import step_bias, variance_of_fine
from nonsmooth.paths.resolution import (
    coarse_step,
    refined_step,
    require_possible,
    require_resolved,
)
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.scenes.scene import Scene


def least_steps(scene: Scene, time: float, tol: float) -> tuple[float, float]:
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
        Steps of the pilot, and steps of the fewest paths that may meet the tolerance.
    """
    steps = time / coarse_step(scene)
    counting = tuning.COUNTING
    pilot = 3 * min(MONTE_CARLO.pilot_paths, counting.pilot / tol)
    return pilot * steps, counting.skew / tol * steps


def sampled_crossing(
    scene: Scene,
    thresholds: np.ndarray,
    horizons: np.ndarray,
    p: float,
    seed: int | tuple,
    threads: int | None,
    tol: float = MONTE_CARLO.tolerance,
    step: float | None = None,
    paths: int | None = None,
    precision: str = "float32",
    most: float = MONTE_CARLO.most_steps,
) -> tuple[dict, dict]:
    """Count paths; the step and the number of paths follow from `tol` unless given.

    A pilot runs a few paths with a coarse step and its half. If hardly any of them cross, or nearly
    all, the pilot may be the answer. Otherwise its confidence limits tell how many paths are
    needed, and its bias, extrapolated by the weak order, tells the step. The bias is then measured
    anew, and the step is refined if the bias takes more than its part of the tolerance. One set of
    paths serves all thresholds; the one that needs most paths and the shortest step decides.

    Parameters
    ----------
    scene, horizons, p, seed, threads, tol, step, paths, precision
        As for `crossing_probability`.
    thresholds : numpy.ndarray, shape (m, 2)
        Lower and upper levels.
    most : float
        Largest number of steps of all paths. If more are needed, this raises an error instead.

    Returns
    -------
    values : dict
        What `crossing_probability` describes, arrays of the shape (m, k).
    attributes : dict
        `step`, `paths`.

    Raises
    ------
    SceneError
        If a path diverges.
    ToleranceError
        If `tol` needs too many steps, or a step is so long that halving it does not measure its
        bias.
    """
    request = _Request(
        scene, thresholds, horizons, p, seed, threads, tol, step, paths, precision, most
    )
    if step is not None and paths is not None:
        return request.answer(_Plan(step, paths, MONTE_CARLO.pilot_paths))
    pilot = request.pilot()
    if step is None and paths is None and (found := request.answer_of_pilot(pilot)):
        return found
    return request.answer(request.plan(pilot))


@dataclass(frozen=True)
class _Halving:
    """Paths with a step and with half of it on the same noise, see `coupled`.

    `passage` has the shape (m, 2, paths), `order`, that of the bias at each threshold, (m, 1).
    """

    step: float
    paths: int
    order: np.ndarray
    change: np.ndarray
    passage: np.ndarray

    def crossed(self, times):
        """Count the paths that have crossed with half the step."""
        return np.array([np.sum(fine[:, None] <= times, axis=0) for fine, _ in self.passage])

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


@dataclass(frozen=True)
class _Plan:
    """Step and number of paths to begin with.

    At least `fewest` paths measure the bias of the step. `halving` has measured it already, at
    some step, if a pilot has run.
    """

    step: float
    paths: int
    fewest: int
    halving: _Halving | None = None


@dataclass(frozen=True)
class _Request:
    """What `sampled_crossing` is asked for; a step or paths that are None are to be chosen."""

    scene: Scene
    thresholds: np.ndarray
    horizons: np.ndarray
    p: float
    seed: int | tuple
    threads: int | None
    tol: float
    step: float | None
    paths: int | None
    precision: str
    most: float

    @property
    def times(self):
        return self.p * self.horizons

    @property
    def order(self):
        return registry.scheme(self.scene).weak_order(self.scene)

    @property
    def allowed_bias(self):
        return (1 - MONTE_CARLO.spread_share) * self.tol

    def pilot(self):
        """Run few paths with a coarse step, unless the step or the paths are given."""
        fewest = self.paths
        if fewest is None:
            fewest = math.ceil(tuning.COUNTING.pilot / self.tol)
        paths = min(MONTE_CARLO.pilot_paths, fewest)
        step = coarse_step(self.scene) if self.step is None else self.step
        found = self.halved(step, paths, "pilot")
        nearer = tuning.COUNTING.nearer
        while self.step is None and np.any(found.order < self.order):
            step *= nearer
            if paths * self.times[-1] / step > min(tuning.COUNTING.pilot_steps, self.most):
                break
            found = self.halved(step, paths, "pilot")
        return found

    def order_of(self, step, paths, passage):
        """Order of the bias of a step at each threshold, shape (m, 1).

        Many paths may reach a near threshold within the first step. Those that have left by its end
        may never come back: of Brownian motion that is integrated once they are a part of the order
        1/4 in the step. Halving it changes little, then, but again and again.
        """
        first = equal_steps(self.times, step)[0][1] / 2
        paths = min(paths, MONTE_CARLO.pilot_paths)
        soon = self.passages([first], first, paths, "first step")[1]
        at_once = np.mean(np.isfinite(soon[:, 0]), axis=1)
        left = np.mean(passage[:, 0] > self.times[0], axis=1)
        near = (at_once > tuning.COUNTING.at_once) & (left > self.tol)
        return np.where(near, tuning.COUNTING.order_at_once, self.order)[:, None]

    def bias(self, halving):
        """Bias of the longer step of a halving, and its standard error."""
        each = zip(halving.passage, halving.order[:, 0], strict=True)
        found = np.array([bias_of_counts(self.times, *own) for own in each])
        return found[:, 0], found[:, 1]

    def answer_of_pilot(self, pilot):
        """Return values with half the step of the pilot, or None if they are too inaccurate."""
        bias, error = self.bias(pilot)
        off = distance(pilot.crossed(self.times), pilot.paths)
        off += np.max(2.0**-pilot.order * (np.abs(bias) + error))
        return self.outcome_of_pilot(pilot) if off <= self.tol else None

    def outcome_of_pilot(self, pilot):
        """Return values with half the step of the pilot; None if it does not measure the bias."""
        if not pilot.is_resolved(self.order):
            return None
        bias, error = self.bias(pilot)
        half = 2.0**-pilot.order
        crossed = pilot.crossed(self.times)
        return outcome(crossed, pilot.paths, pilot.step / 2, half * bias, half * error)

    def plan(self, pilot):
        """Choose from a pilot what is not given: the step, or the number of paths, or both."""
        paths, step = self.paths, self.step
        crossed, fewest = pilot.crossed(self.times), pilot.paths
        if self.paths is None:
            paths = paths_wanted(crossed, fewest, self.tol)
            self.require_possible(paths, pilot.step, crossed, fewest, pilot)
        if self.step is None:
            bias, error = self.bias(pilot)
            worst = np.max(np.abs(bias) + error)
            more = paths // MONTE_CARLO.halved
            if worst > self.allowed_bias and more > fewest:
                pilot = self.halved(pilot.step, more, "pilot")
                own = self.bias(pilot)
                worst = np.max(np.abs(np.array(own)).sum(axis=0))
            step = refined_step(pilot.step, worst, self.allowed_bias, self.order)
            if self.paths is None:
                self.require_possible(paths, step, crossed, fewest, pilot)
        return _Plan(step, paths, fewest, pilot)

    def answer(self, plan):
        """Count paths, and refine the step until its bias is within its part of the tolerance."""
        step, paths = plan.step, plan.paths
        for _ in range(tuning.COUNTING.attempts):
            crossed, paths = self.counted(step, paths, plan.halving)
            if self.paths is None and plan.halving.step == step:
                check = plan.halving
            else:
                fewer = min(paths, max(plan.fewest, paths // MONTE_CARLO.halved))
                check = self.halved(step, fewer, "halving")
            check.require_resolved(self.order)
            bias, error = self.bias(check)
            known = np.max(np.abs(bias) - MONTE_CARLO.sigmas * error)
            if self.step is not None or known <= self.allowed_bias:
                return outcome(crossed, paths, step, bias, error)
            step = refined_step(step, np.max(np.abs(bias) + error), self.allowed_bias, self.order)
        raise ToleranceError(
            f"W = {crossed.flat[-1] / paths:.3g} has a bias of {np.max(np.abs(bias)):.1e} by the "
            f"step {check.step:.1e}, which does not fall by the weak order; choose a step or "
            "loosen tol",
            outcome(crossed, paths, check.step, bias, error),
        )

    def counted(self, step, wanted, pilot):
        """Count paths until there are enough; return how many crossed, and how many there were."""
        crossed, done = np.zeros((len(self.thresholds), len(self.horizons)), dtype=int), 0
        while done < wanted:
            more = Sampling(
                step, wanted - done, self.seed, done, self.threads, precision=self.precision
            )
            counts = first_passage_counts(self.scene, self.thresholds, self.horizons, self.p, more)
            crossed = crossed + np.cumsum(counts, axis=1)
            done = wanted
            allowed = MONTE_CARLO.spread_share * self.tol
            if self.paths is None and distance(crossed, done) > allowed:
                wanted = max(paths_wanted(crossed, done, self.tol), done + BLOCK)
                self.require_possible(wanted, step, crossed, done, pilot)
        return crossed, done

    def halved(self, step, paths, label):
        """Run paths with a step and its half, on a noise of their own."""
        change, passage = self.passages(self.times, step, paths, label)
        return _Halving(step, paths, self.order_of(step, paths, passage), change, passage)

    def passages(self, times, step, paths, label):
        """Return changes by halving a step, and passage times of the shape (m, 2, paths)."""
        own = labelled(self.seed, label)
        sampling = Sampling(step, paths, own, threads=self.threads, precision=self.precision)
        levels = np.sqrt(self.p) * self.thresholds
        if len(levels) > 1:
            return coupled_crossings(self.scene, times, sampling, levels)
        # passage times that are interpolated within a step, in fewer calls
        change, passage = coupled(self.scene, times, sampling, tuple(levels[0]))
        return change, passage[None]

    def require_possible(self, paths, step, crossed, count, pilot):
        """Refuse too many steps; the message has the estimate from the first `count` paths."""
        W, error = crossed.flat[-1] / count, MONTE_CARLO.sigmas / 2 / np.sqrt(count)
        told = f"W = {W:.3g} has an error of {error:.1g}"
        work = tuning.COUNTING.checked * paths
        known = self.outcome_of_pilot(pilot)
        require_possible(work, self.times[-1] / step, told, self.tol, self.most, known)


def outcome(
    crossed: np.ndarray, paths: int, step: float, bias: np.ndarray, error: np.ndarray
) -> tuple[dict, dict]:
    """Return values and attributes of a count, as `sampled_crossing` does.

    Parameters
    ----------
    crossed : numpy.ndarray, shape (k,)
        Number of paths that have crossed, or the sum of their probabilities to have crossed: the
        spread of these is less than that of a count.
    paths : int
    step : float
    bias, error : numpy.ndarray, shape (k,)
        Of the step, with its standard error.
    """
    counted = crossing_estimate(crossed, paths)
    spread = counted["probability_error"]
    lower, upper = limits_less_bias(crossed, paths, bias, error)
    values = {
        "probability": counted["probability"],
        "probability_error": np.minimum(np.abs(bias) + np.hypot(spread, error), 1.0),
        "lower": lower,
        "upper": upper,
        "standard_error": spread,
        "step_bias": bias,
        "step_bias_error": error,
    }
    return values, {"step": step, "paths": paths}


def distance(crossed: np.ndarray, paths: int) -> float:
    """Distance of the farthest confidence limit of the probabilities."""
    value, low, high = proportion(crossed, paths, tuning.COUNTING.confidence)
    return np.max(np.maximum(high - value, value - low))


def paths_wanted(crossed: np.ndarray, paths: int, tol: float) -> int:
    """Return how many paths, in whole blocks, should bring the limits within the tolerance.

    Jeffreys' limits are three standard deviations and `skew` |1 - 2 W| counts away. To be careful,
    W is taken one standard deviation nearer to 1/2 than estimated; but this may not raise the
    number beyond `enlarge` times the paths so far.
    """
    share, counting = MONTE_CARLO.spread_share * tol, tuning.COUNTING

    def enough(W):
        spread = MONTE_CARLO.sigmas * np.sqrt(W * (1 - W))
        skew = counting.skew * np.abs(1 - 2 * W)
        return ((spread + np.sqrt(spread**2 + 4 * skew * share)) / (2 * share)) ** 2

    W = crossed / paths
    error = crossing_estimate(crossed, paths)["probability_error"]
    careful = enough(np.where(W < 0.5, np.minimum(W + error, 0.5), np.maximum(W - error, 0.5)))
    wanted = np.max(np.maximum(enough(W), np.minimum(careful, counting.enlarge * paths)))
    return BLOCK * math.ceil(wanted / BLOCK)
