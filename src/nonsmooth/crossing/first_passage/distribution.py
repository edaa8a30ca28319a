"""Distribution of the first time at which int_0^t g leaves an interval, without Monte Carlo.

A scene becomes a first-passage problem: a `LineProblem` for one state variable, a `PlaneProblem`
for two. It is solved on finer and finer levels until two of them agree.
"""

import numpy as np

from nonsmooth.crossing.first_passage import plane, time_stepping, tuning
from nonsmooth.crossing.first_passage.inversion import Solver, contour_solver
from nonsmooth.crossing.first_passage.line import LineProblem, LineProblemFromAfar
from nonsmooth.crossing.first_passage.plane import PlaneProblem
from nonsmooth.crossing.first_passage.problem import (
    DirectProblem,
    FirstPassageProblem,
    LaplaceProblem,
)
from nonsmooth.crossing.first_passage.time_stepping import PlaneProblemInTime, UnstableError
from nonsmooth.errors import SceneError, ToleranceError, answered
from nonsmooth.kinetic import tail_descent
from nonsmooth.line.potential import depth
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.scene import Scene


def deterministic_crossing(
    scene: Scene, lower: float, upper: float, times: np.ndarray, tol: float | None
) -> dict[str, np.ndarray]:
    """P(int_0^t g leaves (lower, upper) before t).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise, or one to which `plane` applies.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float or None
        Absolute error wanted; 1e-7, or 1e-4 for two variables, unless given.

    Returns
    -------
    dict
        `probability`, `survival`, with their errors.

    Raises
    ------
    SceneError
        If the scene is of another kind.
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    if scene.is_line:
        solve = _on_line
    elif plane.applies(scene):
        solve = _in_plane
    else:
        raise SceneError(
            "the deterministic method needs the state (y) and white noise, or two state variables "
            "with finite n, odd g and drift, and white or Langevin noise, not "
            f"({', '.join(scene.state)}) with {scene.noise.title} and n = {scene.n:g}; "
            "use method='monte_carlo'"
        )
    try:
        return solve(scene, lower, upper, times, default_tolerance(scene) if tol is None else tol)
    except (np.linalg.LinAlgError, RuntimeError) as error:  # from dense and from sparse matrices
        raise ToleranceError(
            f"the modes of the transport equation are not finite, as where g has a pole ({error}); "
            "use method='monte_carlo'"
        ) from None


def default_tolerance(scene: Scene) -> float | None:
    """Return the tolerance of `deterministic_crossing` unless given; None if it does not apply."""
    if scene.is_line:
        return tuning.LINE.default_tolerance
    return tuning.PLANE.default_tolerance if plane.applies(scene) else None


def _on_line(scene, lower, upper, times, tol):
    """Solve for the state y with white noise."""
    depth_of_start = float(depth(scene)(scene.start.get("y", 0.0)))
    if depth_of_start > tuning.FAR_START.depth:
        return _from_afar(scene, lower, upper, times, tol)
    return refined(LineProblem(scene, lower, upper), times, tol)


def _in_plane(scene, lower, upper, times, tol):
    """Solve for two state variables: by steps in time if there are few, or else by contours."""
    problem = PlaneProblem(scene, lower, upper)
    if time_stepping.applies(problem, times):
        try:
            return refined(PlaneProblemInTime(problem), times, tol)
        except UnstableError:  # slabs are stable on every grid
            pass
    return refined(problem, times, tol)


def _from_afar(scene, lower, upper, times, tol):
    """Solve for a start in the tails: early times by a normal law, later ones by a problem."""
    tail, neglected = tail_descent.tail(scene), tuning.FAR_START.neglected
    distance = upper if tail.towards > 0 else -lower
    passed = np.array([tail.law(t).passed(distance) for t in np.minimum(times, tail.flight)])
    error = np.full(len(times), neglected)
    late = times > tail.flight
    left = 1 - tail.law(tail.descent).passed(distance)

    def whole(rest):
        if rest is not None:
            passed[late] = 1 - left * rest["survival"]
            error[late] += 2 * left * rest["probability_error"]
        return {
            "probability": passed,
            "probability_error": error,
            "survival": 1 - passed,
            "survival_error": error,
        }

    if not late.any() or 1 - tail.law(tail.flight).passed(distance) <= neglected:
        return whole(None)
    problem = LineProblemFromAfar(scene, lower, upper, tail)
    # half of the tolerance is kept for what is neglected
    return answered(lambda: refined(problem, times[late] - tail.descent, tol / (2 * left)), whole)


def refined(problem: FirstPassageProblem, times: np.ndarray, tol: float) -> dict[str, np.ndarray]:
    """Solve a problem on finer and finer levels until two of them agree.

    Parameters
    ----------
    problem : FirstPassageProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float
        Absolute error wanted.

    Returns
    -------
    dict
        As for `deterministic_crossing`.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    settings, refinement = problem.settings, _Refinement(problem, times, tol)
    result = until_agreement(
        settings.levels[0 if tol >= settings.coarse_tolerance else 1 :],
        refinement.solution,
        refinement.error,
        refinement.met,
        refinement.hopeless,
    )
    solution = np.clip(result.value[0], 0.0, 1.0)
    found = {
        "probability": solution[0],
        "probability_error": result.error[0],
        "survival": solution[1],
        "survival_error": result.error[1],
    }
    if not result.met:
        worst = int(np.argmax(result.error.max(axis=0)))
        raise ToleranceError(
            f"W = {solution[0, worst]:.7g} at t = {times[worst]:g} has an error of "
            f"{result.error.max():.1e}, above tol = "
            f"{tol:g}; {settings.advice}",
            found,
        )
    return found


def _solver(problem: FirstPassageProblem, times: np.ndarray) -> Solver:
    """Return the function that solves a problem on a level; see `inversion.contour_solver`."""
    if isinstance(problem, LaplaceProblem):
        return contour_solver(problem, times)
    assert isinstance(problem, DirectProblem)
    everywhere = np.full(len(times), True)
    return lambda level, known, wanted: (problem.solve(times, level), everywhere)


class _Refinement:
    """Solutions on finer and finer levels, computed anew only at times that need it.

    A solution is a pair: the values, shape (2, k), and at which times they are new.
    """

    def __init__(self, problem: FirstPassageProblem, times: np.ndarray, tol: float):
        self.problem, self.times, self.tol = problem, times, tol
        self._solve = _solver(problem, times)
        self._found = np.array([np.zeros(len(times)), np.ones(len(times))])
        self._wanted = np.full(len(times), True)
        self._change: float | np.ndarray = 0.0
        self._worst = np.inf

    def solution(self, level):
        """Solve on a level."""
        self._found, solved = self._solve(level, self._found, self._wanted)
        return self._found, solved

    def error(self, solutions):
        """Estimate the errors of the last solution from the difference to the one before."""
        settings, refinement = self.problem.settings, tuning.REFINEMENT
        odd = self.problem.scene.is_odd()
        safety, rounding = (
            (refinement.safety_odd, refinement.rounding_odd)
            if odd
            else (refinement.safety, refinement.rounding)
        )
        (coarse, _), (found, solved) = solutions[-2:]
        solution = np.clip(found, 0.0, 1.0)
        # values are compared before they are clipped: two levels that failed may agree afterwards
        change = safety * np.abs(found - coarse) + np.abs(found - solution)
        self._change = np.where(solved, change, self._change)
        error = _largest_nearby(
            self._change, solution if settings.relative else 1 + 0 * self._change, self.times
        )
        error += settings.unseen_error * solution + refinement.underflow
        error += rounding * self.problem.scene.damping * self.times * solution[0] * solution[1]
        error[0] = np.where(
            solution[0] == 0, np.maximum(settings.least_probability, error[0]), error[0]
        )
        # the two probabilities have the sum 1: the smaller error holds for both
        least = error.min(axis=0)
        return np.where(error > refinement.exact, least + refinement.complement, error)

    def met(self, solution, error):
        """Whether the error is as small as wanted at all times."""
        return np.all(error <= self.tol)

    def hopeless(self, solution, error):
        """Whether the error no longer falls, because it is rounding.

        If it does fall, the times are noted at which a finer level is wanted.
        """
        if not error.max() < self._worst:
            return True
        self._worst = error.max()
        self._wanted = np.any(error > self.tol, axis=0)
        return False


def _largest_nearby(errors, values, times):
    """Take the largest error among neighbouring times, since two levels may agree by chance.

    If the value at a neighbouring time is larger, its error is reduced in proportion.
    """
    refinement = tuning.REFINEMENT
    near = np.abs(np.log(times[:, None] / times)) <= np.log(refinement.nearby)
    values = np.maximum(values, refinement.underflow)
    share = np.minimum(values[:, :, None] / values[:, None, :], 1.0)
    return np.max(near * share * errors[:, None, :], axis=2)
