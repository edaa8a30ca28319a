"""First passage of int_0^t g for two state variables at early times, by steps in time.

The probability q(t, x, Z) that x + int_0^t g stays inside of the interval until t, if the state
begins at Z, solves q_t = A q + g q_x with q = 1 at t = 0 and q = 0 where the flow leaves. Strang's
splitting (`kinetic.marching`) alternates exp(A t) and the transport by g, a small matrix for each
value of g on discontinuous elements in x, which are graded towards the thresholds. Within a few
relaxation times after the start this is better than the Laplace transform, which grows off the axis
then and makes much of small errors; later it would take too many steps.
"""

import math
from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicSpline

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.plane import PlaneProblem
from nonsmooth.grids.elements import discontinuous
from nonsmooth.grids.grading import graded, split
from nonsmooth.kinetic.marching.coefficients import CoefficientSteps
from nonsmooth.kinetic.marching.split_step import IMAGINARY, Interval
from nonsmooth.kinetic.marching.tensor import TensorSteps
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates, UnstableError
from nonsmooth.linear_algebra.effort import spend


def stepped(
    problem: PlaneProblem, times: np.ndarray, moves: tuple[float, float] = (0.0, 0.0)
) -> Callable[..., np.ndarray]:
    """Prepare the steps.

    Parameters
    ----------
    problem : PlaneProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    moves : tuple of float
        Derivatives of the distances of the lower and of the upper level from 0, for the imaginary
        part; 0 for an infinite one.

    Returns
    -------
    callable
        Takes the resolutions of the grid, driven and other variable, of x and of time, and how many
        times are wanted, None for all; returns probability and survival probability at the first of
        them, shape (2, m); their derivatives times `IMAGINARY` are the imaginary parts, see
        `split_step`. Raises `UnstableError` if the solution grows.
    """
    settings, damping, last = tuning.TIME_STEPPING, problem.scene.damping, times[-1]
    duration, way = problem.mean_duration(), problem.grids.way
    stretch, shift = _stretched(problem.levels, moves)
    spread = way * damping * min(last, math.sqrt(settings.slow * last / damping))
    if problem.largest_probability(last) < tuning.PLANE.least_probability:
        nothing = np.array([0.0 * times, 1.0 + 0.0 * times])
        return lambda resolution, count=None: nothing[:, :count]

    def solve(resolution, count=None):
        driven, other, fine, short = resolution
        step, (degree, finest, widest) = settings.steps[short], settings.elements[fine]
        interval = _interval(
            problem.lower,
            problem.upper,
            degree,
            finest * min(way, -problem.lower, problem.upper),
            widest,
            settings.reached / math.sqrt(min(step, 1.0)) * spread,
            shift,
        )
        first = step * settings.first * min(duration, settings.early / damping)
        if stretch:
            interval = interval.stretched(stretch)
        steps = _steps(problem.grids.stepped_grid(driven, other), interval, first)
        longest = step * settings.longest / max(damping, steps.rate)
        at, values = _survival(steps, longest, settings.per_length / step, times[:count][-1])
        found = CubicSpline(at, values)(times[:count])
        return np.array([1 - found, found])

    return solve


def _interval(lower, upper, degree, finest, widest, reach, shift):
    """Make elements in x, of a degree, graded towards the thresholds.

    `finest` and `widest` are the smallest element, next to a threshold, and the largest over the
    distance of a threshold; where there is none, the elements end at `reach`. The start moves to
    `shift`, times `IMAGINARY`.
    """
    above = _towards(upper, finest, widest, reach, -lower)
    below = _towards(-lower, finest, widest, reach, upper)
    edges = np.concatenate([-below[::-1], [0.0], above])
    # beyond a threshold q = 0: an element is put there, for upwinding, and left out again
    walls = np.isfinite([lower, upper])
    padded = np.concatenate([2 * edges[:1][walls[:1]], edges, 2 * edges[-1:][walls[1:]]])
    axis = discontinuous(padded, degree)
    first, end = (degree + 1) * walls
    inner = slice(int(first), len(axis.nodes) - int(end))
    forward, backward = (
        (axis.slope + lift @ axis.jump).toarray()[inner, inner]
        for lift in (axis.lift_left, axis.lift_right)
    )
    row = axis.interpolation(0.0)
    if shift:
        row = row + IMAGINARY * shift * (row @ axis.slope)
    row = row.toarray()[0, inner]
    return Interval(forward, backward, row, lower == -upper)


def _stretched(levels, moves):
    """Stretch of the interval about 0, and shift of the start in it, that move its levels."""
    (lower, upper), (below, above) = levels, moves
    if not np.isfinite([lower, upper]).all():
        return (above / upper if math.isfinite(upper) else -below / lower), 0.0
    stretch = (below + above) / (upper - lower)
    return stretch, below + lower * stretch


def _towards(wall, finest, widest, reach, other):
    """Edges beyond 0 up to a threshold, or up to where paths hardly get if there is none."""
    ratio = tuning.TIME_STEPPING.ratio
    if math.isfinite(wall):
        edges = np.append(wall - graded(wall, finest, ratio), wall)
        return split(edges, np.ceil(np.diff(edges) / (widest * wall)).astype(int))[1:]
    return graded(max(reach, other), other / 2, ratio)[::-1]


def _steps(grid, interval, step):
    """Choose the scheme for a grid."""
    scheme = CoefficientSteps if isinstance(grid, PlaneOrdinates) else TensorSteps
    return scheme(grid, interval, step)


def _survival(steps, longest, per_length, last):
    """Survival probability from the start at times from 0 to `last`."""
    settings = tuning.TIME_STEPPING
    times, values = [0.0], [1.0]
    steps.transport_half()
    while times[-1] < last:
        spend(steps.operations)
        steps.mix()
        times.append(times[-1] + steps.step)
        values.append(steps.survival())
        if not -settings.unstable < np.real(values[-1]) < 1 + settings.unstable:
            raise UnstableError(f"a survival probability of {np.real(values[-1]):g}")
        if times[-1] >= per_length * steps.step and 2 * steps.step <= longest:
            steps.transport_half()
            steps.doubled()
            steps.transport_half()
        else:
            steps.transport()
    return np.array(times), np.array(values)
