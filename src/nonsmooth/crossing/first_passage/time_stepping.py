"""First passage of int_0^t g for two state variables at early times, by steps in time.

The probability q(t, x, Z) that x + int_0^t g stays inside of the interval until t, if the state
begins at Z, solves q_t = A q + g q_x with q = 1 at t = 0 and q = 0 where the flow leaves. Strang's
splitting alternates exp(A t), a dense matrix on the grid of the state, and the transport by g, a
small matrix for each value of g on discontinuous elements in x, which are graded towards the
thresholds. Within a few relaxation times after the start this is better than the Laplace transform,
which grows off the axis then and makes much of small errors; later it would take too many steps.

For odd g and drift, q of an interval at (x, Z) is q of its mirror image at (-x, -Z). So even and
odd functions of Z are known from half of the grid of the state, if an interval that is not its own
mirror image is solved together with it.
"""

import math
from collections.abc import Callable

import numpy as np
import scipy.linalg
from scipy.interpolate import CubicSpline

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.plane import PlaneProblem
from nonsmooth.grids.elements import discontinuous
from nonsmooth.grids.grading import graded, split
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates
from nonsmooth.linear_algebra import dense


class UnstableError(Exception):
    """A grid whose generator is far from dissipative, so that the solution grows."""


def stepped(problem: PlaneProblem, times: np.ndarray) -> Callable[[tuple], np.ndarray]:
    """Prepare the steps.

    Parameters
    ----------
    problem : PlaneProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.

    Returns
    -------
    callable
        Takes the resolutions of the grid, driven and other variable, of x and of time; returns
        probability and survival probability, shape (2, k). Raises `UnstableError` if the solution
        grows.
    """
    settings, damping, last = tuning.TIME_STEPPING, problem.scene.damping, times[-1]
    duration = problem.mean_duration()
    if problem.largest_probability(last) < tuning.PLANE.least_probability:
        nothing = np.array([0.0 * times, 1.0 + 0.0 * times])
        return lambda resolution: nothing

    def solve(resolution):
        driven, other, fine, short = resolution
        grid, step = problem.grid(driven, other, tuning.STEPPED_GRIDS), settings.steps[short]
        spread = grid.way * damping * min(last, math.sqrt(settings.slow * last / damping))
        degree, finest, widest = settings.elements[fine]
        interval = _Interval(
            problem.lower,
            problem.upper,
            degree,
            finest * min(grid.way, -problem.lower, problem.upper),
            widest,
            settings.reached / math.sqrt(step) * spread,
        )
        first = step * settings.first * min(duration, settings.early / damping)
        at, values = _survival(grid, interval, first, step * settings.longest / damping, last)
        found = CubicSpline(at, values)(times)
        return np.array([1 - found, found])

    return solve


class _Interval:
    """Elements in x: of an interval, and of its mirror image unless they are the same.

    Parameters
    ----------
    lower, upper : float
    degree : int
        Polynomial degree.
    finest : float
        Smallest element, next to a threshold.
    widest : float
        Largest element within the interval, over the distance of a threshold.
    reach : float
        Where the elements end if there is no threshold.

    Attributes
    ----------
    slopes : dict
        Derivative for each sign of g, upwinded: values at a face are taken from where g points.
    row : numpy.ndarray, shape (k,)
        Interpolates at x = 0 from the upper half of the nodes.
    """

    def __init__(
        self, lower: float, upper: float, degree: int, finest: float, widest: float, reach: float
    ):
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
        row = axis.interpolation(0.0).toarray()[0, inner]
        if lower == -upper:
            self.slopes = {1: forward, -1: backward}
            self.row = row[len(row) // 2 :]
        else:
            self.slopes = {
                1: scipy.linalg.block_diag(-backward[::-1, ::-1], forward),
                -1: scipy.linalg.block_diag(-forward[::-1, ::-1], backward),
            }
            self.row = row


def _towards(wall, finest, widest, reach, other):
    """Edges beyond 0 up to a threshold, or up to where paths hardly get if there is none."""
    ratio = tuning.TIME_STEPPING.ratio
    if math.isfinite(wall):
        edges = np.append(wall - graded(wall, finest, ratio), wall)
        return split(edges, np.ceil(np.diff(edges) / (widest * wall)).astype(int))[1:]
    return graded(max(reach, other), other / 2, ratio)[::-1]


class _SplitStep:
    """The two factors of Strang's splitting, for a step whose length can be doubled."""

    def __init__(self, grid: PlaneOrdinates, interval: _Interval, step: float):
        self.step = step
        self.many = len(grid.speeds)
        with np.errstate(over="ignore", invalid="ignore"):  # is found to be unstable
            self.mixing = {
                parity: dense.exponential(step * grid.generator[parity].toarray())
                for parity in (EVEN, ODD)
            }
        speeds, self._which = np.unique(
            np.round(grid.speeds / np.max(np.abs(grid.speeds)), 12), return_inverse=True
        )
        speeds = speeds * np.max(np.abs(grid.speeds))
        self.flows = [
            dense.exponential(step / 2 * g * interval.slopes[1 if g > 0 else -1]).T for g in speeds
        ]

    def doubled(self):
        """Make the step twice as long."""
        self.step *= 2
        self.mixing = {parity: matrix @ matrix for parity, matrix in self.mixing.items()}
        self.flows = [matrix @ matrix for matrix in self.flows]

    def apply(self, even, odd):
        """Advance q by a step; its even and odd parts in the state are given for x > 0."""
        even, odd = self._flow(even, odd)
        return self._flow(self.mixing[EVEN] @ even, self.mixing[ODD] @ odd)

    def _flow(self, even, odd):
        """Transport by g for half a step, at the nodes that move."""
        half, moving = even.shape[1], slice(self.many)
        sum_, difference = even[moving] + odd[moving], even[moving] - odd[moving]
        values = np.hstack([difference[:, ::-1], sum_])
        for k, flow in enumerate(self.flows):
            here = self._which == k
            values[here] = values[here] @ flow
        difference, sum_ = values[:, :half][:, ::-1], values[:, half:]
        even[moving], odd[moving] = (sum_ + difference) / 2, (sum_ - difference) / 2
        return even, odd


def _survival(grid, interval, first, longest, last):
    """Survival probability from the start at times from 0 to `last`."""
    settings = tuning.TIME_STEPPING
    even = np.outer(grid.ones, np.ones(len(interval.row)))
    odd = np.zeros((grid.generator[ODD].shape[0], len(interval.row)))
    step = _SplitStep(grid, interval, first)
    times, values = [0.0], [1.0]
    while times[-1] < last:
        if times[-1] >= settings.per_length * step.step and 2 * step.step <= longest:
            step.doubled()
        even, odd = step.apply(even, odd)
        times.append(times[-1] + step.step)
        values.append(
            grid.start[EVEN] @ (even @ interval.row) + grid.start[ODD] @ (odd @ interval.row)
        )
        if not -settings.unstable < values[-1] < 1 + settings.unstable:
            raise UnstableError(f"a survival probability of {values[-1]:g}")
    return np.array(times), np.array(values)
