"""Threshold crossing probabilities W_g(b, T) = P(max_{t <= T} |int_0^t g| >= b).

A threshold is a number b, for both sides, or a pair (lower, upper): see `thresholds.bounds`.
"""

import inspect
import math
from dataclasses import dataclass

import numpy as np
import scipy
import xarray as xr

from nonsmooth import schemes
from nonsmooth.brownian import asymptotic_crossing
from nonsmooth.corrected import corrected_crossing
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.first_passage import default_tolerance, spectral_crossing
from nonsmooth.march import march
from nonsmooth.panel import TOTAL_DELTA, new_panel
from nonsmooth.spectral import applies
from nonsmooth.streams import BLOCK, blocks, labelled
from nonsmooth.thresholds import bounds
from nonsmooth.times import equal_steps
from nonsmooth.trajectories import (
    MOST_STEPS,
    PILOT_PATHS,
    SIGMAS,
    SPREAD_SHARE,
    coarse_step,
    coupled,
    parallel,
    refined_step,
    require_count,
    require_finite,
    require_increasing,
    require_positive,
    require_possible,
    require_resolved,
    step_bias,
    variance_of_fine,
)
from nonsmooth.variance import limit_variance, stationary_mean

_CONFIDENCE = 0.997  # of the pilot's limits of the probability
# Seconds on one core, as measured: of a coarse step of a path, with all that comes on top, and of
# the spectral method for one and two variables for times that grow by the factor _WINDOW
_STEP = 4e-9
_SECONDS, _WINDOW = {1: 0.4, 2: 8.0}, 20.0
_SAMPLED, _PATIENCE = 1e-4, 1e11  # tolerance, and steps, up to which a failed solver is replaced
_PILOT_SHARE = 0.1  # of the solver's time, which the pilot may cost
_FORMULA, _REACHED = 0.05, 0.03  # seconds, and the least error times p^2, of the corrected formula
_PILOT = 12.0  # paths of the pilot times the tolerance: one that changes sides is an eighth of it
_SKEW = 5.1  # counts by which the limits of the probability are off where nothing has crossed
_ENLARGE = 8  # times the paths, for a probability that has not been seen
_CHECKED = 1 + 3 / 8  # times the work of the paths: an eighth is run with half the step, too
_ATTEMPTS = 3  # at a step whose bias fits in

DESCRIPTIONS = {
    "probability": "probability of crossing sqrt(p) b by p T",
    "probability_error": "standard error of the probability",
    "lower": "lower 95 % confidence limit (Jeffreys)",
    "upper": "upper 95 % confidence limit (Jeffreys)",
}


def first_passage_counts(
    scene,
    threshold,
    horizons,
    p,
    step,
    paths,
    seed,
    first_path=0,
    threads=None,
    scheme="strang",
    precision="float32",
):
    """Count the paths that cross sqrt(p) times the threshold between the horizons p T.

    A path is dropped once it has crossed.

    Parameters
    ----------
    scene : Scene
    threshold : float or (float, float)
        b or its lower and upper level, "1".
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    p : float
        Scale of the functional central limit theorem.
    step : float
        Longest time step, "1"; it is shortened to divide the intervals of p T.
    paths, seed, first_path, threads, scheme, precision
        As for `trajectories.gram`.

    Returns
    -------
    numpy.ndarray of int, shape (k,)

    Raises
    ------
    SceneError
        If a parameter is out of range or a path diverges.
    """
    levels = np.sqrt(p) * np.array(bounds(threshold))
    grid = [
        (steps, schemes.coefficients(scene, scheme, h, precision))
        for steps, h in equal_steps(p * np.asarray(horizons, dtype=float), step)
    ]

    def run(job):
        block, lanes = job
        panel = new_panel(scene, seed, block, precision)
        left = [lanes]
        for steps, s in grid:
            left.append(march(s, panel, left[-1], steps, *levels))
        # a path that diverges never crosses
        require_finite([panel.total[TOTAL_DELTA, : left[-1]]])
        return -np.diff(left)

    return sum(parallel(run, blocks(first_path, paths), threads))


def first_passage_bias(scene, threshold, horizons, p, step, paths, seed, threads=None):
    """Measure what halving the time step changes in the crossing probability.

    Parameters
    ----------
    scene, threshold, horizons, p, paths, seed, threads
        As for `first_passage_counts`.
    step : float
        The longer of the two steps, "1".

    Returns
    -------
    bias, error : numpy.ndarray, shape (k,)
        Of the probability with the longer step, with its standard error.
    """
    times = p * np.asarray(horizons, dtype=float)
    levels = np.sqrt(p) * np.array(bounds(threshold))
    _, passage = coupled(scene, times, step, paths, seed, threads, levels)
    return _bias_of_counts(scene, times, passage)


def _bias_of_counts(scene, times, passage):
    """Bias of the fraction crossed, from first-passage times with half the step and the step."""
    fine, coarse = passage
    paths = len(fine)
    change = (coarse[:, None] <= times).astype(float) - (fine[:, None] <= times)
    factor = 1 / (1 - 2 ** -schemes.scheme(scene, "strang").weak_order(scene))
    # where no path changed sides, as if one had
    error = np.sqrt(np.maximum(change.var(axis=0), 1 / paths) / paths)
    return factor * change.mean(axis=0), factor * error


def first_passage_shift(scene, threshold, horizon, p, step, paths, seed, threads=None):
    """Measure how halving the time step shifts the first-passage times.

    Parameters
    ----------
    scene, threshold, p, paths, seed, threads
        As for `first_passage_counts`.
    horizon : float
        T; paths that have not crossed by p T with both steps are left out.
    step : float
        The longer of the two steps, "1".

    Returns
    -------
    numpy.ndarray, shape (3,)
        Sums over the paths of the powers 0 to 2 of log(time with step / time with step/2).
    """
    levels = np.sqrt(p) * np.array(bounds(threshold))
    _, (fine, coarse) = coupled(scene, [p * horizon], step, paths, seed, threads, levels)
    both = np.isfinite(fine) & np.isfinite(coarse)
    ratio = np.log(coarse[both] / fine[both])
    return np.array([len(ratio), ratio.sum(), np.sum(ratio**2)])


def proportion(successes, trials, level=0.95):
    """Estimate a probability with a confidence interval that holds down to rare events.

    The interval is Jeffreys' (Brown, Cai and DasGupta, Statist. Sci. 16, 2001), the quantiles of
    the beta law of the counts plus one half; its limits are 0 and 1 where nothing or everything
    was counted.

    Parameters
    ----------
    successes, trials : array_like of int
    level : float
        Confidence level of the two-sided interval.

    Returns
    -------
    estimate, lower, upper : numpy.ndarray
    """
    successes, trials = np.broadcast_arrays(successes, trials)
    a, b = successes + 0.5, trials - successes + 0.5
    lower = np.where(successes == 0, 0.0, scipy.special.betaincinv(a, b, (1 - level) / 2))
    upper = np.where(successes == trials, 1.0, scipy.special.betainccinv(a, b, (1 - level) / 2))
    return successes / trials, lower, upper


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
    method : {"monte_carlo", "spectral", "asymptotic", "corrected"}, optional
        ``"spectral"`` is deterministic, for the state y with white noise and, in up to a minute or
        two, for two state variables with finite n, odd g and drift, and white or Langevin noise. It
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
        ``"spectral"``: 1e-7 unless given, or 1e-4 for two variables. ``"corrected"``: any error is
        returned unless it is given. ``"asymptotic"`` has none.
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
        halving it, with its standard error `step_bias_error`; for ``"spectral"`` the difference
        of two resolutions, with `survival` and `survival_error`, the complement, for one variable
        to relative accuracy; for ``"corrected"`` a bound of the distance to the probability at
        this p, from the size of the next corrections; for ``"asymptotic"`` the error inherited
        from gamma^2 only, not the distance to a finite p.

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
        raise failed.get("spectral", failed[name])
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
    attempts = [("spectral", {})]
    if tol >= _SAMPLED:
        attempts.append(("monte_carlo", {"most": _PATIENCE}))
    if "tol" not in given:
        return attempts
    windows = 1 + np.log(horizons[-1] / horizons[0]) / np.log(_WINDOW)
    steps = p * horizons[-1] / coarse_step(scene)

    def sampled(seconds):
        most = seconds / _STEP
        pilot = 3 * min(PILOT_PATHS, _PILOT / tol) * steps
        fast = pilot <= _PILOT_SHARE * most and _SKEW / tol * steps <= most
        return [("monte_carlo", {"most": most})] if fast else []

    attempts = sampled(windows * _SECONDS[len(scene.state)]) + attempts
    covered = applies(scene) and scene.is_odd() and not scene.grows_too_fast
    if covered and tol * p**2 >= _REACHED:
        attempts = [*sampled(_FORMULA), ("corrected", {"order": 3}), *attempts]
    return attempts


def _monte_carlo(
    scene,
    threshold,
    horizons,
    p,
    seed,
    threads,
    tol=1e-2,
    step=None,
    paths=None,
    precision="float32",
    most=MOST_STEPS,
):
    """Count paths; the step and the number of paths follow from `tol` unless given.

    A pilot runs paths with a coarse step and its half. Where hardly any of them cross, or nearly
    all, it is the answer. Otherwise there are as many paths as confidence limits show to be needed,
    with a step whose bias, extrapolated by the weak order, fits in; it is measured anew, and
    refined if it does not.
    """
    if step is not None:
        require_positive("step", step)
    if paths is not None:
        require_count("paths", paths)
    times, levels = p * horizons, np.sqrt(p) * np.array(threshold)
    order, allowed = schemes.scheme(scene).weak_order(scene), (1 - SPREAD_SHARE) * tol

    def halving(step, paths, label):
        own = labelled(seed, label)
        return _Halving(
            step, *coupled(scene, times, step, paths, own, threads, levels, precision=precision)
        )

    def possible(paths, step, crossed, count):
        told = f"W = {crossed[-1] / count:.3g} has an error of {SIGMAS / 2 / np.sqrt(count):.1g}"
        require_possible(_CHECKED * paths, times[-1] / step, told, tol, most)

    pilot, own_step, wanted, fewest = None, step, paths, PILOT_PATHS
    if step is None or paths is None:
        longest = coarse_step(scene) if step is None else step
        count = min(PILOT_PATHS, math.ceil(_PILOT / tol) if paths is None else paths)
        fewest = count
        pilot = halving(longest, count, "pilot")
        crossed = pilot.crossed(times)
        bias, error = pilot.bias(scene, times)
        worst = np.max(np.abs(bias) + error)
        if step is None and paths is None:
            half = 2**-order
            if pilot.is_resolved(order) and _distance(crossed, count) + half * worst <= tol:
                values = crossing_estimate(crossed, count)
                values["step_bias"], values["step_bias_error"] = half * bias, half * error
                return values, {"step": longest / 2, "paths": count}
        if paths is None:
            wanted = _paths_wanted(crossed, count, tol)
            possible(wanted, longest, crossed, count)
        if step is None:
            if worst > allowed and wanted // 8 > count:
                pilot = halving(longest, wanted // 8, "pilot")
                worst = np.max(np.abs(np.array(pilot.bias(scene, times))).sum(axis=0))
            own_step = refined_step(longest, worst, allowed, order)
            if paths is None:
                possible(wanted, own_step, crossed, count)
    for _ in range(_ATTEMPTS):
        crossed, done = np.zeros(len(horizons), dtype=int), 0
        while done < wanted:
            more = wanted - done
            crossed = crossed + np.cumsum(
                first_passage_counts(
                    scene,
                    threshold,
                    horizons,
                    p,
                    own_step,
                    more,
                    seed,
                    done,
                    threads,
                    precision=precision,
                )
            )
            done = wanted
            if paths is None and _distance(crossed, done) > SPREAD_SHARE * tol:
                wanted = max(_paths_wanted(crossed, done, tol), done + BLOCK)
                possible(wanted, own_step, crossed, done)
        if paths is None and pilot.step == own_step:
            check = pilot
        else:
            check = halving(own_step, min(done, max(fewest, done // 8)), "halving")
        check.require_resolved(order)
        bias, error = check.bias(scene, times)
        if step is not None or np.max(np.abs(bias) - SIGMAS * error) <= allowed:
            values = crossing_estimate(crossed, done)
            values["step_bias"], values["step_bias_error"] = bias, error
            return values, {"step": own_step, "paths": done}
        own_step = refined_step(own_step, np.max(np.abs(bias) + error), allowed, order)
    raise ToleranceError(
        f"W = {crossed[-1] / done:.3g} has a bias of {np.max(np.abs(bias)):.1e} by the step "
        f"{check.step:.1e}, which does not fall by the weak order; choose a step or loosen tol"
    )


@dataclass(frozen=True)
class _Halving:
    """Paths with a step and with half of it on the same noise, see `trajectories.coupled`."""

    step: float
    change: np.ndarray
    passage: np.ndarray

    def crossed(self, times):
        """Count the paths that have crossed with half the step."""
        return np.sum(self.passage[0][:, None] <= times, axis=0)

    def bias(self, scene, times):
        """Bias of the fraction crossed, of the whole step, and its standard error."""
        return _bias_of_counts(scene, times, self.passage)

    def require_resolved(self, order):
        """Refuse a step at which halving does not measure the bias."""
        bias, error = step_bias(self.change, order)
        require_resolved(self.step, variance_of_fine(self.change)[-1], bias[-1], error[-1])

    def is_resolved(self, order):
        """Whether halving the step measures its bias."""
        try:
            self.require_resolved(order)
        except ToleranceError:
            return False
        return True


def _distance(crossed, paths):
    """Distance of the farthest confidence limit of the probabilities."""
    value, low, high = proportion(crossed, paths, _CONFIDENCE)
    return np.max(np.maximum(high - value, value - low))


def _paths_wanted(crossed, paths, tol):
    """Count paths, in whole blocks, whose limits should be as near as the tolerance asks for.

    Jeffreys' limits are SIGMAS standard deviations and _SKEW |1 - 2 W| counts away. W is taken a
    standard deviation nearer to 1/2, if that does not take more than _ENLARGE times the paths.
    """
    share = SPREAD_SHARE * tol

    def enough(W):
        spread, skew = SIGMAS * np.sqrt(W * (1 - W)), _SKEW * np.abs(1 - 2 * W)
        return ((spread + np.sqrt(spread**2 + 4 * skew * share)) / (2 * share)) ** 2

    W = crossed / paths
    error = crossing_estimate(crossed, paths)["probability_error"]
    careful = enough(np.where(W < 0.5, np.minimum(W + error, 0.5), np.maximum(W - error, 0.5)))
    wanted = np.max(np.maximum(enough(W), np.minimum(careful, _ENLARGE * paths)))
    return BLOCK * math.ceil(wanted / BLOCK)


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


def _spectral(scene, threshold, horizons, p, seed, threads, tol=None):
    lower, upper = np.sqrt(p) * np.array(threshold)
    return spectral_crossing(scene, lower, upper, p * horizons, tol), {}


def _corrected(scene, threshold, horizons, p, seed, threads, order=1, tol=None):
    value, error = corrected_crossing(scene, *threshold, horizons, p, order, tol, seed, threads)
    return {"probability": value, "probability_error": error}, {}


# Each takes (scene, threshold, horizons, p, seed, threads), the threshold as a pair, and those of
# the other parameters of `crossing_probability` that it has; it returns the variables over the
# horizons, as a dict, and the attributes.
METHODS = {
    "monte_carlo": _monte_carlo,
    "spectral": _spectral,
    "asymptotic": _asymptotic,
    "corrected": _corrected,
}


def crossing_estimate(crossed, paths):
    """Turn numbers of crossed paths into `probability`, its standard error and 95 % limits.

    The standard error is that of Jeffreys' beta law, so that it is not 0 where none has crossed.
    """
    probability, lower, upper = proportion(crossed, paths)
    a, b = crossed + 0.5, paths - crossed + 0.5
    return {
        "probability": probability,
        "probability_error": np.sqrt(a * b / (a + b + 1)) / (a + b),
        "lower": lower,
        "upper": upper,
    }
