"""Derivatives of crossing probabilities with two state variables, by the differentiated equations.

On given nodes the solution depends smoothly on the parameters. Contours invert the derivative of
the Laplace transform (`kinetic.derivatives.reduced`), and early steps in time carry a derivative in
their imaginary part (`kinetic.marching.split_step`). Grids, bases, contours and steps are refined
like those of the probability.
"""

from collections.abc import Callable
from contextlib import suppress
from functools import partial

import numpy as np
import sympy

from nonsmooth.crossing.first_passage import plane, time_stepping
from nonsmooth.crossing.first_passage import tuning as of_first_passage
from nonsmooth.crossing.first_passage.distribution import Together
from nonsmooth.crossing.first_passage.each_part import refine_each_part
from nonsmooth.crossing.first_passage.plane import PlaneProblem, SharedGrids
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
    by_steps = _by_steps, of_first_passage.STEPPED_PARTS
    by_contours = partial(_by_contours, tol=tol), None
    for here, solver, parts in ((early, *by_steps), (early, *by_contours), (~early, *by_contours)):
        if not np.any(error[here] > tol):
            continue
        grids = together.grids(tuple(times[here]))
        problem = _Problem(scene, *levels, times[here], grids, moves)
        # grids of extreme scenes may have no finite modes, or grow
        with suppress(UnstableError, np.linalg.LinAlgError), np.errstate(all="ignore"):
            refined = parts or problem.resolutions
            found, stated = _refined(problem, times[here], refined, solver, tol)
            if stated < np.max(error[here]):
                value[here], error[here] = found, stated
    if np.any(error > tol):
        raise missed(parameter, tol, value, error)
    return value, error


def _refined(problem, times, parts, solver, tol):
    """Refine each part of the resolution by itself; return the derivative and its largest error."""

    def errors(found):
        return np.max(found.change, axis=0) + of_first_passage.PLANE.unseen_error

    found = refine_each_part(parts, solver(problem, times), lambda found: errors(found) <= tol, tol)
    return found.value[0], float(np.max(errors(found)))


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


def _by_contours(problem, times, tol):
    """Return what inverts the derivative on contours; its second row is that of the survival."""
    solve = plane.inverted(problem, times, tol)

    def solved(resolution, count):
        value = solve(resolution, count)[0]
        return np.array([value, -value])

    return solved


def _by_steps(problem, times):
    """Return what takes steps of the derivative; its second row is that of the survival."""
    solve = time_stepping.stepped(problem, times, problem.moves)
    return lambda resolution, count: (solve(resolution, count) / IMAGINARY).real


def _moves(question, parameter):
    """Differentiate the distances of both levels from 0 by the logarithm of a parameter."""
    distances = np.array([-question.lower, question.upper]) * np.sqrt(question.p)
    finite = np.isfinite(distances)
    if parameter == "threshold":  # both move outwards by the same distance
        return tuple(np.where(finite, distances.min(), 0.0).tolist())
    if parameter == "p":
        return tuple((-np.where(finite, distances, 0.0) / 2).tolist())
    return 0.0, 0.0


def _change(question, parameter):
    """Differentiate the equations by the logarithm of a parameter; None if they do not change.

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
