"""Threshold crossing probabilities W_g(b, T) = P(max_{t <= T} |int_0^t g| >= b).

A threshold is a number b, for both sides, or a pair (lower, upper): see `thresholds.bounds`.
"""

import inspect

import numpy as np
import scipy
import xarray as xr

from nonsmooth import first_passage_plane, schemes, spectral
from nonsmooth.brownian import asymptotic_crossing
from nonsmooth.corrected import corrected_crossing
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.first_passage import spectral_crossing
from nonsmooth.march import march
from nonsmooth.panel import TOTAL_DELTA, new_panel
from nonsmooth.streams import blocks, labelled
from nonsmooth.thresholds import bounds
from nonsmooth.times import equal_steps
from nonsmooth.trajectories import (
    PILOT_PATHS,
    coarse_step,
    coupled,
    parallel,
    refined_step,
    require_count,
    require_finite,
    require_increasing,
    require_positive,
    require_resolved,
    step_bias,
    variance_of_fine,
)
from nonsmooth.variance import limit_variance, stationary_mean

_AFFORDABLE = 1e-3  # tolerance of Monte Carlo that may stand in for the spectral method

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
        two, for two state variables with finite n, odd g and drift, and white or Langevin noise: it
        is taken there unless a parameter of another method is given, and ``"monte_carlo"``
        elsewhere: for three and four state variables, and for two where it misses its tolerance.
        ``"asymptotic"`` is W_star(b / gamma, T), the limit p -> infinity (eq. equivalent);
        ``"corrected"`` has an error of the order 1/p or p^(-3/2), see `corrected`; beyond the
        state y with white noise it needs odd g, order 1 and, with more than two variables,
        constants that are sampled.
    tol : float, optional
        Absolute error wanted. ``"monte_carlo"``, 1e-2 unless given: it decides, unless these are
        given, on the number of paths (two standard errors are at most `tol`) and on the time
        step (its bias is half). ``"spectral"``: 1e-7 unless given, or 1e-4 for two variables. The
        formulas have none.
    step : float, optional
        Longest time step, "1"; ``"monte_carlo"`` only.
    paths : int, optional
        Number of paths; ``"monte_carlo"`` only.
    seed : int or tuple
    precision : {"float32", "float64"}, optional
        ``"monte_carlo"`` only; ``"float32"`` unless given.
    threads : int, optional
        All cores unless given.
    order : {1, 2}, optional
        Of ``"corrected"``; 1 unless given.

    Returns
    -------
    xarray.Dataset
        Over `horizon`, with the method among its attributes: `probability` and
        `probability_error`, for ``"monte_carlo"`` the standard error, with the 95 % confidence
        limits `lower` and `upper`, and `step_bias`, the bias of the time step as measured by
        halving it, with its standard error `step_bias_error`; for ``"spectral"`` the difference
        of two resolutions, with `survival` and `survival_error`, the complement, for one variable
        to relative accuracy; for the formulas the error inherited from gamma^2 and the other
        constants only, not the distance to the finite-p probability.

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
    if method is None:
        method = _chosen(scene, given)
        if method == "spectral" and first_passage_plane.applies(scene):
            try:
                return crossing_probability(scene, threshold, horizons, p, method, tol)
            except ToleranceError:
                if tol is not None and tol < _AFFORDABLE:
                    raise
                method = "monte_carlo"
    if method not in METHODS:
        raise SceneError(f"unknown method {method!r}; choose {' or '.join(map(repr, METHODS))}")
    for name in given:
        if name not in inspect.signature(METHODS[method]).parameters:
            raise SceneError(f"the method {method!r} has no parameter {name!r}; leave it out")
    values, attributes = METHODS[method](
        scene, threshold, horizons, p, seed=seed, threads=threads, **given
    )
    return xr.Dataset(
        {name: ("horizon", value) for name, value in values.items()},
        coords={"horizon": horizons},
        attrs={"method": method} | attributes,
    )


def _chosen(scene, given):
    if "order" in given:
        return "corrected"
    sampled = {"step", "paths", "precision"} & given.keys()
    deterministic = spectral.applies(scene) or first_passage_plane.applies(scene)
    return "spectral" if deterministic and not sampled else "monte_carlo"


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
):
    """Count paths; the step and the number of paths follow from `tol` unless given."""
    paths = int(np.ceil(1 / tol**2)) if paths is None else paths
    require_count("paths", paths)
    fewer = min(paths, max(PILOT_PATHS, paths // 8))
    problem = (scene, threshold, horizons, p)
    if step is None:
        step = coarse_step(scene)
        bias, error = first_passage_bias(*problem, step, fewer, labelled(seed, "pilot"), threads)
        worst = np.max(np.abs(bias) + error)
        step = refined_step(step, worst, tol / 2, schemes.scheme(scene).weak_order(scene))
    require_positive("step", step)
    crossed = first_passage_counts(
        *problem, step, paths, seed, threads=threads, precision=precision
    )
    values = crossing_estimate(np.cumsum(crossed), paths)
    times, levels = p * horizons, np.sqrt(p) * np.array(threshold)
    own = labelled(seed, "halving")
    change, passage = coupled(scene, times, step, fewer, own, threads, levels)
    bias, error = step_bias(change, schemes.scheme(scene).weak_order(scene))
    require_resolved(step, variance_of_fine(change)[-1], bias[-1], error[-1])
    values["step_bias"], values["step_bias_error"] = _bias_of_counts(scene, times, passage)
    return values, {"step": step, "paths": paths}


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


def _corrected(scene, threshold, horizons, p, seed, threads, order=1):
    value, error = corrected_crossing(scene, *threshold, horizons, p, order, seed, threads)
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
