"""Mean and variance of int_0^tau g over finite times, by the method that a tolerance calls for."""

import math
from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.checks import (
    require_choice,
    require_list,
    require_seed,
    require_threads,
    require_tolerance,
)
from nonsmooth.errors import SceneError, ToleranceError, answered, first_answer
from nonsmooth.estimate import not_negative
from nonsmooth.grids.mesh import box
from nonsmooth.line import eigenfunctions, quadrature
from nonsmooth.refine import until_agreement
from nonsmooth.results import dataset
from nonsmooth.scenes.scene import Scene, require_scene
from nonsmooth.statistics import moments_on_grids, tuning
from nonsmooth.statistics.asymptotic_variance import METHODS
from nonsmooth.statistics.sampled_moments import require_accuracy, sampled_moments


def variance(
    scene: Scene,
    times: ArrayLike,
    tol: float | None = None,
    method: str | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
    envelope: str | None = None,
) -> xr.Dataset:
    """Mean w(start, tau) and variance v(start, tau) of int_0^tau g - E g, eq. (36) of the paper.

    Parameters
    ----------
    scene : Scene
    times : array_like, shape (t,)
        tau >= 0, "1"; by Monte Carlo increasing and positive.
    tol : float, optional
        Requested absolute error of v(tau)/tau. Unless given, it is a twentieth of the largest of
        them by Monte Carlo, and by the deterministic method 1e-9 for one state variable and 1e-5
        for two, times the largest of them if that is below 1; what misses these is returned with a
        warning.
    method : {"deterministic", "monte_carlo"}, optional
        ``"deterministic"`` is possible for the state y with white noise, and for two state
        variables and a finite n. Unless a method is given, it is taken for these scenes, except
        for two variables and a `tol` so loose that a few paths are enough, or without a `tol` where
        grids do not reach a twentieth of the largest v(tau)/tau. ``"monte_carlo"`` is taken for all
        others.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.
    envelope : str, optional
        s >= 0, a formula in ``t``, such as ``"t*exp(1 - t)"``: non-stationary noise s(t) sigma dW,
        by Monte Carlo. There is no stationary mean then, and w is that of int_0^tau g.

    Returns
    -------
    xarray.Dataset
        `w`, `v` and their errors `w_error`, `v_error` over `time`, with the method among the
        attributes. One variable is solved by an eigenfunction expansion, two by
        `moments_on_grids.moments`; the errors are the changes by the last refinement, and rounding.
        For a constant g all are 0.
        By Monte Carlo they are the bias of the time step and the standard error together; `tol`
        bounds the bias and three standard errors.

    Raises
    ------
    SceneError
        If an argument is out of range, a deterministic solver is asked for and the scene has none,
        or g is not square-integrable (which is seen for the state y with white noise).
    ToleranceError
        If `tol` cannot be met; the best values are its `result`.
    """
    require_scene(scene)
    times = require_list("times", times)
    if np.any(times < 0):
        raise SceneError("times of the variance are negative; remove those that are")
    tol = None if tol is None else require_tolerance(tol)
    method = None if method is None else require_choice("method", method, METHODS)
    seed, threads = require_seed(seed), require_threads(threads)
    if not scene.state:  # g is constant
        none = np.zeros((2, len(times)))
        growth = 0.0 if envelope is None else float(scene.numerical_observable())
        return _dataset(times, (growth * times, none[0]), none, "deterministic")
    if envelope is not None and method == "deterministic":
        raise SceneError("the method 'deterministic' has no parameter 'envelope'; leave it out")
    solve = _solver(scene) if envelope is None else None
    if method == "deterministic" and solve is None:
        raise SceneError(
            f"v(tau) is solved for one or two state variables and, for two, a finite n, not for "
            f"({', '.join(scene.state)}) with {scene.noise.title} at n = {scene.n:g}; use "
            "method='monte_carlo', which takes every scene"
        )
    if scene.is_line and scene.grows_too_fast:
        quadrature.solved(scene)  # refuses g whose variance is infinite
    given = tol is not None
    solved = partial(_solved, solve, scene, times, tol)
    sample = partial(sampled_moments, scene, times, tol, seed, threads, envelope=envelope)

    def attempt(method, way):
        return answered(way, lambda found: _dataset(times, *found, method))

    def solve_or_sample():
        deterministic = partial(attempt, "deterministic", solved)
        monte_carlo = partial(attempt, "monte_carlo", sample)
        if method == "monte_carlo" or solve is None:
            return monte_carlo()
        increasing = times[0] > 0 and bool(np.all(np.diff(times) > 0))
        if method is not None or solve is _of_velocity or not increasing:
            return deterministic()
        if given:
            try:  # A few paths are faster than any grid, if a few are enough.
                few = partial(sample, most=tuning.VARIANCE.few_steps)
                return attempt("monte_carlo", few)
            except ToleranceError:
                pass
        return first_answer(
            [deterministic, monte_carlo],
            error=_relative_error,
            # a tolerance that grids miss is out of the reach of paths
            good_enough=lambda run: given or _relative_error(run) <= tuning.VARIANCE.share,
        )

    return answered(solve_or_sample, lambda run: run, tol_given=given)


def _relative_error(run):
    """Return the largest error of v(tau)/tau over the largest value."""
    scale = np.where(run["time"] > 0, run["time"], 1.0)
    value, error = (float(np.max(run[name] / scale)) for name in ("v", "v_error"))
    return error / value if value > 0 else math.inf


def _solved(solve, scene, times, tol):
    """Solve for w and v, and refuse what is too inaccurate."""
    first = accuracy = tuning.VARIANCE.tolerance[scene.dimension - 1] if tol is None else tol
    found, error = solve(scene, times, accuracy)
    if tol is None:
        rate, rate_error = (
            np.max(part[1] / np.where(times > 0, times, 1.0)) for part in (found, error)
        )
        accuracy *= min(1.0, max(rate, tuning.VARIANCE.least))
        if accuracy < rate_error <= first:
            found, error = solve(scene, times, accuracy)
    require_accuracy(times, found, error, error[1], accuracy)
    return found, error


def _dataset(times, found, error, method):
    (w, v), (w_error, v_error) = found, error
    v, v_error = not_negative(v, v_error)
    variables = {
        "w": ("time", w, "mean of int g - E g"),
        "w_error": ("time", w_error, "error of the mean"),
        "v": ("time", v, "variance of int g"),
        "v_error": ("time", v_error, "error of the variance"),
    }
    return dataset({"time": ("time", times, "time")}, variables, method=method)


def _solver(scene: Scene) -> Callable | None:
    """Choose the function of (scene, times, tol) that solves for w and v; None if there is none."""
    if scene.is_line:
        return _of_velocity
    if scene.dimension == 2 and not math.isinf(scene.n) and box.suits(scene):
        return moments_on_grids.moments
    return None


def _of_velocity(scene, times, tol):
    """Solve for w and v, with errors, for the state y alone with white noise.

    The stated error is the change when the polynomial degree was last raised. It is the error of
    the solution of lower degree, and far above that of the other, because convergence in the degree
    is fast. Rounding is added.
    """
    settings = tuning.VARIANCE
    degrees = settings.degrees[0 if tol >= settings.loose else settings.few :]
    allowed = np.array([np.full_like(times, np.inf), tol * np.where(times > 0, times, 1.0)])

    def error(solutions):
        coarser, (w, v, rounding) = solutions[-2:]
        # w is the difference of terms as large as the standard deviation, v of E Delta^2 and w^2
        terms = np.array([np.abs(w) + np.sqrt(np.abs(v)), np.abs(v) + w**2])
        degree = degrees[len(solutions) - 1]
        change = np.abs(np.array([w, v]) - coarser[:2])
        return change + eigenfunctions.rounding(scene, degree) * terms + [0 * v, rounding]

    found = until_agreement(
        degrees,
        lambda degree: np.array(eigenfunctions.moments_with_rounding(scene, times, degree)),
        error,
        lambda _, error: bool(np.all(error <= allowed)),
    )
    return found.value[:2], found.error
