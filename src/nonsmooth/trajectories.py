"""Paths and the moments of their integrals: `simulate`."""

import math
import os
from concurrent.futures import ThreadPoolExecutor
from numbers import Integral

import numpy as np
import xarray as xr

from nonsmooth import schemes
from nonsmooth.control import poisson_slope
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.march import march, march_pair
from nonsmooth.models import STATE_VARIABLES
from nonsmooth.panel import STATE, TOTAL_DELTA, new_panel
from nonsmooth.streams import blocks, labelled
from nonsmooth.times import equal_steps

MOST_STEPS = 1e13  # of all paths together: hours
_EVERYWHERE = (-np.inf, np.inf)  # levels that no path reaches


def parallel(work, jobs, threads=None):
    """Map `work` over `jobs` on `threads` threads (default: all cores); results in order."""
    require_count("threads", threads or os.cpu_count())
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        return list(pool.map(work, jobs))


def gram(
    scene,
    times,
    step,
    paths,
    seed,
    first_path=0,
    threads=None,
    scheme="strang",
    precision="float32",
    control=True,
    parts=1,
):
    """Simulate a part of an ensemble and add up what its moments are made of.

    Parameters
    ----------
    scene : Scene
    times : array_like, shape (t,)
        Increasing output times, "1".
    step : float
        Longest time step, "1".
    paths : int
        Number of paths.
    seed : int or tuple
    first_path : int
        Number of the first path of this part, a multiple of the block size.
    threads : int, optional
    scheme, precision : str
    control : bool
        Whether to run the control variate, where there is one.
    parts : int
        Into how many each step is divided.

    Returns
    -------
    numpy.ndarray, shape (t, 5, 5)
        Sums over the paths of the products of (1, D, D^2, M, M^2 - <M>), D = int_0^t g and M
        its martingale part.

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    """

    def products(panel, count):
        delta, martingale, variation = panel.total[:, :count]
        vector = np.ones((5, count))
        with np.errstate(over="ignore", invalid="ignore"):  # refused afterwards
            vector[1:] = delta, delta**2, martingale, martingale**2 - variation
            return vector @ vector.T

    grid = [(parts * steps, h / parts) for steps, h in equal_steps(times, step)]
    return sum(
        over_blocks(
            scene, grid, paths, seed, products, first_path, threads, scheme, precision, control
        )
    )


def over_blocks(scene, grid, paths, seed, reduce, first_path, threads, scheme, precision, control):
    """March every block of paths over a grid of `equal_steps`.

    Parameters
    ----------
    grid : list of (int, float)
    reduce : callable
        Takes a block's panel at an output time and the number of its paths, returns an array to
        be kept.
    scene, paths, seed, first_path, threads, scheme, precision, control
        As for `gram`.

    Returns
    -------
    list of numpy.ndarray
        One per block, with the output time in front.
    """
    slope = poisson_slope(scene) if control else None
    coefficients = {
        h: schemes.coefficients(scene, scheme, h, precision, slope) for h in {h for _, h in grid}
    }

    def run(job):
        block, count = job
        panel = new_panel(scene, seed, block, precision)
        kept = []
        for steps, h in grid:
            march(coefficients[h], panel, count, steps, *_EVERYWHERE)
            kept.append(reduce(panel, count))
        return np.array(kept)

    results = parallel(run, blocks(first_path, paths), threads)
    require_finite(results)
    return results


def paths_at(scene, times, step, paths, seed, scheme="strang", threads=None):
    """Simulate paths in double precision and keep them at the output times.

    Returns
    -------
    numpy.ndarray, shape (t + 1, k + 1, paths)
        The scene's k state variables and D, time 0 included.
    """
    rows = [row for row, s in zip(STATE, STATE_VARIABLES, strict=True) if s.name in scene.state]

    def state(panel, count):
        return np.vstack([panel.data[rows, :count], panel.total[TOTAL_DELTA, :count]])

    grid = equal_steps(times, step)
    kept = over_blocks(scene, grid, paths, seed, state, 0, threads, scheme, "float64", False)
    start = state(new_panel(scene, seed, 0, "float64"), 1)
    return np.concatenate(
        [np.broadcast_to(start, (1, len(start), paths)), np.concatenate(kept, axis=2)]
    )


def coupled(
    scene,
    times,
    step,
    paths,
    seed,
    threads=None,
    levels=_EVERYWHERE,
    scheme="strang",
    precision="float32",
):
    """Simulate paths with a step and with half of it on the same noise.

    Parameters
    ----------
    scene, times, paths, seed, threads, scheme, precision
        As for `gram`.
    step : float
        The longer of the two steps, "1".
    levels : (float, float)
        Lower and upper level whose first passage by D is timed.

    Returns
    -------
    change : numpy.ndarray, shape (t, 4, 4)
        Sums over the paths of the products of (1, D_h - D_h/2, D_h^2 - D_h/2^2, D_h/2).
    passage : numpy.ndarray, shape (2, paths)
        First-passage times with step h/2 and h, inf if there is none.
    """
    grid = equal_steps(times, step)
    pairs = [
        tuple(schemes.coefficients(scene, scheme, length, precision) for length in (h / 2, h))
        for _, h in grid
    ]

    def run(job):
        block, count = job
        panel, other = (new_panel(scene, seed, block, precision) for _ in range(2))
        passage = np.full((2, count), np.inf)
        products = np.empty((len(grid), 4, 4))
        vector = np.ones((4, count))
        began = 0.0
        for k, ((steps, h), (fine, coarse)) in enumerate(zip(grid, pairs, strict=True)):
            given = schemes.on_given_increments(coarse)
            march_pair(fine, given, panel, other, count, steps, *levels, began, passage)
            began += steps * h
            half, whole = panel.total[TOTAL_DELTA, :count], other.total[TOTAL_DELTA, :count]
            vector[1:] = whole - half, whole**2 - half**2, half
            products[k] = vector @ vector.T
        return products, passage

    results = parallel(run, blocks(0, paths), threads)
    require_finite([change for change, _ in results])
    return sum(change for change, _ in results), np.hstack([passage for _, passage in results])


def moments(gram):
    """Mean and variance of D, their standard errors, by regression on the control variates.

    Parameters
    ----------
    gram : array_like, shape (t, 5, 5)
        From `gram`, of all parts of the ensemble together.

    Returns
    -------
    dict
        Arrays over time: `mean`, `mean_error`, `variance`, `variance_error` (standard errors).
        Where no path has moved yet, as if one had: as far as those that have, when the first do.

    Raises
    ------
    SceneError
        If the spread is lost in the mean, or no path has moved by the last time.
    """
    gram = np.asarray(gram)
    paths = gram[:, 0, 0]
    moved = gram[:, 2, 2] > 0
    if not moved[-1]:
        raise SceneError(
            "int g is 0 on all paths at all times, so that nothing is known of its spread; choose "
            "a longer time or another observable"
        )
    average = gram[:, 0] / paths[:, None]
    covariance = gram / paths[:, None, None] - average[:, :, None] * average[:, None, :]
    result = {name: np.empty(len(gram)) for name in _MOMENTS}
    for k, (a, c, count) in enumerate(zip(average, covariance, paths, strict=True)):
        if count < 2 or np.any(np.diag(c)[1:3] < _RESOLVED * gram[k].diagonal()[1:3] / count):
            raise SceneError(
                "the spread of int g is lost in its mean, or there is one path only; "
                "subtract the mean from g or take more paths"
            )
        plain = c[1, 1] * count / (count - 1)
        # to first order the sample variance is the mean of D^2 - 2 E[D] D
        for name, value, weights in (
            ("mean", a[1], np.array([0, 1, 0, 0, 0])),
            ("variance", plain, np.array([0, -2 * a[1], 1, 0, 0])),
        ):
            slope = np.linalg.pinv(c[3:, 3:], hermitian=True) @ (c[3:] @ weights)
            weights = weights - np.concatenate([np.zeros(3), slope])
            result[name][k] = value - slope @ a[3:]
            result[f"{name}_error"][k] = np.sqrt(max(weights @ c @ weights, 0.0) / count)
    first = int(np.argmax(moved))
    square = gram[first, 2, 2] / gram[first, 1, 1]  # of those that have moved
    result["mean_error"][:first] = np.sqrt(square) / paths[:first]
    result["variance_error"][:first] = square / paths[:first]
    return result


_RESOLVED = 1e-10  # a variance below this part of the mean square has no digits left
_MOMENTS = ("mean", "mean_error", "variance", "variance_error")


def step_bias(change, order):
    """Bias of the variance of D by the step, from `coupled`, and its standard error.

    Parameters
    ----------
    change : numpy.ndarray, shape (t, 4, 4)
    order : float
        Weak order q of the scheme: the bias is the change by halving over 1 - 2^-q.

    Returns
    -------
    bias, error : numpy.ndarray, shape (t,)
    """
    count = change[:, :1, 0]
    average = change[:, 0] / count
    covariance = change / count[..., None] - average[:, :, None] * average[:, None, :]
    shift, square, mean = average[:, 1:].T
    # Var D_h - Var D_h/2, and its derivatives by the averages
    value = square - shift * (2 * mean + shift)
    weights = np.stack([0 * mean, -2 * (mean + shift), 0 * mean + 1, -2 * shift], axis=1)
    factor = 1 / (1 - 2**-order)
    variance = np.einsum("ti,tij,tj->t", weights, covariance, weights)
    return factor * value, factor * np.sqrt(np.maximum(variance, 0.0) / count[:, 0])


def mean_bias(change, order):
    """Bias of the mean of D by the step, and its standard error; see `step_bias`."""
    count = change[:, 0, 0]
    shift = change[:, 0, 1] / count
    spread = np.sqrt(np.maximum(change[:, 1, 1] / count - shift**2, 0.0) / count)
    factor = 1 / (1 - 2**-order)
    return factor * shift, factor * spread


def variance_of_fine(change):
    """Variance of D with the half step, from `coupled`, shape (t,)."""
    count = change[:, 0, 0]
    return change[:, 3, 3] / count - (change[:, 0, 3] / count) ** 2


def simulate(
    scene,
    horizon,
    tol=1e-2,
    step=None,
    paths=None,
    seed=0,
    times=None,
    keep="moments",
    scheme="strang",
    precision="float32",
    threads=None,
):
    """Simulate a scene.

    Parameters
    ----------
    scene : Scene
    horizon : float
        Final time, "1".
    tol : float
        Relative error wanted of the variance of D = int_0^horizon g: it decides, unless given,
        on the number of paths (three standard errors are three quarters of it) and on the
        longest step (its bias is a quarter of it).
    step : float, optional
        Longest time step, "1".
    paths : int, optional
        Number of paths.
    seed : int or tuple
        The same seed gives the same bits whatever the number of threads.
    times : array_like, shape (t,), optional
        Increasing output times in (0, horizon]; 200 equidistant ones unless given.
    keep : {"moments", "paths"}
        Whether to return statistics, in O(1) memory, or the paths at the output times.
    scheme : str
        A name in `schemes.SCHEMES`.
    precision : {"float32", "float64"}
        Arithmetic of the moments' steps; their sums, and kept paths, are in double precision.
    threads : int, optional
        All cores unless given.

    Returns
    -------
    xarray.Dataset
        ``"moments"``, over time: `mean` and `variance` of int_0^t g with their standard errors
        `mean_error`, `variance_error`, and `mean_bias` and `variance_bias`, the biases of the time
        step as measured by halving it, with `mean_bias_error`, `variance_bias_error`.
        ``"paths"``: the variables of the scene's state and `delta`, each (path, time), time 0
        included. Attributes `step`, `paths`.

    Raises
    ------
    SceneError
        If a parameter is out of range, or a path diverges.
    ToleranceError
        If the step is so long that halving it does not measure its bias, or `tol` would take
        more than hours; the message has one that does not.
    """
    if keep not in ("moments", "paths"):
        raise SceneError(f"cannot keep {keep!r}; choose 'moments' or 'paths'")
    if precision not in ("float32", "float64"):
        raise SceneError(f"unknown precision {precision!r}; choose 'float32' or 'float64'")
    times = _output_times(horizon, times)
    require_positive("tol", tol)
    schemes.scheme(scene, scheme)  # refuses what it cannot simulate
    chosen = paths is None
    paths = math.ceil(32 / tol**2) if chosen else paths
    require_count("paths", paths)
    if step is None:
        step = _choose_step(scene, times[-1:], tol / 4, seed, threads, scheme)
    require_positive("step", step)
    if chosen:
        require_possible(paths, times[-1] / step, "the variance of int g is sampled", tol)
    attributes = {"step": step, "paths": paths}
    if keep == "paths":
        kept = paths_at(scene, times, step, paths, seed, scheme, threads)
        return xr.Dataset(
            {
                name: (("path", "time"), kept[:, i].T)
                for i, name in enumerate([*scene.state, "delta"])
            },
            coords={"time": np.concatenate([[0.0], times])},
            attrs=attributes,
        )
    found = moments(gram(scene, times, step, paths, seed, 0, threads, scheme, precision=precision))
    fewer = min(paths, max(PILOT_PATHS, paths // 8))
    for name, bias in _bias(
        scene, times, step, fewer, labelled(seed, "halving"), threads, scheme
    ).items():
        found[f"{name}_bias"], found[f"{name}_bias_error"] = bias
    require_resolved(
        step, *(found[name][-1] for name in ("variance", "variance_bias", "variance_bias_error"))
    )
    return xr.Dataset(
        {name: ("time", values) for name, values in found.items()},
        coords={"time": times},
        attrs=attributes,
    )


_LONGEST_STEP = 0.1  # times the smaller of 1 and 1/C_b
PILOT_PATHS = 4096
# A tolerance is met if these many standard errors and the bias of the step are within it: one
# result in 400 misses it.
SIGMAS = 3.0
SPREAD_SHARE = 0.75  # of the tolerance, for the standard errors; least work at the weak order 3/2


def coarse_step(scene, scheme="strang"):
    """Step from which the search for one with a given bias starts."""
    longest = schemes.scheme(scene, scheme).longest_step(scene)
    return min(_LONGEST_STEP * min(1.0, 1 / scene.damping), longest / 4)


def paths_for(deviation, tol):
    """Count the paths on whose average, of a given standard deviation, `tol` can be promised."""
    return math.ceil((SIGMAS * deviation / (SPREAD_SHARE * tol)) ** 2)


def require_possible(paths, steps, what, tol, most=MOST_STEPS):
    """Refuse a tolerance that would take more steps of all paths together than can be waited for.

    Raises
    ------
    ToleranceError
        The message begins with `what`, such as the best value and its error.
    """
    if paths * steps > most:
        reachable = tol * math.sqrt(paths * steps / most)
        raise ToleranceError(
            f"{what}; tol = {tol:g} would take Monte Carlo {paths:.1e} paths of {steps:.1e} steps; "
            f"use tol >= {reachable:.1g}"
        )


def refined_step(step, bias, allowed, order):
    """Step at which a bias known at a coarser one is as small as allowed, by the weak order."""
    return float(step * min(1.0, (allowed / bias) ** (1 / order)))


def _bias(scene, times, step, paths, seed, threads, scheme):
    """Bias of the mean and of the variance of D by the step, each with its standard error."""
    chosen = schemes.scheme(scene, scheme)
    order = chosen.weak_order(scene)
    if chosen.coupled:
        change, _ = coupled(scene, times, step, paths, seed, threads, scheme=scheme)
        return {"mean": mean_bias(change, order), "variance": step_bias(change, order)}
    # independent runs on a grid and on its halves
    coarse, fine = (
        moments(gram(scene, times, step, 4 * paths, labelled(seed, k), 0, threads, scheme, parts=k))
        for k in (1, 2)
    )
    factor = 1 / (1 - 2**-order)
    return {
        name: (
            factor * (coarse[name] - fine[name]),
            factor * np.hypot(coarse[f"{name}_error"], fine[f"{name}_error"]),
        )
        for name in ("mean", "variance")
    }


def _choose_step(scene, times, tol, seed, threads, scheme):
    """Find the step whose relative bias of the variance is below `tol`, from a coarse pilot."""
    step = min(coarse_step(scene, scheme), float(times[-1]) / 32)
    found = moments(
        gram(scene, times, step, PILOT_PATHS, labelled(seed, "pilot"), 0, threads, scheme)
    )
    own = labelled(seed, "pilot")
    bias, error = _bias(scene, times, step, PILOT_PATHS, own, threads, scheme)["variance"]
    worst = (np.abs(bias) + 2 * error)[-1] / found["variance"][-1]
    return refined_step(step, worst, tol, schemes.scheme(scene, scheme).weak_order(scene))


_MEASURABLE = 0.2  # largest relative bias of Var D at which halving the step measures it


def require_resolved(step, variance, bias, error):
    """Refuse a step so long that halving it does not measure its bias.

    The bias follows the weak order for steps that are short against every time scale of the
    scene, on which g varies included; then it is small against the variance.

    Parameters
    ----------
    step : float
    variance, bias, error : float
        Of D at the last time: its variance, the bias of the step and its standard error.

    Raises
    ------
    ToleranceError
        If the bias is significantly above a fifth of the variance.
    """
    if abs(bias) > max(_MEASURABLE * variance, 4 * error):
        raise ToleranceError(
            f"step = {step:g} is too long for this scene: halving it puts the bias of the variance "
            f"of int g at {abs(bias) / variance:.0%}, where it is no measure of it; "
            "choose a smaller step"
        )


def require_finite(results):
    """Refuse results of paths that left every bound.

    Raises
    ------
    SceneError
    """
    if not all(np.all(np.isfinite(result)) for result in results):
        raise SceneError(
            "the simulation diverged: the drift is not confining or too steep for the step; "
            "mend the potentials or choose a smaller step"
        )


def _output_times(horizon, times):
    require_positive("horizon", horizon)
    times = np.linspace(0, horizon, 201)[1:] if times is None else np.asarray(times, dtype=float)
    require_increasing("output times", times)
    if times[-1] > horizon:
        raise SceneError(
            f"the last output time, {times[-1]:g}, is beyond horizon = {horizon:g}; choose another"
        )
    return times


def require_increasing(name, values):
    """Refuse what is not a list of increasing positive finite numbers."""
    values = np.asarray(values, dtype=float)
    if values.ndim != 1 or not (
        values.size and values[0] > 0 and np.all(np.diff(values) > 0) and np.isfinite(values[-1])
    ):
        raise SceneError(f"the {name} must be positive and increase; sort them")


def require_count(name, value):
    """Refuse what is not a whole positive number."""
    if not (isinstance(value, Integral) and value > 0):
        raise SceneError(
            f"the simulation needs {name} > 0, a whole number, got {value!r}; choose one"
        )


def require_positive(name, value):
    """Refuse what is not a positive finite number."""
    if not 0 < value < np.inf:
        raise SceneError(f"the simulation needs {name} > 0, got {value}; choose a positive number")
