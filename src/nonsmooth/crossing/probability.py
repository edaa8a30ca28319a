"""Threshold crossing probabilities W_g(b, T) = P(max_{t <= T} |int_0^t g| >= b).

A threshold is a number b, for both sides, or a pair (lower, upper): see `thresholds.bounds`.
"""

import inspect

import numpy as np
import xarray as xr

from nonsmooth.checks import require_increasing, require_positive
from nonsmooth.crossing.brownian import asymptotic_crossing
from nonsmooth.crossing.corrected_formula import corrected_crossing
from nonsmooth.crossing.first_passage.distribution import default_tolerance, deterministic_crossing
from nonsmooth.crossing.monte_carlo import least_steps, sampled_crossing
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.scenes.thresholds import bounds
from nonsmooth.statistics.asymptotic_variance import limit_variance, stationary_mean

# Seconds on one core, as measured: of a coarse step of a path, with all that comes on top, and of
# the deterministic method for one and two variables for times that grow by the factor _WINDOW
_STEP = 4e-9
_SECONDS, _WINDOW = {1: 0.4, 2: 8.0}, 20.0
_SAMPLED, _PATIENCE = 1e-4, 1e11  # tolerance, and steps, up to which a failed solver is replaced
_PILOT_SHARE = 0.1  # of the solver's time, which the pilot may cost
_FORMULA, _REACHED = 0.05, 0.03  # seconds, and the least error times p^2, of the corrected formula


def crossing_probability(
    scene,
    threshold,
    horizons,
    p=1.0,
    method=None,
    tol=None,
    step=None,
    paths=None,
    seed=0,
    precision=None,
    threads=None,
    order=None,
):
    """Probability that int_0^t g leaves an interval before p T.

    Parameters
    ----------
    scene : Scene
    threshold : float or (float, float)
        b > 0: the interval is (-sqrt(p) b, sqrt(p) b). Or lower < 0 < upper, one of which may be
        infinite: it is (sqrt(p) lower, sqrt(p) upper). "1".
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    p : float
        Scale of the functional central limit theorem, > 0.
    method : {"monte_carlo", "deterministic", "asymptotic", "corrected"}, optional
        ``"deterministic"`` is for the state y with white noise and, in up to a minute or two, for
        two state variables with finite n, odd g and drift, and white or Langevin noise. It
        is taken there, unless a method or a parameter of another one is given, or `tol` is so loose
        that ``"monte_carlo"`` should be faster or, for one variable, the error of ``"corrected"``
        is below it; ``"monte_carlo"`` elsewhere: for three and four state variables, and for two
        where the solver misses its tolerance.
        ``"asymptotic"`` is W_star(b / gamma, T), the limit p -> infinity (eq. equivalent);
        ``"corrected"`` has an error of the order 1/p, p^(-3/2) or, for odd g, p^(-2), see
        `corrected`; beyond the state y with white noise it needs odd g, order 1 and, with more than
        two variables, constants that are sampled.
    tol : float, optional
        Absolute error wanted. ``"monte_carlo"``, 1e-2 unless given: it decides, unless these are
        given, on the number of paths (three standard errors are at most three quarters of `tol`)
        and on the time step (its bias is a quarter, measured again and refined if it is not).
        ``"deterministic"``: 1e-7 unless given, or 1e-4 for two variables. ``"corrected"``: any
        error is returned unless it is given. ``"asymptotic"`` has none.
    step : float, optional
        Longest time step, "1"; ``"monte_carlo"`` only.
    paths : int, optional
        Number of paths; ``"monte_carlo"`` only.
    seed : int or tuple
    precision : {"float32", "float64"}, optional
        ``"monte_carlo"`` only; ``"float32"`` unless given.
    threads : int, optional
        All cores unless given.
    order : {1, 2, 3}, optional
        Of ``"corrected"``; 1 unless given.

    Returns
    -------
    xarray.Dataset
        Over `horizon`, with the method among its attributes: `probability` and
        `probability_error`, for ``"monte_carlo"`` the standard error, with the 95 % confidence
        limits `lower` and `upper`, and `step_bias`, the bias of the time step as measured by
        halving it, with its standard error `step_bias_error`; for ``"deterministic"`` the
        difference of two resolutions, with `survival` and `survival_error`, the complement, for
        one variable to relative accuracy; for ``"corrected"`` a bound of the distance to the
        probability at this p, from the size of the next corrections; for ``"asymptotic"`` the
        error inherited from gamma^2 only, not the distance to a finite p.

    Raises
    ------
    SceneError
        If a parameter is out of range, the method unknown or without such a parameter, or if the
        asymptotic formula is asked for a g whose stationary mean is not 0.
    ToleranceError
        If `tol` cannot be met, or a step is so long that halving it does not measure its bias.
    """
    threshold = bounds(threshold)
    horizons = np.atleast_1d(np.asarray(horizons, dtype=float))
    require_increasing("horizons", horizons)
    require_positive("p", p)
    if tol is not None:
        require_positive("tol", tol)
    options = {"tol": tol, "step": step, "paths": paths, "precision": precision, "order": order}
    given = {name: value for name, value in options.items() if value is not None}
    attempts = _attempts(scene, horizons, p, given) if method is None else [(method, {})]
    failed = {}
    for name, limits in attempts:
        try:
            values, attributes = _by(name, given)(
                scene, threshold, horizons, p, seed=seed, threads=threads, **given, **limits
            )
            break
        except ToleranceError as error:
            failed[name] = error
    else:  # what the solver has reached is the best there is
        raise failed.get("deterministic", failed[name])
    return xr.Dataset(
        {name: ("horizon", value) for name, value in values.items()},
        coords={"horizon": horizons},
        attrs={"method": name} | attributes,
    )


def _by(method, given):
    """Look up a method, which has to have the parameters that are given."""
    if method not in METHODS:
        raise SceneError(f"unknown method {method!r}; choose {' or '.join(map(repr, METHODS))}")
    for name in given:
        if name not in inspect.signature(METHODS[method]).parameters:
            raise SceneError(f"the method {method!r} has no parameter {name!r}; leave it out")
    return METHODS[method]


def _attempts(scene, horizons, p, given):
    """Choose the methods to try in turn, each with its limits.

    Monte Carlo, whose pilot tells how many paths are needed, comes before a solver if it may turn
    out faster, and is stopped if it does not; it comes last if it may do what the solver could not.
    So do the corrected formulas, whose errors tell whether they do.
    """
    if "order" in given:
        return [("corrected", {})]
    default = default_tolerance(scene)
    if default is None or {"step", "paths", "precision"} & given.keys():
        return [("monte_carlo", {})]
    tol = given.get("tol", default)
    attempts = [("deterministic", {})]
    if tol >= _SAMPLED:
        attempts.append(("monte_carlo", {"most": _PATIENCE}))
    if "tol" not in given:
        return attempts
    windows = 1 + np.log(horizons[-1] / horizons[0]) / np.log(_WINDOW)
    pilot, least = least_steps(scene, p * horizons[-1], tol)

    def sampled(seconds):
        most = seconds / _STEP
        fast = pilot <= _PILOT_SHARE * most and least <= most
        return [("monte_carlo", {"most": most})] if fast else []

    attempts = sampled(windows * _SECONDS[scene.dimension]) + attempts
    covered = scene.is_line and scene.is_odd() and not scene.grows_too_fast
    if covered and tol * p**2 >= _REACHED:
        attempts = [*sampled(_FORMULA), ("corrected", {"order": 3}), *attempts]
    return attempts


def _asymptotic(scene, threshold, horizons, p, seed, threads):
    """W_star(b / gamma, T), which does not depend on p."""
    mean, uncertainty = stationary_mean(scene, seed, threads)
    gamma2 = limit_variance(scene, seed, threads)
    if abs(mean) > max(1e-8 * np.sqrt(gamma2.value), 5 * uncertainty):
        raise SceneError(
            f"the asymptotic formula needs E g = 0, but g = {scene.observable!r} has the mean "
            f"{mean:.10g}; subtract it from g"
        )
    value, error = asymptotic_crossing(threshold, horizons, gamma2.value, gamma2.error)
    return {"probability": value, "probability_error": error}, {}


def _deterministic(scene, threshold, horizons, p, seed, threads, tol=None):
    lower, upper = np.sqrt(p) * np.array(threshold)
    return deterministic_crossing(scene, lower, upper, p * horizons, tol), {}


def _corrected(scene, threshold, horizons, p, seed, threads, order=1, tol=None):
    value, error = corrected_crossing(scene, *threshold, horizons, p, order, tol, seed, threads)
    return {"probability": value, "probability_error": error}, {}


# Each takes (scene, threshold, horizons, p, seed, threads), the threshold as a pair, and those of
# the other parameters of `crossing_probability` that it has; it returns the variables over the
# horizons, as a dict, and the attributes.
METHODS = {
    "monte_carlo": sampled_crossing,
    "deterministic": _deterministic,
    "asymptotic": _asymptotic,
    "corrected": _corrected,
}
