"""The extrapolation length of any scene with odd g, by Monte Carlo.

int g + u is a martingale, u the Poisson solution: at the first passage of a far threshold the mean
of u is kappa, and what int g gains on average after the passage tends to the mean of u. Paths run
through cycles: until int g has moved by b to either side, and for a time on from there.
"""

import time

import numpy as np

from nonsmooth import schemes
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.panel import TOTAL_DELTA
from nonsmooth.streams import labelled
from nonsmooth.times import equal_steps
from nonsmooth.trajectories import coarse_step, coupled_paths, over_blocks, simulate

_PATHS = 2000  # at first; a multiple of the block size
_LAG = 4.0  # time after a passage, in units of the larger of 1 and 1 / C_b, at first
_CYCLES = 75  # duration of a path over that time
_FAR = 2.0  # threshold over the standard deviation of what int g gains in that time
_ATTEMPTS = 3
_START = 0.05  # tolerance of `simulate`, for the mean from the start
_SHARE = 0.2  # error over kappa, unless tol is given
_PILOT_PATHS, _FEWER = 1000, 4  # paths of the halving: at least, and of how many those are one


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
    grid = equal_steps(np.arange(1, _CYCLES * after + 1) * step, step)

    def position(panel, count):
        return panel.total[TOTAL_DELTA, :count].copy()

    blocks = over_blocks(scene, grid, paths, seed, position, 0, threads, "strang", "float64", False)
    integral = np.concatenate(blocks, axis=1)[after:]  # without the approach to stationarity
    far = _FAR * np.std(integral[after] - integral[0])
    value, spread = _mean(*_gain(integral, far, after))
    changes = [
        _mean(*_gain(other, threshold, later))[0] - value
        for other, threshold, later in (
            (integral, far / 2, after),
            (integral, far, after // 2),
            (integral[::2], far, after // 2),
        )
    ]
    fewer = max(_PILOT_PATHS, paths // _FEWER)
    bias, deviation = _step_bias(
        scene, step, len(grid), fewer, far, after, labelled(seed, "halving"), threads
    )
    error = 2 * spread + np.linalg.norm(changes) + abs(bias) + 2 * deviation
    return value, float(error)


def _step_bias(scene, step, steps, paths, far, after, seed, threads):
    """Bias of the mean gain with the step, and its standard error, from half of it."""
    integrals = coupled_paths(scene, step, steps, paths, seed, threads)[:, after:]
    (fine, fine_count), (coarse, count) = (_gain(paths, far, after) for paths in integrals)
    factor = 1 / (1 - 2 ** -schemes.scheme(scene, "strang").weak_order(scene))
    change = coarse.sum() / count.sum() - fine.sum() / fine_count.sum()
    # the ratio of sums over independent paths, linearised
    parts = (coarse - count * coarse.sum() / count.sum()) / count.sum()
    parts -= (fine - fine_count * fine.sum() / fine_count.sum()) / fine_count.sum()
    return factor * change, factor * float(np.sqrt(np.sum(parts**2)))


def _gain(integral, threshold, after):
    """Sum by path what is gained `after` steps after a passage of the threshold, and count them."""
    base = integral[0].copy()
    passed, side = np.full(len(base), -1), np.zeros(len(base))
    total, count = np.zeros((2, len(base)))
    for k, here in enumerate(integral):
        moved = here - base
        leaving = (passed < 0) & (np.abs(moved) >= threshold)
        passed[leaving], side[leaving] = k, np.sign(moved[leaving])
        done = (passed >= 0) & (k - passed >= after)
        total[done] += (side * moved)[done] - threshold
        count[done] += 1
        base[done], passed[done] = here[done], -1
    return total, count


def _mean(total, count):
    """Mean of the gains, and its standard error."""
    value = total.sum() / count.sum()
    return float(value), float(np.sqrt(np.sum((total - value * count) ** 2)) / count.sum())
