"""The probability that a variable of the state leaves an interval before a time."""

import inspect
from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.checks import (
    require_choice,
    require_count,
    require_increasing,
    require_positive,
    require_seed,
    require_threads,
    require_tolerance,
)
from nonsmooth.crossing.curves import coordinates, curves, one_by_one
from nonsmooth.crossing.state import line, plane, tuning
from nonsmooth.crossing.state.problem import state_crossings
from nonsmooth.crossing.state.sampled import sampled_state_crossing
from nonsmooth.errors import SceneError, answered, first_answer
from nonsmooth.paths.sampling import PRECISIONS
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.scenes.scene import Scene, require_scene


def state_crossing_probability(
    scene: Scene,
    variable: str,
    threshold: ArrayLike,
    horizons: ArrayLike,
    method: str | None = None,
    tol: float | None = None,
    step: float | None = None,
    paths: int | None = None,
    seed: int | tuple = 0,
    precision: str | None = None,
    threads: int | None = None,
    envelope: str | None = None,
) -> xr.Dataset:
    """Probability that a variable of the state leaves an interval before a time.

    This is the classical first-passage problem, of the displacement or the velocity themselves; see
    `crossing_probability` for that of the integral of g.

    Parameters
    ----------
    scene : Scene
        Its observable does not matter.
    variable : {"x", "y", "eta", "zeta"}
        The displacement, the velocity, or a variable of the scene's noise.
    threshold : float, (float, float) or array_like
        b > 0: the interval is (-b, b). Or lower < 0 < upper, one of which may be infinite. The
        variable starts inside. Or several, as for `crossing_probability`. In units of the variable,
        "1".
    horizons : array_like, shape (k,)
        Increasing T > 0, "1".
    method : {"monte_carlo", "deterministic"}, optional
        ``"deterministic"`` is for a variable that is a state by itself, as y where neither a
        potential nor colored noise acts, or with one other variable and a finite n. Unless given,
        it is chosen for these, and ``"monte_carlo"`` for all others, with two variables if `tol`
        is so loose that it is faster, and if `step`, `paths`, `precision` or `envelope` are given.
    tol : float, optional
        Absolute error wanted; unless given, 1e-8 and 1e-4 for ``"deterministic"`` with one and two
        variables, and 1e-2 for ``"monte_carlo"``. By Monte Carlo the number of paths and the time
        step follow from it, unless they are given: three standard errors are at most three quarters
        of `tol`, and the bias of the step is at most a quarter.
    step : float, optional
        Longest time step, "1"; ``"monte_carlo"`` only.
    paths : int, optional
        Number of paths; ``"monte_carlo"`` only.
    seed : int or tuple
    precision : {"float32", "float64"}, optional
        ``"monte_carlo"`` only; ``"float32"`` unless given.
    threads : int, optional
        All cores unless given.
    envelope : str, optional
        s >= 0, a formula in ``t``, such as ``"t*exp(1 - t)"``: non-stationary noise s(t) sigma dW;
        ``"monte_carlo"`` only.

    Returns
    -------
    xarray.Dataset
        Over `horizon`, with the method among its attributes: `probability` and its distance
        `probability_error` to the probability asked for, which is between `lower` and `upper`.
        Several thresholds are a dimension before it, as `crossing_probability` has them. By Monte
        Carlo the same paths serve all; solved ones take a solution each.

        - ``"deterministic"``: the error is estimated from what coarser resolutions change.
        - ``"monte_carlo"``: the bias of the time step and the standard error together, and `lower`
          and `upper` are 95 % confidence limits that account for both. Crossings within a step
          count: of the variable that noise drives by the law of the Brownian bridge, of smooth
          ones as part of the bias. The `standard_error` alone; and the bias, as measured by
          doubling the step, `step_bias` with its standard error `step_bias_error`.

    Raises
    ------
    SceneError
        If an argument is out of range, the variable starts outside, or the method does not apply.
    ToleranceError
        If `tol` cannot be met; the best is its `result`.

    Examples
    --------
    >>> import nonsmooth as ns
    >>> scene = ns.Scene("friction")
    >>> W = ns.state_crossing_probability(scene, "y", 1.0, [1, 10])
    >>> print(W["probability"].values.round(4))
    [0.2107 0.9439]
    """
    require_scene(scene)
    asked, several = state_crossings(scene, variable, threshold)
    times = require_increasing("horizons", horizons)
    method = None if method is None else require_choice("method", method, METHODS)
    options = {"tol": tol, "step": step, "paths": paths, "precision": precision}
    options["envelope"] = envelope
    given = {name: _OPTIONS[name](value) for name, value in options.items() if value is not None}
    given |= {"seed": require_seed(seed), "threads": require_threads(threads)}
    names = _fitting(asked, given) if method is None else [method]

    def attempt(name):
        return answered(
            lambda: METHODS[name](asked, times, **_taken(name, given)),
            lambda found: (name, *found),
        )

    def error(found):
        return np.max(found[1]["probability_error"])

    def solve():
        return first_answer(
            (partial(attempt, name) for name in names),
            error=error,
            good_enough=lambda found: tol is None and error(found) <= MONTE_CARLO.tolerance,
        )

    def present(found):
        name, values, attributes = found
        levels = coordinates(np.array([(one.lower, one.upper) for one in asked]))
        result = curves(values, times, name, attributes, levels)
        return result if several else result.isel(threshold=0, drop=True)

    return answered(solve, present, tol_given=tol is not None)


def _solver(asked):
    """Return the deterministic solver and its usual tolerance, None if there is none."""
    for method, settings in ((line, tuning.LINE), (plane, tuning.PLANE)):
        if all(method.applies(one) for one in asked):
            return method.solved, settings.tolerance
    return None


def _fitting(asked, given):
    """Name the methods to try in turn."""
    if _solver(asked) is None or {"step", "paths", "precision", "envelope"} & given.keys():
        return ["monte_carlo"]
    if "tol" not in given:
        return ["deterministic", "monte_carlo"]
    if not line.applies(asked[0]) and given["tol"] >= tuning.PLANE.faster_sampled:
        return ["monte_carlo", "deterministic"]
    sampled = given["tol"] >= tuning.SAMPLED.least_tolerance
    return ["deterministic", "monte_carlo"] if sampled else ["deterministic"]


def _taken(name, given):
    """Return the parameters that a method takes, and refuse others that were given."""
    known = inspect.signature(METHODS[name]).parameters
    for option in given.keys() - known.keys() - {"seed", "threads"}:
        raise SceneError(f"the method {name!r} has no parameter {option!r}; leave it out")
    return {option: value for option, value in given.items() if option in known}


def _deterministic(asked, times, tol=None):
    solver, scene = _solver(asked), asked[0].scene
    if solver is None:
        raise SceneError(
            f"crossings of {asked[0].variable} are solved for one or two variables with finite n, "
            f"not for ({', '.join(scene.state)}) with {scene.noise.title} at n = {scene.n:g}; "
            "use method='monte_carlo'"
        )
    solve, usual = solver

    def one(question):
        return answered(
            lambda: solve(question, times, usual if tol is None else tol),
            lambda found: {"probability": found[0], "probability_error": found[1]},
        )

    solvers = (partial(one, question) for question in asked)
    return answered(lambda: one_by_one(solvers), lambda values: (values, {}))


# checks of the parameters that only some methods have
_OPTIONS: dict[str, Callable] = {
    "tol": require_tolerance,
    "step": lambda step: require_positive("step", step),
    "paths": lambda paths: require_count("paths", paths),
    "precision": lambda precision: require_choice("precision", precision, PRECISIONS),
    "envelope": lambda envelope: envelope,  # is read where its values are wanted
}

# Each takes a StateCrossing for each threshold, the horizons, and those of the other parameters
# that it has. It returns a dict of the variables over thresholds and horizons and a dict of
# attributes.
METHODS: dict[str, Callable] = {
    "deterministic": _deterministic,
    "monte_carlo": sampled_state_crossing,
}
