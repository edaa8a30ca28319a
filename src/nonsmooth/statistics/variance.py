"""Variance of int_0^tau g and its growth rate gamma^2."""

import math
import time
from itertools import combinations

import numpy as np
import xarray as xr

from nonsmooth.checks import require_increasing, require_positive
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.estimate import Estimate, require
from nonsmooth.grids import potential_wells, uniform_refinement
from nonsmooth.line import eigenfunctions, quadrature
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.paths import schemes
from nonsmooth.paths.ensembles import integrals_at
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.resolution import (
    MOST_STEPS,
    PILOT_PATHS,
    SIGMAS,
    coarse_step,
    paths_for,
    refined_step,
    require_possible,
)
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.simulation import simulate
from nonsmooth.scenes import symbols
from nonsmooth.scenes.relaxation import rate_at_infinity
from nonsmooth.statistics import gamma2_on_grids, moments_on_grids
from nonsmooth.statistics.gamma2_on_grids import growth_to
from nonsmooth.statistics.sampled_gamma2 import gamma2_bias, slopes

_DEGREES = (8, 12, 16, 20, 24)
_EXACT = {1: 1e-10, 2: 1e-6, 3: 2e-4, 4: 3e-3}  # tolerances by the number of state variables
_VARIANCE = {1: 1e-9, 2: 1e-5}  # absolute, of v(tau)/tau
_SAMPLED, _LEAST_SAMPLED = 1e-2, 1e-3  # tolerances of Monte Carlo: unless given, and the least
_HALVING_SHARE, _BIAS_SHARE = 0.4, 0.12  # of the tolerance: error of the bias, and the bias
_RESTING = 0.2  # relative standard error of a variance that rests on 1 / 0.2^2 paths at least
_MORE = 6.0  # square root of the factor by which paths are added where it rests on fewer
_ATTEMPTS = 5
_FEW_STEPS = 5e7  # of all paths together, faster than grids for two variables
# tolerances from which Monte Carlo is faster than grids, as measured by benchmarks/requests.py
_FASTER_SAMPLED = {1: math.inf, 2: math.inf, 3: 1e-2, 4: 3e-3}
_TIMES = (10.0, 60.0, 110.0)  # between which Monte Carlo takes the slope, unless it changes
_RELAXED = 2.0  # relaxation times of the drift before the first of them
_SOFT = 1e3  # n whose drift is looked at for n = inf
_DOUBLINGS = 7
_SCOUTS = 1024  # paths from each well
_STEP = 0.02  # times the smaller of 1 and 1/C_b


def asymptotic_variance(scene, tol=None, method=None, seed=0, threads=None):
    """gamma_g^2 of Theorem thm3: the growth rate of the variance of int_0^t g.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Requested relative error; unless given, 1e-10, 1e-6, 2e-4, 1e-2 for one to four state
        variables, the last by Monte Carlo, as everywhere by that method; 3e-3 if the deterministic
        one is asked for with four.
    method : {"deterministic", "monte_carlo"}, optional
        Unless given, the one that should be the faster for `tol` and, if that fails and `tol` is
        a percent or more, the other.
    seed, threads
        Of Monte Carlo: int or tuple; all cores unless given.

    Returns
    -------
    Estimate
        Deterministic for the state y with white noise by closed form (dry friction, g = y) or
        quadrature, in every other scene by spectral elements. By Monte Carlo the error is the
        bias of the time step and the standard error together; `tol` bounds the bias and three
        standard errors.

    Raises
    ------
    SceneError
        If there is no such method, or g is a function of the noise alone.
    ToleranceError
        If `tol` cannot be met; the message has the best value and its error.
    """
    began = time.perf_counter()
    if method not in (None, "deterministic", "monte_carlo"):
        raise SceneError(
            f"gamma^2 has no method {method!r}; choose 'deterministic' or 'monte_carlo'"
        )
    failed = []
    for name in _fastest_first(scene, tol) if method is None else [method]:
        try:
            if name == "monte_carlo":
                accuracy = _SAMPLED if tol is None else tol
                return _by_monte_carlo(scene, accuracy, seed, threads, began)
            value, error, solver = _deterministic(scene, tol)
            return Estimate(value, error, solver, time.perf_counter() - began)
        except ToleranceError as error:
            failed.append(error)
    raise failed[0]


def _fastest_first(scene, tol):
    if "y" not in scene.state:
        return ["monte_carlo"]
    many = scene.dimension
    tol = _EXACT[many] if tol is None else tol
    if tol >= _FASTER_SAMPLED[many]:
        return ["monte_carlo", "deterministic"]
    return ["deterministic", "monte_carlo"] if tol >= _SAMPLED else ["deterministic"]


def _deterministic(scene, tol):
    if "y" not in scene.state:
        raise SceneError(
            f"g = '{scene.observable}' is a function of the noise alone, which the solvers do not "
            "take without the velocity; use method='monte_carlo'"
        )
    tol = _EXACT[scene.dimension] if tol is None else tol
    if uniform_refinement.applies(scene) and (
        found := gamma2_on_grids.growth_on_ladder(scene, tol)
    ):
        return *found, "spectral elements"
    if not scene.is_line:
        return *growth_to(scene, tol), "spectral elements"
    if (
        scene.mechanics.is_dry_friction
        and scene.observable_expression == symbols.y
        and scene.noise.sigma == 1.0
    ):
        value, error = friction_variance(scene.n, scene.damping)
        if error <= tol * value:  # not for a tiny C_b, where it cancels
            return value, error, "closed form"
    return *quadrature.asymptotic_variance(scene, tol), "quadrature"


def limit_variance(scene, seed=0, threads=None):
    """gamma^2 as accurately as formulas for crossing probabilities need it.

    Parameters
    ----------
    scene : Scene
    seed, threads
        Of Monte Carlo.

    Returns
    -------
    Estimate
    """
    # beyond two variables a percent, enough for W_star, is sampled faster than solved
    accuracy, way = {1: (None, "deterministic"), 2: (2e-3, "deterministic")}.get(
        scene.dimension, (None, "monte_carlo")
    )
    return asymptotic_variance(scene, accuracy, way, seed, threads)


def stationary_mean(scene, seed=0, threads=None):
    """Stationary mean of g and its error: exact by symmetry or quadrature, else by Monte Carlo.

    Parameters
    ----------
    scene : Scene
    seed, threads
        Of Monte Carlo.

    Returns
    -------
    value, error : float
    """
    if scene.is_odd():
        return 0.0, 0.0
    if scene.is_line:
        return quadrature.mean(scene)
    _, sample = _settled_growth(
        scene, _first_step(scene), PILOT_PATHS, labelled(seed, "mean"), threads
    )
    return sample.mean, sample.mean_error


def _first_step(scene):
    return min(_STEP * min(1.0, 1 / scene.damping), schemes.scheme(scene).longest_step(scene) / 2)


def _first_times(scene):
    """Choose the first times of the slope, no shorter than the memory of the drift."""
    try:
        rate = rate_at_infinity(scene.with_n(min(scene.n, _SOFT))).value / 2
    except SceneError:  # the drift is not linear far out: `settled` has to find out
        return _TIMES
    return tuple(max(1.0, _RELAXED / (rate * _TIMES[0])) * t for t in _TIMES)


def _settled_growth(scene, step, paths, seed, threads):
    """Lengthen the time until the slope of the variance changes neither with it nor with the start.

    Paths that never leave the well they start in settle too, on the wrong slope.
    """
    elsewhere = [scene.with_start(start) for start in potential_wells.starts(scene)]
    times = _first_times(scene)
    for attempt in range(_DOUBLINGS):
        own = labelled(seed, attempt)

        def sampled(scene, paths, own=own, times=times):
            sampling = Sampling(step, paths, own, threads=threads)
            return slopes(integrals_at(scene, times, sampling), times)

        scouts = [sampled(other, _SCOUTS) for other in elsewhere] if len(elsewhere) > 1 else []
        forgotten = all(a.agrees(b) for a, b in combinations(scouts, 2))
        if forgotten:
            sample = sampled(scene, paths)
            if sample.settled and all(sample.agrees(scout) for scout in scouts):
                return times, sample
        times = tuple(2 * t for t in times)
    changes = (
        f"{sample.gamma2:.3g}, still changing by {sample.settling:.1g}"
        if forgotten
        else f"paths from {len(elsewhere)} wells of the potentials still differ"
    )
    raise ToleranceError(
        f"the growth rate of the variance has not settled by t = {times[-1] / 2:g}: {changes}; "
        "the scene mixes slowly, or int_0^t g has no such rate"
    )


def _by_monte_carlo(scene, tol, seed, threads, began):
    if not tol >= _LEAST_SAMPLED:
        raise ToleranceError(
            f"Monte Carlo cannot reach tol = {tol:g} for gamma^2; use tol >= {_LEAST_SAMPLED:g} "
            "or method='deterministic'"
        )
    paths, fewer, step = PILOT_PATHS, PILOT_PATHS, coarse_step(scene)
    order = schemes.scheme(scene).weak_order(scene)
    for attempt in range(_ATTEMPTS):
        own = labelled(seed, attempt)
        times, sample = _settled_growth(scene, step, paths, own, threads)
        halving = Sampling(step, fewer, labelled(own, "halving"), threads=threads)
        bias, spread = gamma2_bias(scene, times, halving)
        error = abs(bias) + float(np.hypot(sample.gamma2_error, spread))
        met = (
            abs(bias) + SIGMAS * float(np.hypot(sample.gamma2_error, spread)) <= tol * sample.gamma2
        )
        if sample.gamma2 < 5 * error and (met or attempt > 0):
            raise ToleranceError(
                f"gamma^2 = {sample.gamma2:.1e} with an error of {error:.1e} may be 0, which it is "
                "if int_0^t g stays bounded, as for g = y where the displacement is confined; "
                "choose another observable, such as x"
            )
        if met:
            break
        allowed = max(tol * sample.gamma2, error / 2)
        paths = max(paths, paths_for(math.sqrt(paths) * sample.gamma2_error, allowed))
        fewer = max(fewer, math.ceil(fewer * (SIGMAS * spread / (_HALVING_SHARE * allowed)) ** 2))
        step = refined_step(step, abs(bias) + spread, _BIAS_SHARE * allowed, order)
    require(met, sample.gamma2, error, tol)
    return Estimate(sample.gamma2, error, "Monte Carlo", time.perf_counter() - began)


def variance(scene, times, tol=None, method=None, seed=0, threads=None):
    """Mean w(start, tau) and variance v(start, tau) of int_0^tau g - E g (eq. defvgyt).

    Parameters
    ----------
    scene : Scene
    times : array_like, shape (t,)
        tau >= 0, "1"; by Monte Carlo increasing and positive.
    tol : float, optional
        Requested absolute error of v(tau)/tau; unless given, 1e-9 for one state variable, 1e-5 for
        two and 1e-2 by Monte Carlo.
    method : {"deterministic", "monte_carlo"}, optional
        ``"deterministic"`` is for the state y with white noise, or two state variables and a
        finite n. Unless a method is given, it is taken there, but for two variables where `tol` is
        so loose that a few paths do; ``"monte_carlo"`` elsewhere.
    seed, threads
        Of Monte Carlo: int or tuple; all cores unless given.

    Returns
    -------
    xarray.Dataset
        `w`, `v` and their errors `w_error`, `v_error` over `time`, with the method among the
        attributes. One variable is solved by an eigenfunction expansion, two by
        `transient.moments`; the errors are what the last refinement changes, and rounding. By
        Monte Carlo they are the bias of the time step and the standard error together; `tol`
        bounds the bias and three standard errors.

    Raises
    ------
    SceneError
        If the scene has no deterministic solver and that is asked for, or a time is out of range.
    ToleranceError
        If `tol` cannot be met; the message has the best value and its error.
    """
    times = np.atleast_1d(np.asarray(times, dtype=float))
    if not np.all(times >= 0):
        raise SceneError("the times of the variance must not be negative; remove those that are")
    if method not in (None, "deterministic", "monte_carlo"):
        raise SceneError(
            f"v(tau) has no method {method!r}; choose 'deterministic' or 'monte_carlo'"
        )
    solve = _solver(scene)
    if method == "deterministic" and solve is None:
        raise SceneError(
            f"v(tau) is solved for one or two state variables and, for two, a finite n, not for "
            f"({', '.join(scene.state)}) with {scene.noise.title} at n = {scene.n:g}; use "
            "method='monte_carlo', which takes every scene"
        )
    if (
        method is None
        and solve is moments_on_grids.moments
        and tol is not None
        and _increase(times)
    ):
        try:  # where a few paths do, they are faster than any grid
            return _sampled_moments(scene, times, tol, seed, threads, _FEW_STEPS)
        except ToleranceError:
            pass
    if method == "monte_carlo" or solve is None:
        return _sampled_moments(scene, times, _SAMPLED if tol is None else tol, seed, threads)
    tol = _VARIANCE[scene.dimension] if tol is None else tol
    (w, v), (w_error, v_error) = solve(scene, times, tol)
    _require_accuracy(times, v, v_error, tol)
    return _moments_of(times, w, w_error, v, v_error, "deterministic")


def _increase(times):
    return times[0] > 0 and np.all(np.diff(times) > 0)


def _require_accuracy(times, v, error, tol):
    rate, rate_error = (part / np.where(times > 0, times, 1.0) for part in (v, error))
    worst = int(np.argmax(rate_error))
    if not rate_error[worst] <= tol:
        raise ToleranceError(
            f"v(tau)/tau = {rate[worst]:.10g} at tau = {times[worst]:g} has an error of "
            f"{rate_error[worst]:.1e}, above tol = {tol:g}; loosen tol"
        )


def _moments_of(times, w, w_error, v, v_error, method):
    variables = {"w": w, "w_error": w_error, "v": v, "v_error": v_error}
    return xr.Dataset(
        {name: ("time", values) for name, values in variables.items()},
        coords={"time": times},
        attrs={"method": method},
    )


def _solver(scene):
    """Choose what solves for w and v, of (scene, times, tol); None if there is nothing."""
    if scene.is_line:
        return _of_velocity
    if scene.dimension == 2 and not math.isinf(scene.n) and "y" in scene.state:
        return moments_on_grids.moments
    return None


def _sampled_moments(scene, times, tol, seed, threads, most=MOST_STEPS):
    """Simulate w and v with at most so many steps; pilots choose the sizes."""
    require_increasing("times of the variance", times)
    require_positive("tol", tol)
    paths, step = PILOT_PATHS, min(coarse_step(scene), float(times[-1]) / 32)
    order = schemes.scheme(scene).weak_order(scene)
    for attempt in range(_ATTEMPTS):
        run = simulate(
            scene,
            times[-1],
            step=step,
            paths=paths,
            seed=labelled(seed, attempt),
            times=times,
            threads=threads,
        )
        own, bias, spread = (
            np.abs(run[f"variance_{part}"].values) / times
            for part in ("error", "bias", "bias_error")
        )
        error = np.max(bias + SIGMAS * np.hypot(own, spread))
        size = max(float(run["variance"][-1]) / times[-1], np.finfo(float).tiny)
        rare = own[-1] / size / _RESTING
        if error <= tol and rare <= 1:
            break
        # an eighth of the paths measures the bias of the step
        deviation = math.sqrt(paths) * np.max(own)
        paths = max(paths, paths_for(deviation, tol), math.ceil(paths * min(rare, _MORE) ** 2))
        step = refined_step(step, np.max(bias + spread), _BIAS_SHARE * tol, order)
        require_possible(
            paths,
            times[-1] / step,
            f"v(tau)/tau = {float(run['variance'][-1]) / times[-1]:.3g} at tau = {times[-1]:g} has "
            f"an error of {error:.1g}",
            tol,
            most,
        )
    if rare > 1:
        raise ToleranceError(
            f"v(tau)/tau = {size:.3g} at tau = {times[-1]:g} rests on the few of {paths} paths "
            "that have moved; choose a longer time"
        )
    mean, uncertain = stationary_mean(scene, labelled(seed, "stationary"), threads)
    w = run["mean"].values - mean * times
    w_error = np.abs(run["mean_bias"]) + np.hypot(run["mean_error"], run["mean_bias_error"])
    v, v_error = run["variance"].values, times * (bias + np.hypot(own, spread))
    _require_accuracy(times, v, times * (bias + SIGMAS * np.hypot(own, spread)), tol)
    return _moments_of(times, w, w_error.values + uncertain * times, v, v_error, "monte_carlo")


def _of_velocity(scene, times, tol):
    """Solve for w and v, with errors, for the state y alone with white noise."""
    scale = tol * np.where(times > 0, times, 1.0)
    return _refine(
        lambda degree: np.array(eigenfunctions.moments(scene, times, degree)),
        # w is the difference of terms as large as the standard deviation, v of E Delta^2 and w^2
        lambda degree, wv: (
            eigenfunctions.rounding(scene, degree)
            * np.array([np.abs(wv[0]) + np.sqrt(np.abs(wv[1])), np.abs(wv[1]) + wv[0] ** 2])
        ),
        lambda wv: np.array([np.full_like(times, np.inf), scale]),
    )


def _refine(solve, rounding, allowed):
    """Raise the polynomial degree until two solutions agree; return the last and its error.

    The difference is the error of the coarser one, which convergence in the degree makes far
    larger than that of the finer one; rounding is added.
    """
    solution = solve(_DEGREES[0])
    for degree in _DEGREES[1:]:
        coarser, solution = solution, solve(degree)
        error = np.abs(solution - coarser) + rounding(degree, solution)
        if np.all(error <= allowed(solution)):
            break
    return solution, error
