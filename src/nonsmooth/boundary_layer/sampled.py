"""The extrapolation length of any scene with odd g, by Monte Carlo.

int g + u is a martingale, u the Poisson solution: at the first passage of a far threshold the mean
of u is kappa, and what int g gains on average after the passage tends to the mean of u. Paths run
through cycles: until int g has moved by b to either side, and for a time on from there.
"""

import time

import numpy as np

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.paths import schemes
from nonsmooth.paths.ensembles import over_blocks, parallel, require_finite
from nonsmooth.paths.kernels.compilation import kernel
from nonsmooth.paths.kernels.panel import TOTAL_DELTA, new_panel
from nonsmooth.paths.kernels.random_numbers import blocks, labelled
from nonsmooth.paths.resolution import coarse_step
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.simulation import simulate
from nonsmooth.paths.time_loop import march, march_pair

_PATHS = 2000  # at first; a multiple of the block size
_LAG = 4.0  # time after a passage, in units of the larger of 1 and 1 / C_b, at first
_CYCLES = 75  # duration of a path over that time
_FAR = 2.0  # threshold over the standard deviation of what int g gains in that time
_ATTEMPTS = 3
_START = 0.05  # tolerance of `simulate`, for the mean from the start
_SHARE = 0.2  # error over kappa, unless tol is given
# paths of the halving: at least, and of how many those are one; the former also of the spread
_PILOT_PATHS, _FEWER = 1000, 4
_EVERYWHERE = -np.inf, np.inf


def sampled_length(scene, tol=None, seed=0, threads=None):
    """Estimate the extrapolation length from what int g gains after a passage.

    Parameters
    ----------
    scene : Scene
        With odd g.
    tol : float, optional
        Absolute error wanted, "1"; a fifth of kappa unless given.
    seed, threads
        Of Monte Carlo: int or tuple; all cores unless given.

    Returns
    -------
    Estimate
        The error is two standard errors and what kappa changes if the threshold is halved, the
        time after the passage is halved, or paths are looked at every other step only; and the bias
        of the time step, as measured by halving it on the same noise, with two of its own.

    Raises
    ------
    SceneError
        If g is not odd.
    ToleranceError
        If `tol` is not met; the message has the best value and its error.
    """
    began = time.perf_counter()
    if not scene.is_odd():
        raise SceneError(
            f"the extrapolation length is sampled for odd g, not for g = {scene.observable!r} with "
            f"the state ({', '.join(scene.state)}); choose such a g"
        )
    lag, paths = _LAG * max(1.0, 1 / scene.damping), _PATHS
    for attempt in range(_ATTEMPTS):
        value, error = _estimate(scene, lag, paths, labelled(seed, attempt), threads)
        if error <= (_SHARE * abs(value) if tol is None else tol):
            return Estimate(value, error, "Monte Carlo", time.perf_counter() - began)
        lag, paths = 1.5 * lag, 2 * paths
    raise ToleranceError(f"kappa = {value:.3g} has an error of {error:.1e}, above tol; loosen tol")


def sampled_poisson(scene, seed=0, threads=None):
    """Estimate the Poisson solution of g at the start, the mean of int g after a long time.

    Parameters
    ----------
    scene : Scene
        With odd g.
    seed, threads
        Of Monte Carlo: int or tuple; all cores unless given.

    Returns
    -------
    Estimate
        The error is two standard errors, what the second half of the time adds, and the bias of the
        time step with two standard errors. Exactly 0 at the origin, where drift and g are odd.
    """
    began = time.perf_counter()
    if not any(scene.start.values()):
        return Estimate(0.0, 0.0, "symmetry", 0.0)
    lag = _LAG * max(1.0, 1 / scene.damping)
    run = simulate(scene, 2 * lag, _START, times=[lag, 2 * lag], seed=seed, threads=threads)
    middle, end = run["mean"].values
    last = run.isel(time=-1)
    error = (
        2 * last["mean_error"]
        + abs(end - middle)
        + abs(last["mean_bias"])
        + 2 * last["mean_bias_error"]
    )
    return Estimate(float(end), float(error), "Monte Carlo", time.perf_counter() - began)


def _estimate(scene, lag, paths, seed, threads):
    step = coarse_step(scene) / 2
    after = 2 * round(lag / step / 2)
    far = _FAR * _spread(scene, step, after, labelled(seed, "spread"), threads)
    # threshold, looks until the end of a cycle, steps between looks
    variants = [(far, after, 1), (far / 2, after, 1), (far, after // 2, 1), (far, after // 2, 2)]
    (value, spread), *others = (
        _mean(*gains) for gains in _gains(scene, step, after, variants, paths, seed, threads)
    )
    changes = [other - value for other, _ in others]
    fewer = max(_PILOT_PATHS, paths // _FEWER)
    own = labelled(seed, "halving")
    bias, deviation = _step_bias(scene, step, after, variants[0], fewer, own, threads)
    error = 2 * spread + np.linalg.norm(changes) + abs(bias) + 2 * deviation
    return value, float(error)


def _spread(scene, step, after, seed, threads):
    """Estimate the standard deviation of what int g gains in the time of `after` steps."""

    def position(panel, count):
        return panel.total[TOTAL_DELTA, :count].copy()

    grid = [(after, step), (after, step)]
    pilot = Sampling(step, _PILOT_PATHS, seed, threads=threads, precision="float64")
    before, end = over_blocks(scene, grid, pilot, position, control=False)[0]
    return np.std(end - before)


def _gains(scene, step, after, variants, paths, seed, threads):
    """Sum by path what is gained in cycles, and count these: shape (variants, 2, paths)."""
    s = schemes.coefficients(scene, "strang", step, "float64")

    def run(job):
        block, lanes = job
        panel = new_panel(scene, seed, block, "float64")
        integral = panel.total[TOTAL_DELTA, :lanes]
        march(s, panel, lanes, after, *_EVERYWHERE)  # the approach to stationarity
        cycles = [_begun(integral) for _ in variants]
        for k in range(1, _CYCLES * after + 1):
            march(s, panel, lanes, 1, *_EVERYWHERE)
            for state, (threshold, looks, stride) in zip(cycles, variants, strict=True):
                if k % stride == 0:
                    _look(state, integral, threshold, looks)
        require_finite([integral])
        return np.array(cycles)[:, -2:]

    return np.concatenate(parallel(run, blocks(0, paths), threads), axis=2)


def _step_bias(scene, step, after, variant, paths, seed, threads):
    """Bias of the mean gain with the step, and its standard error, from half of it."""
    fine, coarse = (schemes.coefficients(scene, "strang", h, "float64") for h in (step / 2, step))
    given = schemes.on_given_increments(coarse)
    threshold, looks, _ = variant

    def run(job):
        block, lanes = job
        panels = [new_panel(scene, seed, block, "float64") for _ in range(2)]
        integrals = [panel.total[TOTAL_DELTA, :lanes] for panel in panels]
        passage = np.full((2, lanes), np.inf)

        def advance(steps):
            march_pair(fine, given, *panels, lanes, steps, *_EVERYWHERE, 0.0, passage)

        advance(after)
        cycles = [_begun(integral) for integral in integrals]
        for _ in range(_CYCLES * after):
            advance(1)
            for state, integral in zip(cycles, integrals, strict=True):
                _look(state, integral, threshold, looks)
        require_finite(integrals)
        return np.array(cycles)[:, -2:]

    half, whole = np.concatenate(parallel(run, blocks(0, paths), threads), axis=2)
    factor = 1 / (1 - 2 ** -schemes.scheme(scene, "strang").weak_order(scene))
    # the ratio of sums over independent paths, linearised
    parts = _deviations(*whole) - _deviations(*half)
    change = _mean(*whole)[0] - _mean(*half)[0]
    return factor * change, factor * float(np.sqrt(np.sum(parts**2)))


def _begun(integral):
    """State of the cycles: int g at their start, side and looks since passage, sums and counts."""
    state = np.zeros((5, len(integral)))
    state[0] = integral
    return state


@kernel
def _look(state, integral, threshold, looks):
    """Notice passages, and after some more looks the gains beyond the threshold."""
    base, side, waited, total, count = state
    for i in range(len(integral)):
        moved = integral[i] - base[i]
        if side[i] != 0:
            waited[i] += 1
        elif abs(moved) >= threshold:
            side[i] = 1.0 if moved > 0 else -1.0
        if side[i] != 0 and waited[i] >= looks:
            total[i] += side[i] * moved - threshold
            count[i] += 1
            base[i], side[i], waited[i] = integral[i], 0.0, 0.0


def _mean(total, count):
    """Mean of the gains, and its standard error."""
    return float(total.sum() / count.sum()), float(np.linalg.norm(_deviations(total, count)))


def _deviations(total, count):
    """Contribution of each path to the error of the mean."""
    return (total - count * total.sum() / count.sum()) / count.sum()
