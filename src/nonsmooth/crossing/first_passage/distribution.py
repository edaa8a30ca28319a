"""Distribution of the first time at which int_0^t g leaves an interval.

Its Laplace transform, of `first_passage_line` for one state variable and of `first_passage_plane`
for two, is inverted, or its survival probability marched in time; from a start far in the tails, a
normal flight comes before. Two levels of resolution give the error.
"""

from functools import partial

import numpy as np

from nonsmooth.crossing.first_passage import plane, time_stepping
from nonsmooth.crossing.first_passage.inversion import by_contours
from nonsmooth.crossing.first_passage.line import Late, Line
from nonsmooth.crossing.first_passage.time_stepping import UnstableError
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.kinetic import tail_descent
from nonsmooth.line.potential import depth

# of the decay per relaxation time of a slow crossing, as measured against the second order formula;
# without symmetry the slow mode is not apart
_ROUNDING = {True: 1e-14, False: 1e-13}
_SAFETY = {True: 1.0, False: 3.0}  # without symmetry levels do not converge regularly
_TAIL = 16.0  # depth of a start beyond which the modes lose digits
_UNDERFLOW = 1e-300
_NEGLECTED = 1e-9  # bound of what is left out of the law of a far start


def deterministic_crossing(scene, lower, upper, times, tol):
    """P(int_0^t g leaves (lower, upper) before t).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise, or one to which `first_passage_plane` applies.
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
        If `tol` is not met; the message has the error.
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
    except (np.linalg.LinAlgError, RuntimeError) as error:  # of dense and of sparse matrices
        raise ToleranceError(
            f"the modes of the transport equation are not finite, as where g has a pole ({error}); "
            "use method='monte_carlo'"
        ) from None


def default_tolerance(scene):
    """Return the absolute error of `deterministic_crossing` unless told; None if it cannot."""
    if scene.is_line:
        return Line.tol
    return plane.Plane.tol if plane.applies(scene) else None


def _on_line(scene, lower, upper, times, tol):
    """`deterministic_crossing` for the state y with white noise."""
    if _start_depth(scene) > _TAIL:
        return _from_afar(scene, lower, upper, times, tol)
    problem = Line(scene, lower, upper)
    return _refined(problem, times, tol, by_contours(problem, times))


def _in_plane(scene, lower, upper, times, tol):
    """`deterministic_crossing` for two state variables."""
    problem = plane.Plane(scene, lower, upper)
    if time_stepping.applies(problem, times):
        marched = time_stepping.March(scene, lower, upper)
        try:
            return _refined(marched, times, tol, partial(_marched, marched, times))
        except UnstableError:  # slabs are not
            pass
    return _refined(problem, times, tol, by_contours(problem, times))


def _from_afar(scene, lower, upper, times, tol):
    """`_on_line` from a start in the tail: normal at first, then by `Late`."""
    tail = tail_descent.tail(scene)
    distance = upper if tail.towards > 0 else -lower
    passed = np.array([tail.law(t).passed(distance) for t in np.minimum(times, tail.flight)])
    error = np.full(len(times), _NEGLECTED)
    late = times > tail.flight
    if late.any() and 1 - tail.law(tail.flight).passed(distance) > _NEGLECTED:
        left = 1 - tail.law(tail.descent).passed(distance)
        problem = Late(scene, lower, upper, tail)
        # a level may no more than halve the error
        rest = times[late] - tail.descent
        found = _refined(problem, rest, tol / (2 * left), by_contours(problem, rest))
        passed[late] = 1 - left * found["survival"]
        error[late] += 2 * left * found["probability_error"]
    return {
        "probability": passed,
        "probability_error": error,
        "survival": 1 - passed,
        "survival_error": error,
    }


def _marched(problem, times, level, _known, _wanted):
    return problem.solve(times, *level), np.full(len(times), True)


def _refined(problem, times, tol, solve):
    """Refine until two levels agree.

    `solve` takes a level, what is known, and the times at which more is wanted; it returns what is
    known then and where it has been solved anew.
    """
    worst = np.inf
    first = 0 if tol >= problem.loose else 1
    wanted, change = np.full(len(times), True), 0.0
    nothing = np.array([np.zeros(len(times)), np.ones(len(times))])
    found, _ = solve(problem.levels[first], nothing, wanted)
    odd = problem.scene.is_odd()
    for level in problem.levels[first + 1 :]:
        coarse, (found, solved) = found, solve(level, found, wanted)
        solution = np.clip(found, 0.0, 1.0)
        # not clipped before: two contours that both fail would agree on 0 or 1
        new = _SAFETY[odd] * np.abs(found - coarse) + np.abs(found - solution)
        change = np.where(solved, new, change)
        error = _largest_nearby(change, solution if problem.relative else 1 + 0 * change, times)
        error += problem.inexact * solution + _UNDERFLOW
        error += _ROUNDING[odd] * problem.scene.damping * times * solution[0] * solution[1]
        error[0] = np.where(solution[0] == 0, np.maximum(problem.negligible, error[0]), error[0])
        # the same event: what is known of the rarer of the two is known of both
        least = error.min(axis=0)
        error = np.where(error > 1e-12, least + 1e-15, error)
        if np.all(error <= tol):
            return {
                "probability": solution[0],
                "probability_error": error[0],
                "survival": solution[1],
                "survival_error": error[1],
            }
        if not error.max() < worst:  # rounding: finer grids do not help
            break
        worst = error.max()
        wanted = np.any(error > tol, axis=0)
    raise ToleranceError(
        f"the crossing probability has an error of {error.max():.1e}, above tol = {tol:g}; "
        f"{problem.cure}"
    )


def _start_depth(scene):
    """Logarithm of the largest invariant density over that at the start."""
    return float(depth(scene)(scene.start.get("y", 0.0)))


def _largest_nearby(errors, values, times):
    """Largest error within a factor of two in time, for single ones may vanish by chance.

    Those of larger values count relative to the value.
    """
    near = np.abs(np.log(times[:, None] / times)) <= np.log(2)
    values = np.maximum(values, _UNDERFLOW)
    share = np.minimum(values[:, :, None] / values[:, None, :], 1.0)
    return np.max(near * share * errors[:, None, :], axis=2)
