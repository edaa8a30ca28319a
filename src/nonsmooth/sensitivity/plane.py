"""Derivatives of crossing probabilities with two state variables, by the differentiated equations.

On given nodes the solution depends smoothly on the parameters. Contours invert the derivative of
the Laplace transform (`kinetic.derivatives.reduced`), and early steps in time carry a derivative in
their imaginary part (`kinetic.marching.split_step`). Grids, bases, contours and steps are refined
like those of the probability.
"""

from collections.abc import Callable

import numpy as np
import sympy

from nonsmooth.crossing.first_passage import plane, time_stepping
from nonsmooth.crossing.first_passage import tuning as of_first_passage
from nonsmooth.crossing.first_passage.distribution import Together
from nonsmooth.crossing.first_passage.each_part import refine_each_part
from nonsmooth.crossing.first_passage.plane import PlaneProblem, SharedGrids
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.generator import Change
from nonsmooth.kinetic.derivatives.reduced import differentiated
from nonsmooth.kinetic.marching.split_step import IMAGINARY
from nonsmooth.kinetic.ordinates_plane import UnstableError
from nonsmooth.scenes.scene import Scene
from nonsmooth.sensitivity.parameters import PARAMETERS, change, derivative
from nonsmooth.sensitivity.questions import Question, missed


def applies(scene: Scene, parameter: str) -> bool:
    """Whether `first_passage.plane` applies, and g does not change with the parameter."""
    if not plane.applies(scene):
        return False
    observable = scene.observable_expression
    return parameter not in PARAMETERS or derivative(scene, observable, parameter) == 0


def logarithmic_derivative(
    question: Question, parameter: str, tol: float
) -> tuple[np.ndarray, np.ndarray]:
    """Differentiate W with respect to the logarithm of a parameter.

    Parameters
    ----------
    question : Question
        Of a scene to which this module `applies`.
    parameter : str
    tol : float
        Absolute error wanted.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
        The error is the sum of what other grids, bases and contours or steps change, the largest of
        all times that they serve.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    scene, levels, times = question.scene, question.levels, question.times
    moves = _moves(question, parameter)
    together = Together(scene, np.array([levels]), times, _change(question, parameter))
    early = together.early[0]
    value, error = np.zeros(len(times)), np.full(len(times), np.inf)
    for here, parts, solver in (
        (early, of_first_passage.STEPPED_PARTS, _by_steps),
        (~early, together.problem(0, times).resolutions, _by_contours),
    ):
        if here.any():
            grids = together.grids(tuple(times[here]))
            problem = _Problem(scene, *levels, times[here], grids, moves)
            value[here], error[here] = _refined(problem, times[here], parts, solver, tol)
    if np.any(error > tol):
        raise missed(parameter, tol, value, error)
    return value, error


def _refined(problem, times, parts, solver, tol):
    """Refine each part of the resolution by itself; return the derivative and its error."""

    def stated(found):
        error = np.max(found.change) + of_first_passage.PLANE.unseen_error
        return found.value[0], np.full(len(times), error)

    try:
        found = refine_each_part(
            parts, solver(problem, times), lambda found: np.all(stated(found)[1] <= tol), tol
        )
    except UnstableError as unstable:
        raise ToleranceError(f"{unstable}; use method='monte_carlo'") from None
    return stated(found)


class _Problem(PlaneProblem):
    """A problem whose transform is the derivative of that of the crossing time.

    Parameters
    ----------
    scene, lower, upper, times, grids
        As for `PlaneProblem`; the grids know the change of the generator.
    moves : tuple of float
        Derivatives of the distances of the lower and of the upper level from 0.
    """

    def __init__(
        self,
        scene: Scene,
        lower: float,
        upper: float,
        times: np.ndarray,
        grids: SharedGrids,
        moves: tuple[float, float],
    ):
        super().__init__(scene, lower, upper, times, grids)
        self.moves = moves

    def transform(
        self, resolution: tuple, times: np.ndarray, rarity: float
    ) -> Callable[[complex], complex]:
        """Return the derivative of F on a grid of some resolution; see `LaplaceProblem`."""
        ordinates = self.grids.ordinates(*resolution)
        return lambda z: differentiated(ordinates, z, self.levels, self.moves)


def _by_contours(problem, times):
    """Derivative, and that of the survival probability, by contours; takes resolutions."""
    solve = plane.inverted(problem, times)

    def solved(resolution):
        value = solve(resolution)[0]
        return np.array([value, -value])

    return solved


def _by_steps(problem, times):
    """Derivative, and that of the survival probability, by steps; takes resolutions."""
    distances = np.array([-problem.lower, problem.upper])
    finite = np.isfinite(distances)
    stretches = (problem.moves / distances)[finite]
    if stretches[0] != stretches[-1]:
        raise ToleranceError("steps take levels that change by the same factor alone")
    solve = time_stepping.stepped(problem, times, float(stretches[0]))
    return lambda resolution: (solve(resolution) / IMAGINARY).real


def _moves(question, parameter):
    """Derivatives of the distances of both levels from 0 by the logarithm of a parameter."""
    distances = np.array([-question.lower, question.upper]) * np.sqrt(question.p)
    finite = np.isfinite(distances)
    if parameter == "threshold":  # both move outwards by the same distance
        return tuple(np.where(finite, distances.min(), 0.0))
    if parameter == "p":
        return tuple(np.where(finite, distances, 0.0) * -0.5)
    return 0.0, 0.0


def _change(question, parameter):
    """Derivative of the scene's equations by the logarithm of a parameter; None if there is none.

    The scale p makes levels grow like its root and time run p times as fast. In the time of T the
    generator has the factor p, and int g the factor p over the root.
    """
    scene = question.scene
    if parameter == "threshold":
        return None
    if parameter == "p":
        found, factor = Change(scene.numerical_drift(), scene.noise.sigma**2 / 2), 1.0
    else:
        found, factor = change(scene, parameter), question.value(parameter)
    drift = {symbol: factor * sympy.sympify(rate) for symbol, rate in found.drift.items()}
    return Change(drift, factor * found.diffusion)
