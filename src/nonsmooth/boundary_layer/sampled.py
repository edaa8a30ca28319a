"""Extrapolation length of any scene with odd g, by Monte Carlo.

Let u be the Poisson solution of g, -A u = g. Then int_0^t g + u is a martingale. Let a path first
pass a far threshold. The mean of u at this moment is the extrapolation length kappa, and it is also
the mean of all that int g gains from then on. Where u can be solved for on grids, it is averaged
over the states in which paths pass; elsewhere the gain is.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import count
from typing import NamedTuple

import numpy as np

from nonsmooth.boundary_layer import poisson, tuning
from nonsmooth.boundary_layer.cycles import Cycle, Ends, followed, followed_twice
from nonsmooth.errors import SceneError, ToleranceError, quoted
from nonsmooth.estimate import Estimate
from nonsmooth.paths.ensembles import over_blocks
from nonsmooth.paths.kernels.panel import TOTAL_DELTA
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import bias_over_change
from nonsmooth.paths.resolution import coarse_step
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.simulation import simulate
from nonsmooth.scenes.scene import Scene

Poisson = Callable[[poisson.Points], np.ndarray]


class _Parts(NamedTuple):
    """The error by sampling, the step, the threshold, and the time after a passage."""

    scatter: float
    step: float
    threshold: float
    after: float


class _Run(NamedTuple):
    """How kappa is sampled.

    Attributes
    ----------
    far : float
        The threshold over the spread of int g.
    lag : float
        The time after a passage.
    paths : int
    step : float
    """

    far: float
    lag: float
    paths: int
    step: float

    @property
    def cycles(self) -> int:
        """How long a path is, in lags; larger thresholds are passed less often."""
        return round(tuning.SAMPLED.cycles * self.far / tuning.SAMPLED.far)

    @property
    def work(self) -> float:
        """Steps of all paths together."""
        return self.cycles * self.lag * self.paths / self.step

    def refined(self, parts: _Parts, wanted: float) -> "_Run":
        """Refine what has the largest part in the error, of which so much is wanted."""
        worst = max(parts)
        if worst == parts.scatter:
            needed = (worst / (tuning.SAMPLED.scatter * wanted)) ** 2
            return self._replace(paths=int(self.paths * min(max(needed, 2.0), tuning.SAMPLED.more)))
        if worst == parts.step:
            return self._replace(step=self.step / 2)
        if worst == parts.threshold:
            return self._replace(far=tuning.SAMPLED.farther * self.far)
        return self._replace(lag=2 * self.lag)


@dataclass(frozen=True)
class _Found:
    """kappa as it is sampled, with u on a coarse grid if that is known.

    Attributes
    ----------
    value, error : float
    parts : _Parts
        Of the error.
    ends : Ends
        Of the cycles of which `value` is the mean.
    """

    value: float
    error: float
    parts: _Parts
    ends: Ends


def sampled_kappa(
    scene: Scene, tol: float | None = None, seed: int | tuple = 0, threads: int | None = None
) -> Estimate:
    """Estimate kappa from the states in which paths pass, or from what int g gains after that.

    Parameters
    ----------
    scene : Scene
        With odd g.
    tol : float, optional
        Absolute error wanted, "1"; unless given, a tenth of kappa, or a fifth if the Poisson
        equation cannot be solved on grids.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.

    Returns
    -------
    Estimate
        The error is the sum of two standard errors; of what halving the threshold twice says of the
        rest of its effect; of the changes of kappa if paths are looked at every other step only,
        and, where the gain is sampled, if the time after the passage is halved; of the bias of the
        time step, measured by halving it on the same noise, with two standard errors of that; and
        of that of the Poisson solution. What has the largest part in it is refined: the threshold
        or the time after the passage is made longer, the step is halved, or there are more paths.

    Raises
    ------
    SceneError
        If g is not odd.
    ToleranceError
        If `tol` is not met; the best value is its `result`.
    """
    if not scene.is_odd():
        raise SceneError(
            "the extrapolation length is sampled for odd g, not for g = "
            f"{quoted(scene.observable)} with the state ({', '.join(scene.state)}); choose such a g"
        )
    u = poisson.on_coarse_grid(scene) if scene.dimension > 1 else None
    if u is not None:
        try:
            return _kappa(scene, u, tol, seed, threads)
        except ToleranceError as refused:
            if refused.result is not None:
                raise
    return _kappa(scene, None, tol, seed, threads)


def _kappa(scene, u, tol, seed, threads):
    """Sample kappa to a tolerance, with u on a coarse grid if that is known, then on finer ones."""
    began, settings = time.perf_counter(), tuning.SAMPLED
    relative = settings.tolerance if u is None else settings.tolerance_on_grids

    def wanted(value):
        return relative * abs(value) if tol is None else tol

    share = 1.0 if u is None else settings.share
    found = _refined(scene, u, lambda value: share * wanted(value), seed, threads)
    value, error = found.value, found.error
    if u is not None:
        coarse = u(found.ends.state)
        unit = float(np.std(coarse))
        most = (1 - share) * wanted(value) / unit
        rest, inexact = poisson.mean_at(scene, found.ends.state, most, unit, coarse)
        if not math.isfinite(inexact):
            raise ToleranceError("the Poisson solution is not known in the limit")
        value, error = value + rest, error + inexact
    estimate = Estimate(value, error, "Monte Carlo", time.perf_counter() - began)
    if not error <= wanted(value):
        raise ToleranceError(
            f"kappa = {value:.3g} has an error of {error:.1e}, above tol; loosen tol", estimate
        )
    return estimate


def _refined(scene, u, wanted, seed, threads):
    """Refine a run until its error is as wanted, or there is no hope of that."""
    settings = tuning.SAMPLED
    lag, step = settings.lag * max(1.0, 1 / scene.damping), coarse_step(scene) / 2
    run = _Run(settings.far, lag, settings.paths, step)
    most, best = settings.work * run.work, None
    for attempt in count():
        own = labelled(seed, attempt)
        sampling = Sampling(run.step, run.paths, own, threads=threads)
        found = _estimate(scene, u, run, sampling)
        if best is None or not found.error >= best.error:
            best = found
        most_error = wanted(found.value)
        if found.error <= most_error:
            return best
        run, left = run.refined(found.parts, most_error), most / run.work
        # n times the work makes the scatter at best sqrt(n) times smaller
        if run.work > most or found.parts.scatter > most_error * math.sqrt(left):
            return best


def sampled_poisson(scene: Scene, seed: int | tuple = 0, threads: int | None = None) -> Estimate:
    """Estimate the Poisson solution of g at the start, the mean of int g after a long time.

    Parameters
    ----------
    scene : Scene
        With odd g.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.

    Returns
    -------
    Estimate
        The error is the sum of two standard errors, of the change in the second half of the time,
        and of the bias of the time step with two standard errors of that.
    """
    began = time.perf_counter()
    lag = tuning.SAMPLED.lag * max(1.0, 1 / scene.damping)
    times = [lag, 2 * lag]
    run = simulate(scene, times[-1], tuning.SAMPLED.start, times=times, seed=seed, threads=threads)
    middle, end = run["mean"].values
    last = run.isel(time=-1)
    error = (
        2 * last["mean_error"]
        + abs(end - middle)
        + abs(last["mean_bias"])
        + 2 * last["mean_bias_error"]
    )
    return Estimate(float(end), float(error), "Monte Carlo", time.perf_counter() - began)


def _estimate(scene, u, run, sampling):
    """Sample kappa once."""
    after = 2 * round(run.lag / sampling.step / 2)
    steps = run.cycles * after
    far = run.far * _spread(scene, after, sampling.labelled("spread"))
    waited = after if u is None else 0
    own = Cycle(far, waited)
    # nearer thresholds are passed more often
    half, quarter = (Cycle(far / k, waited, until=steps / k**2) for k in (2, 4))
    others = [half, quarter, Cycle(far, waited // 2, stride=2)]
    if u is None:
        others.append(Cycle(far, after // 2))
    ends, *of_others = followed(scene, after, steps, [own, *others], sampling)
    sums = _by_path(u, ends)
    value, spread = _mean(*sums)
    found = [_change(_by_path(u, one), sums) for one in of_others]
    (near, noise), (nearer, _), *rest = found
    # the ratio of two chances tells nothing
    further = _further(near, nearer - near) if abs(near) > 2 * noise else 1.0
    changes = np.abs([(further * near, further * noise), *rest])
    fewer = max(tuning.SAMPLED.pilot_paths, sampling.paths // tuning.SAMPLED.halved)
    halving = replace(sampling.labelled("halving"), paths=fewer)
    bias, deviation = _step_bias(scene, u, after, steps, own, halving)
    error = 2 * spread + abs(bias) + 2 * deviation + np.linalg.norm(changes[:, 0])
    # what may be chance is no reason to refine anything but the paths
    threshold, looks, *lag = np.maximum(changes[:, 0] - 2 * changes[:, 1], 0.0)
    parts = _Parts(2 * spread + 2 * deviation, abs(bias) + looks, threshold, *(lag or [0.0]))
    return _Found(value, float(error), parts, ends)


def _further(last, before):
    """Return what a threshold may be wrong by, over what halving it changes.

    What is left of a path's start falls like exp(-mu b). With q = exp(-mu b/4), halving b and b/2
    changes q^2 (1 - q^2) and q (1 - q), and q^4 is left. That is q^2 / (1 - q^2) of the first
    change; q / (1 - q) is returned, and not less than the least.
    """
    least, largest = tuning.SAMPLED.least, tuning.SAMPLED.largest
    ratio = abs(last) / max(abs(before), np.finfo(float).tiny)
    q = min((math.sqrt(1 + 4 * ratio) - 1) / 2, largest / (1 + largest))
    return max(q / (1 - q), least)


def _spread(scene, after, sampling):
    """Estimate the standard deviation of what int g gains in the time of `after` steps."""

    def position(panel, count):
        return panel.total[TOTAL_DELTA, :count].copy()

    grid = [(after, sampling.step), (after, sampling.step)]
    pilot = replace(sampling, paths=tuning.SAMPLED.pilot_paths)
    (before, end), *_ = over_blocks(scene, grid, pilot, position, control=False)
    return np.std(end - before)


def _step_bias(scene, u, after, steps, cycle, sampling):
    """Measure the bias of the mean by halving the time step; return it and its error."""
    half, whole = (
        _by_path(u, ends) for ends in followed_twice(scene, after, steps, cycle, sampling)
    )
    factor = bias_over_change(registry.scheme(scene, sampling.scheme).weak_order(scene))
    return tuple(factor * found for found in _change(whole, half))


def _by_path(u, ends):
    """For each path, sum up the gain and u at the ends of its cycles, and count these."""
    values = ends.gain if u is None else ends.gain + u(ends.state)
    return tuple(np.bincount(ends.path, weights, ends.paths) for weights in (values, None))


def _mean(total, count):
    """Mean over the ends, and its standard error."""
    return float(total.sum() / count.sum()), float(np.linalg.norm(_deviations(total, count)))


def _change(sums, others):
    """Difference of two means over the ends on the same paths, and its standard error."""
    parts = _deviations(*sums) - _deviations(*others)
    return _mean(*sums)[0] - _mean(*others)[0], float(np.linalg.norm(parts))


def _deviations(total, count):
    """Contribution of each path to the error of the mean, that of the linearised ratio of sums."""
    return (total - count * total.sum() / count.sum()) / count.sum()
