"""The derivative of crossing probabilities with respect to a parameter."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.checks import (
    require_choice,
    require_increasing,
    require_positive,
    require_seed,
    require_threads,
    require_tolerance,
)
from nonsmooth.crossing.first_passage.distribution import default_tolerance
from nonsmooth.errors import ToleranceError, answered
from nonsmooth.results import dataset
from nonsmooth.scenes.scene import Scene, require_random
from nonsmooth.scenes.thresholds import bounds
from nonsmooth.sensitivity import differences, first_passage, plane, sampled, tuning
from nonsmooth.sensitivity.parameters import require_parameter_of
from nonsmooth.sensitivity.questions import Question

METHODS = ("deterministic", "monte_carlo")


def crossing_sensitivity(
    scene: Scene,
    threshold: float | tuple[float, float],
    horizons: ArrayLike,
    parameter: str,
    p: float = 1.0,
    method: str | None = None,
    tol: float | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
) -> xr.Dataset:
    """Return the derivative of `crossing_probability` with respect to a parameter.

    Parameters
    ----------
    scene, threshold, horizons, p
        As for `crossing_probability`, with one threshold.
    parameter : {"damping", "n", "sigma", "threshold", "p"}
        C_b, the penalization, the intensity of the noise, the threshold, or the scale. Of a pair of
        levels both move outwards by the same distance.
    method : {"deterministic", "monte_carlo"}, optional
        ``"deterministic"`` differentiates the equations, with one state variable by the adjoint
        one, and is chosen for one. With two it serves where `crossing_probability` solves them.
        Where this has no answer, as for starts far in the tails, or with two variables for a g that
        changes with the parameter, it takes differences of high order of solved probabilities,
        which take minutes with two.
        ``"monte_carlo"`` is chosen for all others and if `tol` is so loose that it is faster; it
        takes differences of paths that share their noise.
    tol : float, optional
        Error wanted of the derivative times the parameter (for a pair of levels, times the distance
        of the nearer one). Unless given, 1e-4 for ``"deterministic"`` or 1e-2 with two variables,
        and 3e-2 for ``"monte_carlo"``.
    seed : int or tuple
    threads : int, optional
        All cores unless given.

    Returns
    -------
    xarray.Dataset
        `derivative` and `derivative_error` over `horizon`. The error of ``"deterministic"`` is what
        finer grids and other fits change, the largest of all times that they serve; of differences
        it is what another order changes, and the errors of the solutions. By Monte Carlo it is the
        standard error with the biases of the difference and of the time step.

    Raises
    ------
    SceneError
        If an argument is out of range or the scene has no deterministic solver.
    ToleranceError
        If `tol` cannot be met; the best is its `result`.
    """
    require_random(scene)
    parameter = require_parameter_of(scene, parameter, ("threshold", "p"))
    levels, times = bounds(threshold), require_increasing("horizons", horizons)
    question = Question(scene, *levels, times, require_positive("p", p))
    wanted = None if tol is None else require_tolerance(tol)
    seed, threads = require_seed(seed), require_threads(threads)
    settings = tuning.CROSSING
    if method is None:
        loose = wanted is not None and wanted >= settings.sampled
        solvable = scene.is_line and default_tolerance(scene) is not None
        method = "deterministic" if solvable and not loose else "monte_carlo"
    method = require_choice("method", method, METHODS)

    def solve():
        if method == "deterministic":
            usual = settings.solved[min(scene.dimension, len(settings.solved)) - 1]
            accuracy = usual if wanted is None else wanted
            return _solved(question, parameter, accuracy)
        accuracy = settings.sampled if wanted is None else wanted
        return sampled.logarithmic_derivative(question, parameter, accuracy, seed, threads)

    def present(found):
        value, error = np.array(found) / question.value(parameter)
        variables = {
            "derivative": ("horizon", value, f"derivative of the probability by {parameter}"),
            "derivative_error": ("horizon", error, "error of the derivative"),
        }
        coords = {"horizon": ("horizon", times, "horizon T")}
        return dataset(coords, variables, method=method, parameter=parameter)

    return answered(solve, present, tol_given=wanted is not None)


def _solved(question, parameter, tol):
    """Differentiate the equations; take differences where this does not meet the tolerance.

    Of one variable it has no answer where modes are rounded, and few digits where W has fronts.
    """
    refusals, scene = [], question.scene
    for solver, serves in (
        (first_passage, first_passage.applies(scene)),
        (plane, plane.applies(scene, parameter)),
        (differences, True),
    ):
        if serves:
            try:
                return solver.logarithmic_derivative(question, parameter, tol)
            except ToleranceError as refused:
                refusals.append(refused)
    raise min(refusals, key=_worst_error)


def _worst_error(refused):
    return np.inf if refused.result is None else np.max(refused.result[1])
