"""gamma^2 by Monte Carlo, for every scene: the slope of the variance of int_0^t g.

With D(t) = int_0^t g, Var D(t) = gamma^2 t + constant + an exponentially small rest. The slope of
Var D between two times is free of the constant; Var D(t) / t is not. What is left of the rest at
the first of these times is extrapolated from the slopes before it.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.estimate import require
from nonsmooth.grids import potential_wells
from nonsmooth.paths.ensembles import coupled, integrals_at
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import mean_bias, step_bias
from nonsmooth.paths.resolution import (
    coarse_step,
    halving_paths,
    paths_for,
    refined_step,
    require_possible,
)
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.scenes.relaxation import rate_at_infinity
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning


@dataclass(frozen=True)
class Slopes:
    """Slopes of the mean and of the variance of D between the first and the last of three times.

    Attributes
    ----------
    gamma2, gamma2_error : float
        Slope of the variance and its standard error.
    mean, mean_error : float
        Slope of the mean, the stationary mean of g, and its standard error.
    settling, settling_error : float
        By how much the slope of the variance over the second half exceeds that over the first, and
        its standard error. It is 0 within the error once the scene has forgotten its start and its
        correlations.
    """

    gamma2: float
    gamma2_error: float
    mean: float
    mean_error: float
    settling: float
    settling_error: float

    @property
    def settled(self) -> bool:
        """Whether the slopes of the variance over both halves agree."""
        return abs(self.settling) <= _allowed(self.settling_error, self.gamma2)

    def agrees(self, other: "Slopes") -> bool:
        """Whether the slopes agree with those of another sample."""
        return all(
            abs(ours - theirs) <= _allowed(float(np.hypot(error, other_error)), ours)
            for ours, error, theirs, other_error in (
                (self.gamma2, self.gamma2_error, other.gamma2, other.gamma2_error),
                (self.mean, self.mean_error, other.mean, other.mean_error),
            )
        )


class Rest(NamedTuple):
    """What a slope still lacks, and whether more than noise was seen of it before.

    Attributes
    ----------
    size : float
    seen : bool
    """

    size: float
    seen: bool

    def is_little(self, wanted: float) -> bool:
        """Whether it hardly counts in an error of which so much is wanted."""
        return not self.seen or self.size <= tuning.SAMPLED_GAMMA2.rest_share * wanted


class _Settled(NamedTuple):
    """Slopes between times at which they have settled, and what is left of the rests.

    The times are `doubled` so many times.
    """

    doubled: int
    times: tuple[float, ...]
    slopes: Slopes
    gamma2_rest: Rest
    mean_rest: Rest


def _allowed(error, size):
    settled = tuning.SAMPLED_GAMMA2
    return max(settled.agreement_errors * error, settled.agreement * abs(size))


def slopes(sample: np.ndarray, times: Sequence[float]) -> Slopes:
    """Estimate the slopes from a sample of `integrals_at`.

    Parameters
    ----------
    sample : numpy.ndarray, shape (3, 3, paths)
    times : sequence of float
        Three increasing ones.

    Returns
    -------
    Slopes
    """
    first, second, whole = (
        _slopes_between(sample[[i, k]], times[k] - times[i]) for i, k in ((0, 1), (1, 2), (0, 2))
    )
    settling = second[0] - first[0]
    gamma2, gamma2_error, mean, mean_error = whole
    return Slopes(
        gamma2, gamma2_error, mean, mean_error, settling, float(np.hypot(first[1], second[1]))
    )


def _slopes_between(sample, span):
    """Slopes of the variance and of the mean of D, each with its standard error."""
    (d1, m1, q1), (d2, m2, q2) = sample
    paths = len(d1)
    square = ((d2 - d2.mean()) ** 2 - (d1 - d1.mean()) ** 2) / span * (paths / (paths - 1))
    gamma2 = _regressed(square, (m2**2 - q2 - m1**2 + q1) / span)
    return *gamma2, *_regressed((d2 - d1) / span, (m2 - m1) / span)


def _regressed(values, control):
    """Mean of values and its standard error, given a control variate of mean 0."""
    spread = control.var()
    slope = np.mean((values - values.mean()) * control) / spread if spread > 0 else 0.0
    rest = values - slope * control
    return float(rest.mean()), float(rest.std(ddof=1) / np.sqrt(len(values)))


def remaining(before: list, last: tuple, width: float, span: float) -> Rest:
    """Estimate what a slope lacks of its limit, if it is approached as by one real exponential.

    With q the factor by which what is lacking falls over twice the width, the sums of it over two
    neighbouring windows, the second twice as wide as the first, have the ratio sqrt(q) (1 +
    sqrt(q)), and what follows them is q / (1 - q) times the second.

    Parameters
    ----------
    before : list of (float, float)
        Slopes and standard errors in the two windows that end where the last slope begins.
    last : (float, float)
        The same of the last slope.
    width, span : float
        Of the first window, and of the last slope.

    Returns
    -------
    Rest
        Noise is added, for what it may hide. Infinite where the slopes before do not approach the
        last one.
    """
    apart = np.array([abs(last[0] - slope) for slope, _ in before])
    noise = np.array([math.hypot(last[1], error) for _, error in before])
    first, second = (apart > MONTE_CARLO.sigmas * noise).tolist()
    if not first:
        # half of what noise hides is taken to be left a window later; what shows in the second
        # window only does not fall
        left = float(apart[1] + noise[1]) * 2 * width / span
        return Rest(math.inf if second else left, second)
    size = 0.0
    for _ in range(tuning.SAMPLED_GAMMA2.rounds):
        lacking = apart + size  # the last slope lacks it, too
        root = (math.sqrt(1 + 8 * (lacking[1] + noise[1]) / lacking[0]) - 1) / 2
        if not root < 1:
            return Rest(math.inf, True)
        size = (lacking[1] + noise[1]) * 2 * width / span * root**2 / (1 - root**2)
    return Rest(float(size), True)


def gamma2_bias(scene: Scene, times: Sequence[float], sampling: Sampling) -> tuple[float, float]:
    """Bias of gamma^2 by the time step, as measured by halving it, and its standard error.

    Parameters
    ----------
    scene : Scene
    times : sequence of float
        The slope is from the first to the last.
    sampling : Sampling
        With the step whose bias is asked for.

    Returns
    -------
    bias, error : float
        The error is computed as if the variances at both times were independent, which makes it
        larger than the slope's own.
    """
    return _bias_of_slope(step_bias, scene, times, sampling)


def _bias_of_slope(biased, scene, times, sampling):
    """Bias of the slope of a moment by the time step, and its standard error."""
    change, _ = coupled(scene, [times[0], times[-1]], sampling)
    bias, error = biased(change, registry.scheme(scene, sampling.scheme).weak_order(scene))
    span = times[-1] - times[0]
    return float(bias[1] - bias[0]) / span, float(np.hypot(*error)) / span


def sampled_gamma2(
    scene: Scene,
    tol: float,
    seed: int | tuple = 0,
    threads: int | None = None,
    most: float = math.inf,
) -> tuple[float, float]:
    """Sample gamma^2 with as many paths and as short a step as a tolerance needs.

    Parameters
    ----------
    scene : Scene
    tol : float
        Relative; it bounds the bias of the step, what has not settled, and three standard errors.
    seed : int or tuple
    threads : int, optional
    most : float
        Largest number of steps of all paths together, those that measure the bias among them, as
        far as it is foreseen from a pilot. If more are needed, this raises an error instead of
        trying.

    Returns
    -------
    value, error : float
        The error is the bias of the step, what has not settled, and the standard error together.

    Raises
    ------
    ToleranceError
        If `tol` is not met, the slope does not settle, or int g is 0 on all paths.
    """
    least = tuning.SAMPLED_GAMMA2.least_tolerance
    if not tol >= least:
        raise ToleranceError(
            f"Monte Carlo cannot reach tol = {tol:g} for gamma^2; use tol >= {least:g} "
            "or method='deterministic'"
        )
    paths = fewer = MONTE_CARLO.pilot_paths
    step, doubled = coarse_step(scene), 0
    order = registry.scheme(scene).weak_order(scene)

    def enough(run):
        error = MONTE_CARLO.sigmas * run.slopes.gamma2_error
        return run.gamma2_rest.is_little(max(tol * run.slopes.gamma2, error))

    for attempt in range(MONTE_CARLO.attempts):
        own = Sampling(step, paths, labelled(seed, attempt), threads=threads)
        doubled, times, found, (rest, _), _ = _settled(scene, own, doubled, enough)
        halving = Sampling(step, fewer, labelled(own.seed, "halving"), threads=threads)
        bias, spread = gamma2_bias(scene, times, halving)
        if found.gamma2_error == 0:
            raise ToleranceError(
                f"int g is 0 on all of {paths} paths up to t = {times[-1]:g}, so that gamma^2 is "
                "too small to be sampled; choose method='deterministic' or another observable"
            )
        deviation = float(np.hypot(found.gamma2_error, spread))
        error = abs(bias) + rest + deviation
        unseen = spread == 0  # no path has moved of the fewer that are to measure the bias
        met = abs(bias) + rest + MONTE_CARLO.sigmas * deviation <= tol * found.gamma2 and not unseen
        if found.gamma2 < 5 * error and (met or attempt > 0):
            raise ToleranceError(
                f"gamma^2 = {found.gamma2:.1e} with an error of {error:.1e} may be 0, which it is "
                "if int_0^t g stays bounded, as for g = y where the displacement is confined; "
                "choose another observable, such as x",
                (found.gamma2, error),
            )
        if met:
            break
        allowed = max(tol * found.gamma2 - rest, error / 2)
        share = MONTE_CARLO.sigmas * spread / (tuning.SAMPLED_GAMMA2.halving_share * allowed)
        paths = max(paths, paths_for(math.sqrt(paths) * found.gamma2_error, allowed))
        fewer = max(fewer, paths if unseen else math.ceil(fewer * share**2))
        step = refined_step(step, abs(bias) + spread, MONTE_CARLO.bias_aim * allowed, order)
        told = f"gamma^2 = {found.gamma2:.6g} has an error of {error:.1e}"
        known = found.gamma2, error
        # a path that measures the bias runs with the step and with its half
        require_possible(paths + 3 * fewer, times[-1] / step, told, tol, most, known)
    require(met, found.gamma2, error, tol)
    return found.gamma2, error


def sampled_mean(
    scene: Scene, tol: float | None = None, seed: int | tuple = 0, threads: int | None = None
) -> tuple[float, float]:
    """Sample the stationary mean of g.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Absolute; it bounds the bias of the step, what has not settled, and three standard errors.
        Unless given, a pilot is all that is run.
    seed : int or tuple
    threads : int, optional

    Returns
    -------
    value, error : float
        The error is the bias of the step, what has not settled, and the standard error together.

    Raises
    ------
    ToleranceError
        If `tol` is not met, the slope of the variance does not settle, or int g is 0 on all paths.
    """
    own, paths, step = labelled(seed, "mean"), MONTE_CARLO.pilot_paths, short_step(scene)
    doubled = 0
    order = registry.scheme(scene).weak_order(scene)

    def enough(run):
        return run.mean_rest.is_little(max(tol or 0.0, MONTE_CARLO.sigmas * run.slopes.mean_error))

    for _ in range(MONTE_CARLO.attempts):
        sampling = Sampling(step, paths, own, threads=threads)
        doubled, times, found, _, (rest, _) = _settled(scene, sampling, doubled, enough)
        halving = replace(sampling.labelled("halving"), paths=halving_paths(paths))
        bias, spread = _bias_of_slope(mean_bias, scene, times, halving)
        if found.mean == found.mean_error == 0:
            raise ToleranceError(
                f"int g is 0 on all of {paths} paths up to t = {times[-1]:g}, so that E g is too "
                "small to be sampled; choose another observable"
            )
        deviation = math.hypot(found.mean_error, spread)
        error = abs(bias) + rest + deviation
        if tol is None or abs(bias) + rest + MONTE_CARLO.sigmas * deviation <= tol:
            return found.mean, error
        allowed = max(tol - rest, tol / 2)
        more = paths_for(math.sqrt(paths) * deviation, allowed)
        shorter = refined_step(step, abs(bias) + spread, MONTE_CARLO.bias_aim * allowed, order)
        told = f"E g = {found.mean:.6g} has an error of {error:.1e}"
        known = found.mean, error
        require_possible(more, times[-1] / shorter, told, tol, result=known)
        paths, step = max(paths, more), shorter
    raise ToleranceError(f"{told}, above tol = {tol:g}; loosen tol", known)


def short_step(scene: Scene) -> float:
    """Return the first step for a stationary mean."""
    short = tuning.SAMPLED_GAMMA2.step_of_mean * min(1.0, 1 / scene.damping)
    return min(short, registry.longest_step(scene) / 2)


def first_times(scene: Scene) -> tuple[float, ...]:
    """Choose the times between which the slope is first taken.

    They are longer if the drift relaxes slowly: the first is at least two relaxation times.

    Raises
    ------
    ToleranceError
        If paths cannot wait for so long.
    """
    settled = tuning.SAMPLED_GAMMA2
    try:
        decay = rate_at_infinity(scene.with_n(min(scene.n, settled.soft)))
    except SceneError:  # The drift is not linear far from 0. `_settled` has to find the times.
        return settled.times
    if decay.value <= 0:  # as in a potential |x|, whose force does not grow
        return settled.times
    rate, first = decay.value / 2, settled.times[0]
    if settled.relaxed / rate > settled.longest:
        raise ToleranceError(
            f"the drift relaxes in a time of {1 / rate:.2g}, for which paths cannot wait; choose "
            "parameters of more similar sizes"
        )
    return tuple(max(1.0, settled.relaxed / (rate * first)) * t for t in settled.times)


def _settled(scene, sampling, begun: int, enough: Callable[[_Settled], bool]) -> _Settled:
    """Lengthen the times until the slope of the variance depends neither on them nor on the start.

    They are doubled, `begun` times at first. What is left of the rests, of which the caller tells
    whether it is little enough, follows from two windows before the first time, in the last three
    quarters of the way to it.

    Paths that never leave the well they start in settle, too, but on the wrong slope. To notice
    this, a few paths start from each well of the potentials (the scouts); all slopes have to agree.
    """
    elsewhere = [scene.with_start(start) for start in potential_wells.starts(scene)]
    first = first_times(scene)
    for doubled in range(begun, tuning.SAMPLED_GAMMA2.doublings):
        times = tuple(2**doubled * t for t in first)
        scouts = []
        own = sampling.labelled(doubled)
        if len(elsewhere) > 1:
            few = replace(own, paths=tuning.SAMPLED_GAMMA2.scouts)
            scouts = [slopes(integrals_at(other, times, few), times) for other in elsewhere]
        forgotten = all(a.agrees(b) for a, b in combinations(scouts, 2))
        if forgotten:
            sample = integrals_at(scene, (times[0] / 4, times[0] / 2, *times), own)
            run = _followed(sample, times, doubled)
            found = run.slopes
            if found.settled and all(found.agrees(scout) for scout in scouts) and enough(run):
                return run
    changes = (
        f"{found.gamma2:.3g}, still changing by {_change(run):.1g}"
        if forgotten
        else f"paths from {len(elsewhere)} wells of the potentials still differ"
    )
    raise ToleranceError(
        f"the growth rate of the variance has not settled by t = {times[-1]:g}: {changes}; "
        "the scene mixes slowly, or int_0^t g has no such rate"
    )


def _change(run):
    """Largest change of the slope of the variance that was seen."""
    rest, seen = run.gamma2_rest
    return max(abs(run.slopes.settling), rest if seen and math.isfinite(rest) else 0.0)


def _followed(sample, times, doubled):
    """Slopes of a sample at five times, and what is left of the rests, from the first windows."""
    found, width = slopes(sample[2:], times), times[0] / 4
    windows = [_slopes_between(sample[k : k + 2], (1 + k) * width) for k in (0, 1)]
    span = times[-1] - times[0]
    rests = [
        remaining([window[k : k + 2] for window in windows], last, width, span)
        for k, last in (
            (0, (found.gamma2, found.gamma2_error)),
            (2, (found.mean, found.mean_error)),
        )
    ]
    # of several exponentials the slowest shows between both halves
    beyond = abs(found.settling) - MONTE_CARLO.sigmas * found.settling_error
    if beyond / 2 > rests[0].size:
        rests[0] = Rest(beyond / 2, True)
    return _Settled(doubled, times, found, *rests)
