"""Distribution of the first time at which int_0^t g leaves an interval, without Monte Carlo.

A scene becomes a first-passage problem: a `LineProblem` for one state variable, a `PlaneProblem`
for two. It is solved on finer and finer levels until two of them agree.
"""

import math
from contextlib import suppress
from functools import cache, cached_property, partial

import numpy as np

from nonsmooth.crossing.curves import one_by_one
from nonsmooth.crossing.first_passage import plane, tuning
from nonsmooth.crossing.first_passage.each_part import refine_each_part
from nonsmooth.crossing.first_passage.inversion import Solver, contour_solver, contour_solvers
from nonsmooth.crossing.first_passage.line import Intervals, LineProblemFromAfar
from nonsmooth.crossing.first_passage.plane import PlaneProblem, SharedGrids, inverted, tame
from nonsmooth.crossing.first_passage.problem import (
    DirectProblem,
    FirstPassageProblem,
    LaplaceProblem,
)
from nonsmooth.crossing.first_passage.time_stepping import stepped
from nonsmooth.errors import SceneError, ToleranceError, answered
from nonsmooth.grids.generator import Change
from nonsmooth.kinetic import tail_descent
from nonsmooth.kinetic.ordinates_plane import UnstableError
from nonsmooth.line.potential import depth
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.scene import Scene


def deterministic_crossing(
    scene: Scene, intervals: np.ndarray, times: np.ndarray, tol: float | None
) -> dict[str, np.ndarray]:
    """P(int_0^t g leaves an interval (lower, upper) before t).

    Intervals share most of what is computed. Grids and bases then serve the most demanding of
    them, which changes a probability within its error.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise, or one to which `plane` applies.
    intervals : numpy.ndarray, shape (m, 2)
        lower < 0 < upper, one of them possibly infinite.
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float or None
        Absolute error wanted; 1e-7, or 1e-4 for two variables, unless given.

    Returns
    -------
    dict
        `probability`, `survival`, with their errors; of the shape (m, k).

    Raises
    ------
    SceneError
        If the scene is of another kind.
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    if scene.is_line:
        solvers = _on_line
    elif plane.applies(scene):
        solvers = _in_plane
    else:
        raise SceneError(
            "the deterministic method needs the state (y) and white noise, or two state variables "
            "with finite n, odd g and drift, and white or Langevin noise, not "
            f"({', '.join(scene.state)}) with {scene.noise.title} and n = {scene.n:g}; "
            "use method='monte_carlo'"
        )
    tol = default_tolerance(scene) if tol is None else tol
    try:
        # on coarse grids of extreme scenes; the error tells what comes of it
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            return one_by_one(solvers(scene, intervals, times, tol))
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


def _on_line(scene, intervals, times, tol):
    """Return what solves each interval, for the state y with white noise."""
    depth_of_start = float(depth(scene)(scene.start.get("y", 0.0)))
    if depth_of_start > tuning.FAR_START.depth:
        return [partial(_from_afar, scene, *interval, times, tol) for interval in intervals]
    solvers = {}
    nearest = np.min(np.abs(intervals), axis=1)
    for group in _of_similar_size(nearest, tuning.LINE_GRIDS.similar):
        problems = Intervals(scene, intervals[group]).problems
        together = contour_solvers(problems, times, tol)
        for k, problem, solver in zip(group, problems, together, strict=True):
            solvers[k] = partial(refined, problem, times, tol, solver)
    return [solvers[k] for k in range(len(intervals))]


def _of_similar_size(sizes, ratio):
    """Group indices so that the largest size of a group is at most `ratio` times the smallest."""
    order = np.argsort(sizes)
    groups = [[order[0]]]
    for k in order[1:]:
        if sizes[k] <= ratio * sizes[groups[-1][0]]:
            groups[-1].append(k)
        else:
            groups.append([k])
    return groups


def _in_plane(scene, intervals, times, tol):
    """Return what solves each interval, for two state variables."""
    solvers, lengths = {}, intervals[:, 1] - intervals[:, 0]
    nearest = np.abs(intervals).min(axis=1)
    sizes = np.where(np.isfinite(lengths), lengths, nearest)
    for group in _of_similar_size(sizes, tuning.PLANE_TRANSFORM.similar):
        together = Together(scene, intervals[group], times)
        for row, k in enumerate(group):
            solvers[k] = partial(_one_in_plane, together, row, tol)
    return [solvers[k] for k in range(len(intervals))]


class Together:
    """Intervals of two state variables that share grids and contours.

    Parameters
    ----------
    scene : Scene
    intervals : numpy.ndarray, shape (m, 2)
    times : numpy.ndarray, shape (k,)
    change : Change, optional
        As for `SharedGrids`.

    Attributes
    ----------
    scene, intervals, times
    grids : callable
        Takes a tuple of times; returns `SharedGrids`, the same for the same times.
    """

    def __init__(
        self,
        scene: Scene,
        intervals: np.ndarray,
        times: np.ndarray,
        change: Change | None = None,
    ):
        self.scene, self.intervals, self.times = scene, intervals, times
        self.grids = cache(lambda times: SharedGrids(scene, intervals, np.array(times), change))

    def problem(self, row: int, times: np.ndarray) -> PlaneProblem:
        """Return the problem of an interval."""
        lower, upper = self.intervals[row]
        return PlaneProblem(self.scene, lower, upper, times, self.grids(tuple(times)))

    @cached_property
    def early(self) -> np.ndarray:
        """Which times are served by steps, shape (m, k).

        Contours are better once they may bend, unless the interval is narrow. One that has one
        level is as narrow as that level and its mirror image make it.
        """
        settings, lengths = tuning.TIME_STEPPING, self.intervals[:, 1] - self.intervals[:, 0]
        mirrored = 2 * np.min(np.abs(self.intervals), axis=1)
        lengths = np.where(np.isinf(lengths), mirrored, lengths)
        early = np.tile(self.times * self.scene.damping <= settings.until, (len(lengths), 1))
        if early.any():
            way = self.grids(tuple(self.times)).way
            for row in np.flatnonzero(lengths >= settings.narrow * way).tolist():
                with suppress(ToleranceError):  # its own solution tells
                    early[row] &= ~tame(self.problem(row, self.times), self.times)
        return early

    @cached_property
    def near(self) -> np.ndarray:
        """Whether the last time is near enough to `early` ones for steps to go on, shape (m,)."""
        settings, last = tuning.TIME_STEPPING, self.times[-1]
        stepped = np.max(self.early * self.times, axis=1)
        return (last <= settings.latest / self.scene.damping) & (last <= settings.near * stepped)

    @cached_property
    def later(self) -> np.ndarray:
        """Times at which contours serve some interval, shape (k,)."""
        return np.any(~self.early, axis=0)

    def inverted(self, problem: PlaneProblem, times: np.ndarray, tol: float):
        """Prepare contours for the times that are `later`, on which steps do not serve all."""
        levels = map(tuple, self.intervals.tolist())
        wanted = dict(zip(levels, ~self.early[:, self.later], strict=True))
        return inverted(problem, times, tol, wanted)


def _one_in_plane(together, row, tol):
    """Solve for two state variables: some early times by steps, the others by contours.

    Steps go on to the last time if this is near. Where contours miss the tolerance, steps are
    tried, and contours once more for the times that are left. If steps may do for all times, each
    of both gives way to the other, before they go on to very fine grids. There, steps are not
    accurate for a displacement that yields.
    """
    times = together.times
    solution, error = np.zeros((2, len(times))), np.full((2, len(times)), np.inf)
    advice = "use method='monte_carlo'"
    reasons = [f"the solution is not finite; {advice}"]

    def solve(here, solver, parts=None, at=None, most=math.inf):
        """Solve at some of the times; keep what has a smaller error than what is known.

        `parts` are those of contours unless given; `at` has the times of all intervals, if more
        than those of this one; `most` is how often errors are measured.
        """
        if not here.any():
            return
        at = here if at is None else at
        problem = together.problem(row, times[at])
        try:
            refined = parts or problem.resolutions
            found, stated = _part_by_part(problem, times[at], refined, solver, tol, most)
        except UnstableError as unstable:
            reasons.append(f"{unstable}; {advice}")
            return
        except ToleranceError as refused:
            reasons.append(str(refused))
            return
        better = here[at] & (stated.max(axis=0) < error[:, at].max(axis=0))
        chosen = np.flatnonzero(at)[better]
        solution[:, chosen], error[:, chosen] = found[:, better], stated[:, better]

    whole = together.problem(row, times)
    early, late = together.early[row], times * whole.scene.damping > tuning.TIME_STEPPING.latest
    by_steps, tried = (stepped, tuning.STEPPED_PARTS), together.near[row]
    by_contours = partial(inverted, tol=tol)
    solve(early | tried, *by_steps)
    steps_may_do = not (tried or late.any() or np.any(error[:, early] > tol))
    rounds = tuning.EACH_PART.tried if steps_may_do else math.inf
    if np.any(error[:, ~early] > tol):
        of_later = partial(together.inverted, tol=tol)
        solve(~early, of_later, at=together.later, most=rounds)
    solve(early & np.isinf(error[0]), by_contours)  # they are stable on more grids than steps
    missed = np.any(error > tol, axis=0)
    if not missed[early].any():
        solve(missed & ~late & ~tried, *by_steps, most=rounds)
        missed = np.any(error > tol, axis=0)
        if steps_may_do or np.sum(missed & late) < np.sum(~early):  # without those that are worst
            solve(missed & (late | steps_may_do), by_contours)
            missed = np.any(error > tol, axis=0)
        if steps_may_do and not whole.scene.mechanics.is_plastic:
            solve(missed, *by_steps)
    if np.isinf(error).any():
        raise ToleranceError(reasons[-1])
    return _answer(whole, times, solution, error, tol)


def _part_by_part(problem, times, parts, solver, tol, most):
    """Refine each part of the resolution by itself; return the solution and its error."""

    def stated(found):
        solution = np.clip(found.value, 0.0, 1.0)
        change = np.minimum(found.change + np.abs(found.value - solution), 1.0)
        return solution, _with_floors(problem, times, solution, change)

    found = refine_each_part(
        parts,
        solver(problem, times),
        lambda found: np.all(stated(found)[1] <= tol, axis=0),
        tol,
        most,
    )
    return stated(found)


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


def refined(
    problem: FirstPassageProblem, times: np.ndarray, tol: float, solver: Solver | None = None
) -> dict[str, np.ndarray]:
    """Solve a problem on finer and finer levels until two of them agree.

    Parameters
    ----------
    problem : FirstPassageProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float
        Absolute error wanted.
    solver : callable, optional
        Of `contour_solvers`, if the problem shares what it computes with others.

    Returns
    -------
    dict
        `probability`, `survival`, with their errors, shape (k,).

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    settings, solver = problem.settings, solver or _solver(problem, times, tol)
    refinement = _Refinement(problem, times, tol, solver)
    result = until_agreement(
        settings.levels[0 if tol >= settings.coarse_tolerance else 1 :],
        refinement.solution,
        refinement.error,
        refinement.met,
        refinement.hopeless,
    )
    solution = np.clip(result.value[0], 0.0, 1.0)
    return _answer(problem, times, solution, result.error, tol)


def _answer(problem, times, solution, error, tol):
    """Return what was found, or raise an error with it."""
    error = np.minimum(error, 1.0)
    found = {
        "probability": solution[0],
        "probability_error": error[0],
        "survival": solution[1],
        "survival_error": error[1],
    }
    if np.all(error <= tol):
        return found
    worst = int(np.argmax(error.max(axis=0)))
    raise ToleranceError(
        f"W = {solution[0, worst]:.7g} at t = {times[worst]:g} has an error of {error.max():.1e}, "
        f"above tol = {tol:g}; {problem.settings.advice}",
        found,
    )


def _solver(problem: FirstPassageProblem, times: np.ndarray, tol: float) -> Solver:
    """Return the function that solves a problem on a level; see `inversion.contour_solver`."""
    if isinstance(problem, LaplaceProblem):
        return contour_solver(problem, times, tol)
    assert isinstance(problem, DirectProblem)
    everywhere = np.full(len(times), True)
    return lambda level, known, wanted: (problem.solve(times, level), everywhere, 0.0 * times)


class _Refinement:
    """Solutions on finer and finer levels, computed anew only at times that need it.

    A solution is what a `Solver` returns.
    """

    def __init__(self, problem: FirstPassageProblem, times: np.ndarray, tol: float, solver: Solver):
        self.problem, self.times, self.tol = problem, times, tol
        self._solve = solver
        self._found = np.array([np.zeros(len(times)), np.ones(len(times))])
        self._wanted = np.full(len(times), True)
        self._change: float | np.ndarray = 0.0
        self._worst = np.inf

    def solution(self, level):
        """Solve on a level."""
        self._found, *more = self._solve(level, self._found, self._wanted)
        return self._found, *more

    def error(self, solutions):
        """Estimate the errors of the last solution from the difference to the one before."""
        refinement = tuning.REFINEMENT
        (coarse, *_), (found, solved, inexact) = solutions[-2:]
        solution = np.clip(found, 0.0, 1.0)
        # values are compared before they are clipped: two levels that failed may agree afterwards
        change = refinement.safety * np.abs(found - coarse) + np.abs(found - solution)
        change += refinement.by_chance * self.tol * solution + inexact
        self._change = np.where(solved, change, self._change)
        return _with_floors(self.problem, self.times, solution, self._change)

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


def _with_floors(problem, times, solution, change):
    """Errors from the changes between resolutions, and what no such change shows."""
    settings, refinement = problem.settings, tuning.REFINEMENT
    error = _largest_nearby(change, solution if settings.relative else 1 + 0 * change, times)
    error += settings.unseen_error * solution + refinement.underflow
    rounding = refinement.rounding_odd if problem.scene.is_odd() else refinement.rounding
    error += rounding * problem.scene.damping * times * solution[0] * solution[1]
    error[0] = np.where(
        solution[0] == 0, np.maximum(settings.least_probability, error[0]), error[0]
    )
    # the two probabilities have the sum 1: the smaller error holds for both
    least = error.min(axis=0)
    return np.where(error > refinement.exact, least + refinement.complement, error)


def _largest_nearby(errors, values, times):
    """Take the largest error among neighbouring times, since two levels may agree by chance.

    If the value at a neighbouring time is larger, its error is reduced in proportion.
    """
    refinement = tuning.REFINEMENT
    near = np.abs(np.log(times[:, None] / times)) <= np.log(refinement.nearby)
    values = np.maximum(values, refinement.underflow)
    share = np.minimum(values[:, :, None] / values[:, None, :], 1.0)
    return np.max(near * share * errors[:, None, :], axis=2)
