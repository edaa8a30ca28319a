"""Threshold crossing probabilities W_g(b, T) = P(max_{t <= T} |int_0^t g| >= b).

A threshold is a number b, for both sides, or a pair (lower, upper); there may be several: see
`thresholds.intervals`.
`docs/methods/crossing.md` describes the methods and the choice among them.
"""

import inspect
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.boundary_layer import two_variables
from nonsmooth.boundary_layer.milne import highest_order, mean_of_line
from nonsmooth.checks import (
    require_choice,
    require_count,
    require_increasing,
    require_positive,
    require_seed,
    require_threads,
    require_tolerance,
)
from nonsmooth.crossing import tuning
from nonsmooth.crossing.brownian import asymptotic_crossing
from nonsmooth.crossing.corrected_formula import corrected_crossing
from nonsmooth.crossing.curves import coordinates, curves, one_by_one
from nonsmooth.crossing.first_passage.distribution import default_tolerance, deterministic_crossing
from nonsmooth.crossing.leading.choice import leading_is_quicker
from nonsmooth.crossing.leading.importance_sampling import importance_sampled_crossing
from nonsmooth.crossing.monte_carlo import least_steps, sampled_crossing
from nonsmooth.crossing.state.problem import IntegralCrossing
from nonsmooth.crossing.state.sampled import sampled_state_crossing
from nonsmooth.errors import (
    SceneError,
    ToleranceError,
    answered,
    first_answer,
    of_another_quantity,
    quoted,
)
from nonsmooth.linear_algebra.effort import holds, limited
from nonsmooth.paths.sampling import PRECISIONS
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.scenes.scene import Scene, require_random, uncentred
from nonsmooth.scenes.thresholds import intervals
from nonsmooth.statistics.asymptotic_variance import limit_variance
from nonsmooth.statistics.mean import mean


def crossing_probability(
    scene: Scene,
    threshold: ArrayLike,
    horizons: ArrayLike,
    p: float = 1.0,
    method: str | None = None,
    tol: float | None = None,
    step: float | None = None,
    paths: int | None = None,
    seed: int | tuple = 0,
    precision: str | None = None,
    threads: int | None = None,
    order: int | None = None,
    envelope: str | None = None,
) -> xr.Dataset:
    """Probability that int_0^t g leaves an interval before p T.

    Parameters
    ----------
    scene : Scene
    threshold : float, (float, float) or array_like
        b > 0: the interval is (-sqrt(p) b, sqrt(p) b). Or lower < 0 < upper, one of which may be
        infinite: it is (sqrt(p) lower, sqrt(p) upper). Or several: numbers b in a list or an array
        of one dimension, or pairs in an array of the shape (m, 2). (A tuple of two numbers is a
        pair, and so is a list whose first number is negative.) "1".
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    p : float
        Scale of the functional central limit theorem, > 0.
    method : str, optional
        Chosen by the scene, `tol` and the other parameters unless given.

        - ``"deterministic"`` solves an equation for the first passage. It is for the state y with
          white noise and, in up to some minutes, for two state variables with finite n, odd g and
          drift, and white or Langevin noise. For these scenes it is chosen, with three
          exceptions: a parameter of another method is given; or `tol` is so loose that
          ``"monte_carlo"`` should be faster or, for one variable, that ``"corrected"`` meets
          it; or p is so large that ``"corrected"`` should meet `tol` (above 10 / `tol` for
          two variables; for one if the last time is above 1e7 relaxation times, where the solver
          rounds). If no `tol` is given, it ends after about a minute with what it has, or leaves
          the answer to ``"monte_carlo"``.
        - ``"monte_carlo"`` counts paths. It is chosen for all other scenes, and where the
          deterministic method misses a tolerance that is loose enough for counting.
        - ``"importance_sampling"`` leads paths to the threshold and weights them, for rare
          crossings of every scene in which int g spreads like a Brownian motion. It is chosen where
          there is no deterministic method, counting takes long, and the Brownian limit predicts a
          probability so small that leading is quicker.
        - ``"asymptotic"`` is W_star(b / gamma, T), the limit p -> infinity, eq. (33) of the paper.
          It does not depend on p; its error does.
        - ``"corrected"`` adds what the boundary layer does at a finite p; its error is of the
          order 1/p, p^(-3/2) or p^(-2). All three are for the state y with white noise, and for two
          variables at a finite n if g and the drift are odd. With E g != 0, as with a small slope,
          the former has the order 1. Elsewhere it needs odd g and has the order 1.
    tol : float, optional
        Absolute error wanted. Unless given, it is 1e-2 for ``"monte_carlo"``, and 1e-7 for
        ``"deterministic"`` or 1e-4 with two variables; for ``"importance_sampling"`` a tenth of
        each probability. By Monte Carlo and importance sampling the number of paths and the
        time step follow from it, unless they are given: three standard errors are at most three
        quarters of `tol`, and the bias of the step is at most a quarter. Without it
        ``"corrected"`` returns whatever error it has. ``"asymptotic"`` does not take it.
    step : float, optional
        Longest time step, "1"; ``"monte_carlo"`` and ``"importance_sampling"`` only.
    paths : int, optional
        Number of paths; for ``"importance_sampling"`` of each side. For these two methods only.
    seed : int or tuple
    precision : {"float32", "float64"}, optional
        ``"monte_carlo"`` only; ``"float32"`` unless given.
    threads : int, optional
        All cores unless given.
    order : {1, 2, 3}, optional
        Of ``"corrected"``; 1 unless given.
    envelope : str, optional
        s >= 0, a formula in ``t``, the time up to p T: non-stationary noise s(t) sigma dW;
        ``"monte_carlo"`` only.

    Returns
    -------
    xarray.Dataset
        Over `horizon`, with the method among its attributes: `probability`, and its distance
        `probability_error` to the probability asked for, that of this scene at this p. All that
        the method does not know is part of it. The probability asked for is between `lower` and
        `upper`. Several thresholds are a dimension `threshold` before it, with the coordinates
        `threshold_lower` and `threshold_upper` and, if all are numbers b, these as `threshold`. One
        method serves all of them, and by Monte Carlo the same paths. Solved ones of one variable
        share grids, which changes them within their errors.

        - ``"deterministic"``: the error is estimated from two resolutions. The complement of the
          probability is `survival` with `survival_error`, for one variable to relative accuracy.
        - ``"corrected"``: a bound, from the size of the next orders and the errors of gamma^2 and
          kappa. It is the trivial one for a g that grows faster than the theorems allow.
        - ``"asymptotic"``: a bound, by the corrected formula, of the highest order for one variable
          and of order 1 for others; the trivial one where there is none. What W_star inherits from
          gamma^2 alone is `limit_error`.
        - ``"monte_carlo"``: the bias of the time step and the standard error together, and `lower`
          and `upper` are 95 % confidence limits that account for both. The `standard_error` alone;
          and the bias, as measured by halving the step, `step_bias` with its standard error
          `step_bias_error`. The bias is not subtracted from the probability.
        - ``"importance_sampling"``: the same, and `effective_sample_size`, the number of equally
          weighted paths that would tell as much. Where it is 0, nothing is known but that the
          probability is not above that of the next horizon.

    Raises
    ------
    SceneError
        If an argument is out of range, the method unknown or without such a parameter, or if the
        asymptotic formula is asked for a g whose stationary mean is not 0.
    ToleranceError
        If `tol` cannot be met, and then the best is its `result`; or if a step is so long that
        halving it does not measure its bias.
    """
    require_random(scene)
    thresholds, several = intervals(threshold)
    horizons = require_increasing("horizons", horizons)
    p = require_positive("p", p)
    seed, threads = require_seed(seed), require_threads(threads)
    options = {"tol": tol, "step": step, "paths": paths, "precision": precision, "order": order}
    given = require_options(method, options | {"envelope": envelope})
    attempts = (
        _attempts(scene, thresholds, horizons, p, given) if method is None else [(method, {})]
    )

    def attempt(name, limits):
        method = _by(name, given)
        solve = partial(method, scene, thresholds, horizons, p, seed=seed, threads=threads)
        return answered(lambda: solve(**(given | limits)), lambda found: (name, *found))

    def error(found):
        return np.max(found[1]["probability_error"])

    def good_enough(found):
        """Whether Monte Carlo, which follows the solver, would not be better."""
        solved = tol is None and found[0] == "deterministic"
        return solved and error(found) <= MONTE_CARLO.tolerance

    def solve():
        ways = (partial(attempt, *one) for one in attempts)
        return first_answer(ways, error=error, good_enough=good_enough)

    def present(found):
        name, values, attributes = found
        result = curves(values, horizons, name, attributes, coordinates(thresholds))
        return result if several else result.isel(threshold=0, drop=True)

    with limited(tol):
        return answered(solve, present, tol_given=tol is not None)


def require_options(method: str | None, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return those parameters of a method that are given.

    Parameters
    ----------
    method : str or None
        As for `crossing_probability`.
    options : mapping
        Parameters that only some methods have; what is None is not given.

    Raises
    ------
    SceneError
        If there is no such method, it has no such parameter, or that is out of range.
    """
    given = {name: _OPTIONS[name](value) for name, value in options.items() if value is not None}
    if method is not None:
        _by(require_choice("method", method, METHODS), given)
    return given


def _by(method, given):
    """Look up a method, and refuse parameters that it does not have."""
    for name in given:
        if name not in inspect.signature(METHODS[method]).parameters:
            raise SceneError(f"the method {method!r} has no parameter {name!r}; leave it out")
    return METHODS[method]


def _attempts(scene, thresholds, horizons, p, given):
    """Choose the methods to try in turn, each with its limits.

    Monte Carlo comes before a solver if it may be faster. Its pilot tells how many paths are
    needed; if these are too many, it stops. Monte Carlo comes last if it may meet a tolerance that
    the solver misses. The corrected formulas come before the solver, because their errors tell at
    once whether they suffice.
    """
    choice = tuning.METHOD_CHOICE
    if "order" in given:
        return [("corrected", {})]
    default = default_tolerance(scene)
    of_counting = {"step", "paths", "precision", "envelope"} & given.keys()
    if default is None or of_counting:
        counted = [("monte_carlo", {})]
        if "tol" not in given or of_counting or scene.primitive_variable is not None:
            return counted
        if not leading_is_quicker(scene, thresholds, horizons, p, given["tol"]):
            return counted
        return [("importance_sampling", {}), ("monte_carlo", {"most": choice.sampled_steps})]
    tol = given.get("tol", default)
    attempts = [("deterministic", {})]
    # who gives a tolerance and limits the effort counts paths of a tolerance of its own
    limits = "tol" in given and holds()
    if not limits and (tol >= choice.sampled_tolerance or "tol" not in given):
        attempts.append(("monte_carlo", {"most": choice.sampled_steps}))
    order = _order_that_suffices(scene, p, horizons[-1], tol, "tol" in given)
    formula = [] if order is None else [("corrected", {"order": order, "tol": tol})]
    if limits or "tol" not in given:
        return formula + attempts
    windows = 1 + np.log(horizons[-1] / horizons[0]) / np.log(choice.window)
    pilot, least = least_steps(scene, p * horizons[-1], tol)
    kind = scene.dimension - 1

    def sampled(seconds):
        most = seconds / choice.seconds_of_step[kind]
        fast = pilot <= choice.pilot_share * most and least <= most
        return [("monte_carlo", {"most": most})] if fast else []

    solves = windows * (1 + choice.one_more[kind] * (len(thresholds) - 1))
    attempts = sampled(solves * choice.seconds_solved[kind]) + attempts
    if formula:
        seconds = choice.seconds_corrected[kind] * len(thresholds)
        attempts = sampled(seconds) + formula + attempts
    return attempts


def _order_that_suffices(scene, p, last, tol, given):
    """Return the order of the corrected formula that meets a tolerance at so late times, or None.

    In one variable, a solver is as fast up to where its rounding shows; a given tolerance, which
    may be a loose one, is left to the formula before.
    """
    choice = tuning.METHOD_CHOICE
    if scene.grows_too_fast:
        return None
    if two_variables.applies(scene):
        return 1 if tol * p >= choice.first_order else None
    if not scene.is_line:
        return None
    early = given and tol * p**2 >= choice.least_corrected
    late = p * last * scene.damping >= choice.rounded
    if (early or late) and mean_of_line(scene) == 0:
        return highest_order(scene)
    return 1 if late else None


def _asymptotic(scene, thresholds, horizons, p, seed, threads):
    """Evaluate W_star(b / gamma, T), which does not depend on p; the error does.

    It is the distance to the corrected formula, of the highest order in one variable, and the error
    of that.
    """
    if scene.primitive_variable is not None:
        raise SceneError(
            f"gamma^2 = 0 in this scene: int g is a function of {scene.primitive_variable} along "
            f"paths, here of g = {quoted(scene.observable)}; choose another g, such as "
            f"{scene.primitive_variable}"
        )
    with of_another_quantity():
        gamma2 = limit_variance(scene, seed, threads)
        centre = mean(scene, seed=seed, threads=threads)
    _require_centred(scene, gamma2, centre)

    def one(threshold):
        value, own = asymptotic_crossing(threshold, horizons, gamma2.value, gamma2.error)
        error = np.maximum(value, 1 - value)  # all that is known of a probability
        if highest_order(scene) > 1 or scene.is_odd():
            rough = None if scene.is_line else tuning.LIMIT_ERROR.kappa * np.sqrt(gamma2.value)
            order = highest_order(scene) if scene.is_line else 1
            with suppress(ToleranceError):  # kappa out of reach
                nearer, rest = corrected_crossing(
                    scene, threshold, horizons, p, order, None, seed, threads, rough
                )
                error = np.minimum(np.abs(value - nearer) + rest + own, error)
        return {"probability": value, "probability_error": error, "limit_error": own}

    return _each(one, thresholds)


def _require_centred(scene, gamma2, found):
    """Refuse a g whose mean is not 0."""
    centred = tuning.CENTRED
    uncertainties = centred.uncertainties if found.method == "Monte Carlo" else 1.0
    least = max(centred.relative * np.sqrt(gamma2.value), uncertainties * found.error)
    if abs(found.value) > least:
        raise uncentred("the asymptotic formula", scene, found.value)


def _sampled(
    scene,
    thresholds,
    horizons,
    p,
    seed,
    threads,
    tol=MONTE_CARLO.tolerance,
    step=None,
    paths=None,
    precision="float32",
    most=MONTE_CARLO.most_steps,
    envelope=None,
):
    """Count paths, of stationary noise or under an envelope."""
    options = seed, threads, tol, step, paths, precision
    if envelope is None:
        return sampled_crossing(scene, thresholds, horizons, p, *options, most)
    asked = [IntegralCrossing(scene, *levels) for levels in np.sqrt(p) * thresholds]
    return sampled_state_crossing(asked, p * horizons, *options, envelope)


def _deterministic(scene, thresholds, horizons, p, seed, threads, tol=None):
    return _without_attributes(
        lambda: deterministic_crossing(scene, np.sqrt(p) * thresholds, p * horizons, tol)
    )


def _corrected(scene, thresholds, horizons, p, seed, threads, order=1, tol=None):
    def one(threshold):
        return answered(
            lambda: corrected_crossing(scene, threshold, horizons, p, order, tol, seed, threads),
            lambda found: {"probability": found[0], "probability_error": found[1]},
        )

    return _each(one, thresholds)


def _each(solve, thresholds):
    """Solve for one threshold after the other."""
    return _without_attributes(lambda: one_by_one(partial(solve, tuple(t)) for t in thresholds))


def _without_attributes(solve):
    """Return the answer of a method that has no attributes."""
    return answered(solve, lambda values: (values, {}))


# checks of the parameters that only some methods have
_OPTIONS: dict[str, Callable] = {
    "tol": require_tolerance,
    "step": lambda step: require_positive("step", step),
    "paths": lambda paths: require_count("paths", paths),
    "precision": lambda precision: require_choice("precision", precision, PRECISIONS),
    "order": lambda order: require_count("order", order, 3),
    "envelope": lambda envelope: envelope,  # is read where its values are wanted
}

# Each takes (scene, thresholds, horizons, p, seed, threads), the thresholds as pairs, shape (m, 2),
# and those of the other parameters of `crossing_probability` that it has. It returns a dict of the
# variables over thresholds and horizons and a dict of attributes.
METHODS: dict[str, Callable] = {
    "monte_carlo": _sampled,
    "importance_sampling": importance_sampled_crossing,
    "deterministic": _deterministic,
    "asymptotic": _asymptotic,
    "corrected": _corrected,
}
