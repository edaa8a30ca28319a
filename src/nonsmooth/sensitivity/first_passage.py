"""Derivatives of crossing probabilities with one state variable, by the adjoint kinetic equation.

The Laplace transform of the crossing time is differentiated at each place z
(`kinetic.derivatives.adjoint`) and inverted like the transform itself: one solution, where a
difference takes several. The derivative is small where the probability is, so that one vertical
line serves all times.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from nonsmooth.crossing.first_passage import tuning as of_first_passage
from nonsmooth.crossing.first_passage import vertical_lines
from nonsmooth.crossing.first_passage.line import Intervals, LineProblem
from nonsmooth.crossing.first_passage.saddle_points import SaddlePoints, saddle_points
from nonsmooth.kinetic.derivatives.adjoint import Adjoint
from nonsmooth.kinetic.ordinates_line import Change, changed, ordinates
from nonsmooth.line.potential import depth
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import y
from nonsmooth.sensitivity import tuning
from nonsmooth.sensitivity.parameters import PARAMETERS, change_of_depth, derivative
from nonsmooth.sensitivity.questions import Question, missed

Parts = Callable[[complex], np.ndarray]


def applies(scene: Scene) -> bool:
    """Whether the scene has the state y with white noise, and starts not far in the tails."""
    if not scene.is_line:
        return False
    start = scene.start.get("y", 0.0)
    return bool(depth(scene)(start) <= of_first_passage.FAR_START.depth)


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
        The error is what finer grids and other places of the fit change, the largest of all times,
        and at least some of what the change before was. Where fronts keep the transform from
        falling on the line, fits are bad everywhere: a misfit above `tol` counts, too, times the
        factor exp(1) that the inversion has at the last time.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    times, line, refinement = question.times, of_first_passage.LINE, of_first_passage.REFINEMENT
    (problem,) = Intervals(question.scene, [question.levels]).problems
    saddles = saddle_points(problem, times)
    if saddles.bound[-1] < np.log(line.least_probability):  # nothing crosses
        return np.zeros(len(times)), np.full(len(times), tuning.ADJOINT.nothing)
    solver = _Solver(question, parameter, problem, saddles, tol)
    rounding = tuning.ADJOINT.rounding * (1 + question.scene.damping * times[-1])

    def stated(found):
        changes = [np.max(np.abs(fine - coarse)) for coarse, fine in pairwise(found)]
        # two levels may agree by chance
        change = max(changes[-1], tuning.ADJOINT.falls * max(changes[-2:]))
        seen = refinement.safety * change + refinement.by_chance * tol + rounding
        # smaller ones mean less than they are, and other places show what they mean
        return seen + (math.e * solver.misfit if solver.misfit > tol else 0.0)

    errors = [np.inf]

    def hopeless(_, error):
        """Whether the error no longer falls, because it is rounding, or fits are far too bad."""
        errors.append(error)
        return not errors[-1] < errors[-2] or solver.misfit > tuning.ADJOINT.misfit * tol

    found = until_agreement(
        [level.resolution for level in line.levels],
        solver.solve,
        stated,
        lambda _, error: error <= tol,
        hopeless,
    )
    if found.met:
        return found.value, np.full(len(times), found.error)
    # solutions that do not come closer to each other say how far off they may all be
    apart = max(np.max(np.abs(found.value - other)) for other in found.solutions[-3:])
    error = np.full(len(times), max(found.error, refinement.safety * apart))
    raise missed(parameter, tol, found.value, error)


class _Solver:
    """The derivative on grids of some degree, all on one vertical line.

    Parameters
    ----------
    question, parameter, tol
        As for `logarithmic_derivative`.
    problem : LineProblem
    saddles : SaddlePoints
        Of the problem.
    """

    def __init__(
        self,
        question: Question,
        parameter: str,
        problem: LineProblem,
        saddles: SaddlePoints,
        tol: float,
    ):
        self.question, self.parameter, self.problem = question, parameter, problem
        lines = of_first_passage.VERTICAL_LINES
        self.accuracy = max(lines.best, lines.accuracy * tol)
        self.abscissa = 1 / question.times[-1]
        share = tuning.ADJOINT.negligible * self.accuracy
        self.begun = saddles.begin(self.abscissa, share)
        self._offset = 0.0
        self.misfit = 0.0

    def solve(self, degree: int) -> np.ndarray:
        """Solve on a grid, with other places on the line than before; note the misfit there."""
        question, times = self.question, self.question.times
        probability, fronts = self.problem.parts(degree, times, 0.0)
        line = vertical_lines.line(probability, self.abscissa)
        self._offset = 0.5 - self._offset

        def inverted(parts):
            if times[-1] <= fronts.min():
                return np.zeros(len(times))
            found = vertical_lines.inverted(
                parts,
                replace(line, size=1.0),
                np.maximum(fronts, self.begun),
                self.accuracy,
                rising=False,
                offset=self._offset,
            )
            self.misfit = max(self.misfit, found.misfit)
            return found.at(times)

        self.misfit = 0.0
        value = inverted(_differentiated(question, self.parameter, self.problem, degree))
        if self.parameter == "p":
            # p is a factor of the times, too: t times the density of the crossing time, of which
            # the transform is F itself
            density = inverted(lambda z: z / self.abscissa * probability(z))
            value = value + times * self.abscissa * density
        if not np.all(np.isfinite(value)):
            raise np.linalg.LinAlgError("the derivative is not finite")
        return value


def _differentiated(question: Question, parameter: str, problem: LineProblem, degree: int) -> Parts:
    """Parts of the transform's derivative by the logarithm of a parameter."""
    scene, (lower, upper) = question.scene, question.levels
    of_grid = problem.fitting(degree, question.times, 0.0)
    grid = ordinates(scene, *of_grid, distances=(-lower, upper), fold=False)
    value = question.value(parameter)
    if parameter in PARAMETERS:
        change = changed(scene, grid, _change(scene, parameter))

        def of(adjoint):
            return value * adjoint.by_parameter(change)

    else:
        if parameter == "threshold":  # both levels move outwards by the same distance
            ways = np.full(2, value * np.sqrt(question.p))
        else:  # the levels have the factor sqrt(p)
            ways = np.nan_to_num([upper / 2, -lower / 2], posinf=0.0)

        def of(adjoint):
            return ways @ adjoint.by_levels()

    def parts(z):
        found = of(Adjoint(grid, z, lower, upper))
        return found if problem.is_split else np.array([found.sum()])

    return parts


def _change(scene, parameter):
    observable = vectorised(derivative(scene, scene.observable_expression, parameter), (y,))
    diffusion = 2 / scene.noise.sigma if parameter == "sigma" else 0.0
    return Change(change_of_depth(scene, parameter), observable, diffusion)
