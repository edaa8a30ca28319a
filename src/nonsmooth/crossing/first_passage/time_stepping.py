"""First passage of x' = g out of an interval for two state variables, marched in time.

The probability q(t, x, s) that x stays inside until t, from a state s, solves q_t = A q + g q_x,
q(0) = 1, q = 0 where the flow leaves. Strang's splitting: exp(A t) is a dense matrix on the grid of
the state, and the flow at the speed g a small one on discontinuous elements in x, graded to the
walls. Where crossings take a few relaxation times, this is much faster than the Laplace transform,
which grows off the axis there; over many of them it takes too many steps.

With odd g and drift q(x, s) of an interval is q(-x, -s) of its mirror image. Even and odd functions
of s are those of half of the grid; an interval that is not its own image is marched with it.
"""

import math

import numpy as np
import scipy.linalg
from scipy.interpolate import CubicSpline

from nonsmooth.crossing.first_passage.plane import Plane
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.elements import discontinuous
from nonsmooth.grids.grading import graded
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import ordinates_gibbs
from nonsmooth.kinetic.ordinates_gibbs import gibbs_ordinates
from nonsmooth.kinetic.ordinates_plane import plane_ordinates

# resolution of the state; degree in x, and its smallest element over the lesser of the distance and
# of the way that g goes while it relaxes; steps, relative to the longest
_LEVELS = ((1, 3, 2e-2, 1.4), (4, 4, 1e-2, 1.0), (5, 4, 5e-3, 0.7), (6, 4, 2.5e-3, 0.5))
_RATIO = 2.0  # of neighbouring elements in x
_LONGEST = 0.1  # step, in relaxation times of the damping
_FIRST, _EARLY = 5e-3, 4.0  # first step over the mean duration, which is cut at relaxation times
_PER_TIME = 100.0  # steps are doubled when that many have been made
_REACHED = 6.0  # end of the axis where there is no wall, in standard deviations
_SLOW = 8.0  # the spread of int g is that of a correlation time of half so many relaxation times
_GONE = 1e-6  # survival that is taken as 0
_SHORT = 500.0  # relaxation times that are marched
_TAIL = 15.0  # mean durations after which nothing is left, but in rare cases
_MOST = 20_000  # steps
# Beyond [0, 1] by so much, the solution grows; by less, elements overshoot where a front passes
_UNSTABLE = 1e-3


class UnstableError(Exception):
    """A grid whose generator is far from dissipative, so that the solution grows."""


def applies(problem, times):
    """Whether all is over, or the last time reached, within some hundred relaxation times.

    Parameters
    ----------
    problem : Plane
    times : numpy.ndarray

    Returns
    -------
    bool
    """
    end = min(times[-1], _TAIL * _duration(problem, times[-1]))
    return end * problem.scene.damping <= _SHORT


def _duration(problem, time):
    """Mean of the lesser of the first passage and of about `time`."""
    z = 1 / time
    return max((1 - problem.near_axis(z, None)(z)) / z, 1e-6 * time)


class March(Plane):
    """As `first_passage_plane.Plane`, solved in time.

    Parameters
    ----------
    scene, lower, upper
        As of `Plane`.
    """

    levels, loose = _LEVELS, 1e-3
    inexact = 2e-5  # the same, and what levels that refine one variable leave of the other

    def solve(self, times, resolution, degree, finest, shorter):
        """Probability and survival probability on one grid.

        Parameters
        ----------
        times : numpy.ndarray, shape (k,)
        resolution, degree, finest, shorter
            An entry of `levels`.

        Returns
        -------
        numpy.ndarray, shape (2, k)

        Raises
        ------
        ToleranceError
            If it takes too many steps.
        """
        damping, last = self.scene.damping, times[-1]
        duration = _duration(self, last)
        scale = min(duration, 1 / damping)
        if ordinates_gibbs.applies(self.scene):
            grid = gibbs_ordinates(self.scene, self._ends, resolution)
        else:
            grid = plane_ordinates(self.scene, self._ends, resolution, scale)
        spread = grid.way * damping * min(last, math.sqrt(_SLOW * last / damping))
        line = _Line(
            self.lower,
            self.upper,
            degree,
            finest * min(grid.way, -self.lower, self.upper),
            _REACHED / math.sqrt(shorter) * spread,
        )
        first = shorter * _FIRST * min(duration, _EARLY / damping)
        at, values = _march(grid, line, first, shorter * _LONGEST / damping, last)
        found = np.interp(times, [at[-1]], values[-1:])
        inside = times <= at[-1]
        found[inside] = CubicSpline(at, values)(times[inside])
        return np.clip([1 - found, found], 0.0, 1.0)


class _Line:
    """Elements in x, of an interval and of its mirror image unless they are the same.

    Attributes
    ----------
    slopes : dict
        Derivative for each sign of g, taken from where the flow goes.
    row : numpy.ndarray, shape (k,)
        Interpolates at x = 0 from the upper half of the nodes.
    """

    def __init__(self, lower, upper, degree, finest, reach):
        above = _towards(upper, finest, reach, -lower)
        below = _towards(-lower, finest, reach, upper)
        edges = np.concatenate([-below[::-1], [0.0], above])
        # beyond a wall q = 0: an element there that is left out again
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


def _towards(wall, finest, reach, other):
    """Edges from 0, left out, to a wall; if there is none, as far as anything returns from."""
    if math.isfinite(wall):
        return np.append(wall - graded(wall, finest, _RATIO)[1:], wall)
    return graded(max(reach, other), other / 2, _RATIO)[::-1]


class _Steps:
    """The two factors of a step of given length, which can be doubled."""

    def __init__(self, grid, line, step):
        self.step = step
        self.many = len(grid.speeds)
        self.mixing = {
            parity: scipy.linalg.expm(step * grid.generator[parity].toarray())
            for parity in (EVEN, ODD)
        }
        speeds, self._which = np.unique(
            np.round(grid.speeds / np.max(np.abs(grid.speeds)), 12), return_inverse=True
        )
        speeds = speeds * np.max(np.abs(grid.speeds))
        self.flows = [
            scipy.linalg.expm(step / 2 * g * line.slopes[1 if g > 0 else -1]).T for g in speeds
        ]

    def doubled(self):
        """Make the step twice as long."""
        self.step *= 2
        self.mixing = {parity: matrix @ matrix for parity, matrix in self.mixing.items()}
        self.flows = [matrix @ matrix for matrix in self.flows]

    def apply(self, even, odd):
        """Advance q, of which `even` and `odd` in the state are known for the upper half in x."""
        even, odd = self._flow(even, odd)
        return self._flow(self.mixing[EVEN] @ even, self.mixing[ODD] @ odd)

    def _flow(self, even, odd):
        half, moving = even.shape[1], slice(self.many)
        sum_, difference = even[moving] + odd[moving], even[moving] - odd[moving]
        values = np.hstack([difference[:, ::-1], sum_])
        for k, flow in enumerate(self.flows):
            here = self._which == k
            values[here] = values[here] @ flow
        difference, sum_ = values[:, :half][:, ::-1], values[:, half:]
        even[moving], odd[moving] = (sum_ + difference) / 2, (sum_ - difference) / 2
        return even, odd


def _march(grid, line, first, longest, last):
    """Survival probability from the start at times from 0 to `last`, or until it is 0."""
    even = np.outer(grid.ones, np.ones(len(line.row)))
    odd = np.zeros((grid.generator[ODD].shape[0], len(line.row)))
    steps = _Steps(grid, line, first)
    times, values = [0.0], [1.0]
    while times[-1] < last and values[-1] > _GONE:
        if times[-1] >= _PER_TIME * steps.step and 2 * steps.step <= longest:
            steps.doubled()
        even, odd = steps.apply(even, odd)
        times.append(times[-1] + steps.step)
        values.append(grid.start[EVEN] @ (even @ line.row) + grid.start[ODD] @ (odd @ line.row))
        if not -_UNSTABLE < values[-1] < 1 + _UNSTABLE:
            raise UnstableError(f"a survival probability of {values[-1]:g}")
        if len(times) > _MOST:
            raise ToleranceError(
                f"survival is {values[-1]:.1g} still after {times[-1]:.3g}; "
                "use method='monte_carlo'"
            )
    return np.array(times), np.array(values)
