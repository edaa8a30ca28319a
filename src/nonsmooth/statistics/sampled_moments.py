"""Mean and variance of int_0^tau g by Monte Carlo, for every scene."""

import math

import numpy as np

from nonsmooth.checks import require_increasing
from nonsmooth.errors import ToleranceError
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.resolution import first_step, paths_for, refined_step, require_possible
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.simulation import simulate
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning
from nonsmooth.statistics.mean import exact_mean
from nonsmooth.statistics.sampled_gamma2 import sampled_mean


def sampled_moments(
    scene: Scene,
    times: np.ndarray,
    tol: float | None,
    seed: int | tuple = 0,
    threads: int | None = None,
    most: float = MONTE_CARLO.most_steps,
    envelope: str | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Sample w and v of `statistics.variance`.

    Each attempt chooses the number of paths and the step of the next, until the tolerance is met.

    Parameters
    ----------
    scene : Scene
    times : numpy.ndarray, shape (t,)
        Increasing and positive.
    tol : float or None
        Of v(tau)/tau, absolute; if None, a share of the largest of them, `tuning.Variance.share`.
    seed : int or tuple
    threads : int, optional
    most : float
        Largest number of steps of all paths together. If more are needed, this raises an error
        instead of trying.
    envelope : str, optional
        As for `statistics.variance`.

    Returns
    -------
    values, errors : numpy.ndarray, shape (2, t)
        Of w and of v; the errors are the bias of the step and the standard error together.

    Raises
    ------
    SceneError
        If the times do not increase from above 0.
    ToleranceError
        If `tol` cannot be met; the best values and errors are its `result`.
    """
    times = require_increasing("times", times)
    paths, step, excessive = MONTE_CARLO.pilot_paths, first_step(scene, times), None
    order = registry.scheme(scene).weak_order(scene)
    for attempt in range(MONTE_CARLO.attempts):
        run = simulate(
            scene,
            times[-1],
            step=step,
            paths=paths,
            seed=labelled(seed, attempt),
            times=times,
            threads=threads,
            envelope=envelope,
        )
        own, bias, spread = (
            np.abs(run[f"variance_{part}"].values) / times
            for part in ("error", "bias", "bias_error")
        )
        error = np.max(bias + MONTE_CARLO.sigmas * np.hypot(own, spread))
        size = max(float(run["variance"][-1]) / times[-1], np.finfo(float).tiny)
        largest = max(float(np.max(run["variance"].values / times)), np.finfo(float).tiny)
        allowed = tuning.VARIANCE.share * largest if tol is None else tol
        rare = own[-1] / size / tuning.VARIANCE.resting
        if error <= allowed and rare <= 1:
            break
        deviation = math.sqrt(paths) * np.max(own)
        paths = max(
            paths,
            paths_for(deviation, allowed),
            math.ceil(paths * min(rare, tuning.VARIANCE.more) ** 2),
        )
        step = refined_step(step, np.max(bias + spread), MONTE_CARLO.bias_aim * allowed, order)
        try:
            require_possible(
                paths,
                times[-1] / step,
                f"v(tau)/tau = {float(run['variance'][-1]) / times[-1]:.3g} at tau = "
                f"{times[-1]:g} has an error of {error:.1g}",
                allowed,
                most,
            )
        except ToleranceError as refused:
            excessive = str(refused)
            break
    if rare > 1:  # the error of a variance that rests on a few paths is not known
        raise ToleranceError(
            f"v(tau)/tau = {size:.3g} at tau = {times[-1]:g} rests on the few of "
            f"{run.attrs['paths']} paths that have moved; choose a longer time"
        )
    mean, uncertain = _stationary_mean(scene, labelled(seed, "stationary"), threads, envelope)
    w = run["mean"].values - mean * times
    w_error = np.abs(run["mean_bias"]) + np.hypot(run["mean_error"], run["mean_bias_error"])
    v, v_error = run["variance"].values, times * (bias + np.hypot(own, spread))
    found = np.array([w, v]), np.array([np.asarray(w_error) + uncertain * times, v_error])
    if excessive:
        raise ToleranceError(excessive, found)
    bound = times * (bias + MONTE_CARLO.sigmas * np.hypot(own, spread))
    require_accuracy(times, *found, bound, allowed)
    return found


def _stationary_mean(scene, seed, threads, envelope):
    """Return E g and its error; 0 under an envelope, where there is none."""
    if envelope is not None:
        return 0.0, 0.0
    if (exact := exact_mean(scene)) is not None:
        return exact.value, exact.error
    return sampled_mean(scene, seed=seed, threads=threads)


def require_accuracy(
    times: np.ndarray, values: np.ndarray, errors: np.ndarray, bound: np.ndarray, tol: float
) -> None:
    """Refuse a v(tau) of which the bound of the error, divided by tau, is above the tolerance.

    Parameters
    ----------
    times : numpy.ndarray, shape (t,)
    values, errors : numpy.ndarray, shape (2, t)
        Of w and of v.
    bound : numpy.ndarray, shape (t,)
        Of the error of v.
    tol : float

    Raises
    ------
    ToleranceError
        With the values and errors as its `result`.
    """
    rate, rate_error = (part / np.where(times > 0, times, 1.0) for part in (values[1], bound))
    worst = int(np.argmax(rate_error))
    if not rate_error[worst] <= tol:
        raise ToleranceError(
            f"v(tau)/tau = {rate[worst]:.10g} at tau = {times[worst]:g} has an error of "
            f"{rate_error[worst]:.1e}, above tol = {tol:g}; loosen tol",
            (values, errors),
        )
