"""Extrapolation length of any scene with odd g, by Monte Carlo.

Let u be the Poisson solution of g, -A u = g. Then int_0^t g + u is a martingale. Let a path first
pass a far threshold. The mean of u at this moment is the extrapolation length kappa, and it is also
the mean of all that int g gains from then on. This gain is what is sampled. Paths run through
cycles: a cycle lasts until int g has moved by b to either side, and for some time after that. At
equidistant times, called looks, a path is examined for passages.
"""

import math
import time
from dataclasses import dataclass, replace
from itertools import count
from typing import NamedTuple

import numpy as np

from nonsmooth.boundary_layer import tuning
from nonsmooth.errors import SceneError, ToleranceError, quoted
from nonsmooth.estimate import Estimate
from nonsmooth.paths.ensembles import over_blocks, require_finite
from nonsmooth.paths.kernels.compilation import kernel
from nonsmooth.paths.kernels.panel import TOTAL_DELTA, new_panel
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import bias_over_change
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.resolution import coarse_step
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.simulation import simulate
from nonsmooth.paths.time_loop import (
    EVERYWHERE,
    compile_march,
    compile_march_pair,
    march,
    march_pair,
)
from nonsmooth.scenes.scene import Scene


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

    def refined(self, parts: _Parts) -> "_Run":
        """Refine what has the largest part in the error."""
        worst = max(parts)
        if worst == parts.scatter:
            return self._replace(paths=2 * self.paths)
        if worst == parts.step:
            return self._replace(step=self.step / 2)
        if worst == parts.threshold:
            return self._replace(far=2 * self.far)
        return self._replace(lag=2 * self.lag)


@dataclass(frozen=True)
class _Cycle:
    """How a path is followed.

    Attributes
    ----------
    threshold : float
        b.
    after : int
        Looks from the passage until the end of the cycle.
    stride : int
        Steps from one look to the next.
    """

    threshold: float
    after: int
    stride: int = 1


def sampled_kappa(
    scene: Scene, tol: float | None = None, seed: int | tuple = 0, threads: int | None = None
) -> Estimate:
    """Estimate kappa from what int g gains after a passage.

    Parameters
    ----------
    scene : Scene
        With odd g.
    tol : float, optional
        Absolute error wanted, "1"; a fifth of kappa unless given.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.

    Returns
    -------
    Estimate
        The error is the sum of two standard errors; of the changes of kappa if the threshold is
        halved, if the time after the passage is halved, and if paths are looked at every other step
        only; and of the bias of the time step, measured by halving it on the same noise, with two
        standard errors of that. What has the largest part in it is refined: the threshold, the time
        after the passage or the number of paths is doubled, or the step is halved.

    Raises
    ------
    SceneError
        If g is not odd.
    ToleranceError
        If `tol` is not met; the best value is its `result`.
    """
    began = time.perf_counter()
    if not scene.is_odd():
        raise SceneError(
            "the extrapolation length is sampled for odd g, not for g = "
            f"{quoted(scene.observable)} with the state ({', '.join(scene.state)}); choose such a g"
        )
    settings = tuning.SAMPLED
    lag, step = settings.lag * max(1.0, 1 / scene.damping), coarse_step(scene) / 2
    run = _Run(settings.far, lag, settings.paths, step)
    most = settings.work * run.work
    for attempt in count():
        own = labelled(seed, attempt)
        sampling = Sampling(run.step, run.paths, own, threads=threads, precision="float64")
        value, error, parts = _estimate(scene, run, sampling)
        wanted = settings.tolerance * abs(value) if tol is None else tol
        if error <= wanted:
            return Estimate(value, error, "Monte Carlo", time.perf_counter() - began)
        run, left = run.refined(parts), most / run.work
        # n times the work makes the scatter at best sqrt(n) times smaller
        if run.work > most or parts.scatter > wanted * math.sqrt(left):
            break
    raise ToleranceError(
        f"kappa = {value:.3g} has an error of {error:.1e}, above tol; loosen tol",
        Estimate(value, error, "Monte Carlo", time.perf_counter() - began),
    )


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
        and of the bias of the time step with two standard errors of that. For a start at the origin
        the value is exactly 0, because drift and g are odd.
    """
    began = time.perf_counter()
    if not any(scene.start.values()):
        return Estimate(0.0, 0.0, "symmetry", 0.0)
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


def _estimate(scene, run, sampling):
    """Return kappa, its error, and the parts of that."""
    after = 2 * round(run.lag / sampling.step / 2)
    far = run.far * _spread(scene, after, sampling.labelled("spread"))
    cycles = [
        _Cycle(far, after),
        _Cycle(far / 2, after),
        _Cycle(far, after // 2),
        _Cycle(far, after // 2, stride=2),
    ]
    steps = run.cycles * after
    gains = _gains(scene, after, steps, cycles, sampling)
    (value, spread), *others = (_mean(*of_cycle) for of_cycle in gains)
    changes = np.abs([other - value for other, _ in others])
    fewer = max(tuning.SAMPLED.pilot_paths, sampling.paths // tuning.SAMPLED.halved)
    halving = replace(sampling.labelled("halving"), paths=fewer)
    bias, deviation = _step_bias(scene, after, steps, cycles[0], halving)
    error = 2 * spread + abs(bias) + 2 * deviation + np.linalg.norm(changes)
    return value, float(error), _Parts(2 * spread + 2 * deviation, abs(bias), *changes[:2])


def _spread(scene, after, sampling):
    """Estimate the standard deviation of what int g gains in the time of `after` steps."""

    def position(panel, count):
        return panel.total[TOTAL_DELTA, :count].copy()

    grid = [(after, sampling.step), (after, sampling.step)]
    pilot = replace(sampling, paths=tuning.SAMPLED.pilot_paths)
    (before, end), *_ = over_blocks(scene, grid, pilot, position, control=False)
    return np.std(end - before)


def _gains(scene, after, steps, cycles, sampling):
    """For each path, sum the gains of its cycles and count the cycles: shape (cycles, 2, paths)."""
    s = registry.coefficients(scene, sampling.scheme, sampling.step, sampling.precision)
    compile_march(s, new_panel(scene, sampling.seed, 0, sampling.precision))

    def run(job):
        block, lanes = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        integral = panel.total[TOTAL_DELTA, :lanes]
        march(s, panel, lanes, after, *EVERYWHERE)  # the approach to stationarity
        states = [_begun(integral) for _ in cycles]
        for k in range(1, steps + 1):
            march(s, panel, lanes, 1, *EVERYWHERE)
            for state, cycle in zip(states, cycles, strict=True):
                if k % cycle.stride == 0:
                    _look(state, integral, cycle.threshold, cycle.after)
        require_finite(integral)
        return np.array(states)[:, -2:]

    return np.concatenate(list(parallel(run, sampling, after + steps)), axis=2)


def _step_bias(scene, after, steps, cycle, sampling):
    """Measure the bias of the mean gain by halving the time step; return it and its error."""
    fine, coarse = (
        registry.coefficients(scene, sampling.scheme, h, sampling.precision)
        for h in (sampling.step / 2, sampling.step)
    )
    given = registry.on_given_increments(coarse)
    compile_march_pair(fine, given, new_panel(scene, sampling.seed, 0, sampling.precision))

    def run(job):
        block, lanes = job
        panels = [new_panel(scene, sampling.seed, block, sampling.precision) for _ in range(2)]
        integrals = [panel.total[TOTAL_DELTA, :lanes] for panel in panels]
        passage = np.full((2, lanes), np.inf)

        def advance(by):
            march_pair(fine, given, *panels, lanes, by, *EVERYWHERE, 0.0, passage)

        advance(after)
        states = [_begun(integral) for integral in integrals]
        for _ in range(steps):
            advance(1)
            for state, integral in zip(states, integrals, strict=True):
                _look(state, integral, cycle.threshold, cycle.after)
        for integral in integrals:
            require_finite(integral)
        return np.array(states)[:, -2:]

    runs = parallel(run, sampling, 3 * (after + steps))
    half, whole = np.concatenate(list(runs), axis=2)
    factor = bias_over_change(registry.scheme(scene, sampling.scheme).weak_order(scene))
    # The mean is a ratio of sums over independent paths; its error is that of the linearised ratio.
    parts = _deviations(*whole) - _deviations(*half)
    change = _mean(*whole)[0] - _mean(*half)[0]
    return factor * change, factor * float(np.sqrt(np.sum(parts**2)))


def _begun(integral):
    """State of the cycles: int g at their start, side and looks since passage, sums and counts."""
    state = np.zeros((5, len(integral)))
    state[0] = integral
    return state


@kernel
def _look(state, integral, threshold, after):
    """Notice passages and, `after` looks later, add what int g has gained beyond the threshold."""
    base, side, waited, total, count = state
    for i in range(len(integral)):
        moved = integral[i] - base[i]
        if side[i] != 0:
            waited[i] += 1
        elif abs(moved) >= threshold:
            side[i] = 1.0 if moved > 0 else -1.0
        if side[i] != 0 and waited[i] >= after:
            total[i] += side[i] * moved - threshold
            count[i] += 1
            base[i], side[i], waited[i] = integral[i], 0.0, 0.0


def _mean(total, count):
    """Mean of the gains, and its standard error."""
    return float(total.sum() / count.sum()), float(np.linalg.norm(_deviations(total, count)))


def _deviations(total, count):
    """Contribution of each path to the error of the mean."""
    return (total - count * total.sum() / count.sum()) / count.sum()
