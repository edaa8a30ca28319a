"""Mean and variance of int_0^tau (g - E g) from a point, for scenes with two state variables.

With -A u = g - E g and -A h = 2 (g - E g) u - gamma^2, and P the semigroup of A,

    w(tau) = u - r(tau),  E Delta^2 = gamma^2 tau + h - k(tau),
    r_t = A r,  k_t = A k + 2 (g - E g) r,  (k, r) = (h, u) at 0,

so that errors do not grow with tau. A is not sectorial, so that integrals of its resolvent along a
contour are of little use. Instead the pair (k, r) is projected, in L^2 of the invariant measure, on
a rational Krylov space. Its poles are real and cost one factorisation each. The pole 0 is the
Poisson solver and resolves the slowest modes; the others resolve early times.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike
from sympy import Symbol

from nonsmooth.errors import ToleranceError
from nonsmooth.grids import tensor_grid, uniform_refinement
from nonsmooth.grids import tuning as grid_tuning
from nonsmooth.grids.elements import Axis
from nonsmooth.grids.generator import evaluate, start_row
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import Grid
from nonsmooth.progress import counter, interruptible
from nonsmooth.refine import solvable
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning


def moments(scene: Scene, times: np.ndarray, tol: float) -> tuple[np.ndarray, np.ndarray]:
    """Solve for w(start, tau) and v(start, tau), eq. (36) of the paper.

    Parameters
    ----------
    scene : Scene
        With two state variables and a finite n.
    times : numpy.ndarray, shape (t,)
        tau >= 0, "1".
    tol : float
        Absolute error of v(tau)/tau that is aimed at.

    Returns
    -------
    moments, errors : numpy.ndarray, shape (2, t)
        w and v. The errors are those of `uniform_refinement.refined`. Where that fails, the changes
        by refining each variable alone are added to the values, and the errors are the sum of their
        sizes, plus the errors of the box and of the projection. Errors oscillate with tau. So the
        stated error, divided by tau, is the largest that any time between tau / 2 and 2 tau has,
        divided by that time.

    Raises
    ------
    ToleranceError
        If no projection is finite.
    """
    wanted, times = times, _with_neighbours(times)
    scale = np.where(times > 0, times, 1.0)

    allowed = tuning.MOMENTS_ON_GRIDS.projection * tol * scale
    known: dict[tuple, tuple[np.ndarray, np.ndarray]] = {}

    def solve(grid):
        key = (*grid.levels.values(), grid.margin)
        if key not in known:
            known[key] = moments_on(scene, grid, times, allowed)
        return known[key]

    def share(error, _values):
        return np.max(error[1] / (tol * scale))

    grid = first_grid(scene, tol)
    uniform = uniform_refinement.refined(grid, solve, share)
    if uniform.met:
        last, error = uniform.value, uniform.error
    else:
        with counter("grids") as advance:

            def counted(grid):
                with solvable():
                    found = interruptible(partial(solve, grid))
                advance(1)
                return found

            last, error = _refined(scene, grid, counted, share)
    # w is the difference of terms as large as the standard deviation
    w, v = np.abs(last)
    error += tuning.MOMENTS_ON_GRIDS.rounding * np.array([w + np.sqrt(v), v + w**2])
    if not np.all(np.isfinite(error)):
        raise ToleranceError(
            "v(tau) has no finite projection on the grids of this scene; use simulate, or another n"
        )
    error /= scale
    place = np.searchsorted(times, wanted)
    near = [(times >= tau / 2) & (times <= 2 * tau) for tau in wanted]
    largest = np.transpose([error[:, here].max(axis=1) for here in near])
    return last[:, place], largest * scale[place]


def _refined(scene, grid, solve, share):
    """Refine the variables that matter, as far as that is affordable; return values and errors.

    Which variables are refined next depends on the changes by refining each of them alone. So the
    grids are not known beforehand, as they are in `refine.until_agreement`. Where a projection
    fails, the grid before counts.
    """
    gain, before, limit = grid_tuning.UNIFORM_REFINEMENT.gain, None, np.inf
    least = dict.fromkeys(grid.levels, 0.0)
    while True:
        value, inexact = solve(grid)
        trials = {symbol: solve(grid.raised(symbol)) for symbol in grid.levels}
        changes = {s: np.maximum(np.abs(trials[s][0] - value), least[s]) for s in trials}
        combined = value + sum(trial - value for trial, _ in trials.values())
        unsure = inexact + sum(by_trial for _, by_trial in trials.values())
        found = _Found(grid, combined, sum(changes.values()) + 2 * unsure)
        size = share(found.error, combined)
        if before is not None and not size < tuning.MOMENTS_ON_GRIDS.failed * limit:
            found = before
            break
        coarse = [s for s in changes if not share(changes[s], value) <= 1 / (2 * len(changes))]
        finer = _balanced(grid, coarse)
        if not coarse or not _affordable(scene, finer.all_raised()):
            break
        grid = finer
        if np.isfinite(size):
            before, limit = found, size
            least = least | {s: changes[s] / gain for s in coarse}
    # a larger box changes less than a finer grid, which a coarser one tells as well
    boxed = found.grid.all_raised(-1) if min(found.grid.levels.values()) > 0 else found.grid
    beyond = np.abs(solve(boxed.enlarged())[0] - solve(boxed)[0])
    return found.value, found.error + 2 * beyond


@dataclass(frozen=True)
class _Found:
    """Values to which the changes by refining each variable are added, and their error."""

    grid: Grid
    value: np.ndarray
    error: np.ndarray


def _balanced(grid, coarse):
    """Raise variables, and those that are left far behind: such grids have modes that grow."""
    levels = {symbol: level + (symbol in coarse) for symbol, level in grid.levels.items()}
    least = max(levels.values()) - tuning.MOMENTS_ON_GRIDS.behind
    return grid.with_levels(max(level, least) for level in levels.values())


def _with_neighbours(times):
    """Sort times and add some, from half of the smallest to twice the largest positive one.

    Errors oscillate with time and are sampled at the times that are added.
    """
    positive = times[times > 0]
    if not len(positive):
        return np.unique(times)
    first, last = positive.min() / 2, 2 * positive.max()
    count = 1 + math.ceil(math.log(last / first) / math.log(tuning.MOMENTS_ON_GRIDS.apart))
    return np.unique(np.concatenate([times, np.geomspace(first, last, count)]))


def first_grid(scene: Scene, tol: float) -> Grid:
    """Return the coarsest grid. Its box holds the invariant density and the starting point."""
    grid = tensor_grid.fitted(scene, tensor_grid.depth_for(tol), 1)
    ends = tensor_grid.around_start(scene, grid.ends)
    return replace(grid, ends=ends).at_level(tuning.MOMENTS_ON_GRIDS.coarsest)


def _affordable(scene, grid):
    chosen = tuning.MOMENTS_ON_GRIDS
    few = tensor_grid.points(scene, grid) <= chosen.largest
    return few and max(grid.levels.values()) <= chosen.finest


def moments_on(
    scene: Scene, grid: Grid, times: np.ndarray, allowed: ArrayLike
) -> tuple[np.ndarray, np.ndarray]:
    """Solve for w and v on one grid.

    Parameters
    ----------
    scene : Scene
    grid : Grid
    times : numpy.ndarray, shape (t,)
        tau >= 0, "1".
    allowed : array_like
        Error of v that the projection may have.

    Returns
    -------
    moments, changes : numpy.ndarray, shape (2, t)
        w and v, and their changes by the last Krylov vectors.
    """
    axes, solver = tensor_grid.direct_solver(scene, grid)
    g = solver.fold(evaluate(scene.numerical_observable(), axes))
    u, mean = solver.solve(g, ODD)
    g = g - mean
    masses = solver.fold(solver.stationary())
    masses /= masses.sum()
    if not solver.mirrored:
        u -= masses @ u
    h, gamma2 = solver.solve(2 * g * u, EVEN)
    krylov = _Krylov(solver, g, masses)
    slow, fast = _Functions(masses, [np.ones_like(g), h]), _Functions(masses, [u, g])
    at = at_start(scene, axes)
    found = inexact = np.full((2, len(times)), np.nan)
    for dimension in tuning.MOMENTS_ON_GRIDS.dimensions:
        krylov.enlarge(dimension, slow, fast)
        value = _evolve(solver, slow, fast, g, (h, u), gamma2, times, at)
        found, inexact = value, np.abs(value - found)
        if np.all(inexact[1] <= allowed):
            break
    return found, inexact


class _Functions:
    """Orthonormal functions in L^2 of the absolute value of a measure."""

    def __init__(self, masses, functions):
        # on coarse grids masses may be negative where they are small
        self.masses = np.abs(masses) + np.finfo(float).eps * np.max(masses)
        self.rows = np.empty((0, len(masses)))
        for function in functions:
            self.add(function)

    def dot(self, functions):
        """Coefficients of functions, shape (k, ...)."""
        return (self.rows * self.masses) @ functions

    def add(self, function):
        """Orthonormalise a function and append it, unless it depends on the others."""
        size = math.sqrt(self.masses @ function**2)
        if size == 0:
            return False
        rest = function / size
        for _ in range(2):
            rest = rest - self.dot(rest) @ self.rows
        size = math.sqrt(self.masses @ rest**2)
        if size < tuning.MOMENTS_ON_GRIDS.dependent:
            return False
        self.rows = np.vstack([self.rows, rest / size])
        return True


class _Krylov:
    """Rational Krylov space of the pair (k, r), from (0, g)."""

    def __init__(self, solver, g, masses):
        self.solver, self.g, self.masses = solver, g, masses
        self.pairs = _Functions(np.concatenate([masses, masses]), [np.concatenate([0 * g, g])])
        self.exhausted = False

    def enlarge(self, dimension, slow, fast):
        """Add pairs up to a dimension, and their parts to the two lists of functions."""
        poles = tuning.MOMENTS_ON_GRIDS.poles
        while len(self.pairs.rows) < dimension and not self.exhausted:
            shift = poles[len(self.pairs.rows) % len(poles)]
            k, r = np.split(self.pairs.rows[-1], 2)
            r = self._resolvent(r, ODD, shift)
            k = self._resolvent(k + 2 * self.g * r, EVEN, shift)
            self.exhausted = not self.pairs.add(np.concatenate([k, r]))
            if not self.exhausted:
                k, r = np.split(self.pairs.rows[-1], 2)
                slow.add(k)
                fast.add(r)

    def _resolvent(self, values, parity, shift):
        if shift:
            return self.solver.resolvent(values, parity, shift)
        solution, _ = self.solver.solve(values, parity)
        odd = self.solver.mirrored and parity == ODD
        return solution if odd else solution - self.masses @ solution


def _evolve(solver, slow, fast, g, start, gamma2, times, at):
    """Find w and v from the projected equations of k (`slow`) and r (`fast`)."""
    k0, r0 = slow.dot(start[0]), fast.dot(start[1])
    many = len(k0)
    matrix = np.zeros((many + len(r0) + 1,) * 2)
    matrix[:many, :many] = slow.dot(solver.matrix(EVEN) @ slow.rows.T)
    matrix[:many, many:-1] = slow.dot(2 * g[:, None] * fast.rows.T)
    matrix[many:-1, many:-1] = fast.dot(solver.matrix(ODD) @ fast.rows.T)
    # the first of the slow functions is 1
    for block in (slice(1, many), slice(many, -1)):
        matrix[block, block] = decaying(matrix[block, block])
    # the exponential's last column is the change since the start, without cancellation
    matrix[:-1, -1] = matrix[:-1, :-1] @ np.concatenate([k0, r0])
    changes = np.array([scipy.linalg.expm(tau * matrix)[:-1, -1] for tau in times])
    w = -changes[:, many:] @ at(solver, fast.rows, ODD)
    return np.array([w, gamma2 * times - changes[:, :many] @ at(solver, slow.rows, EVEN) - w**2])


def decaying(matrix: np.ndarray) -> np.ndarray:
    """Make modes decay that grow: the generator has none, but its projection may.

    Such a mode is not that of any grid, it differs from space to space. What is left out with it is
    seen in the change by the next space.

    Parameters
    ----------
    matrix : numpy.ndarray, shape (k, k)
        The projected generator.

    Returns
    -------
    numpy.ndarray, shape (k, k)

    Raises
    ------
    numpy.linalg.LinAlgError
        If the matrix is not finite.
    """
    if not np.all(np.isfinite(matrix)):
        raise np.linalg.LinAlgError("the projection is not finite")
    rates, left, right = scipy.linalg.eig(matrix, left=True, right=True)
    largest = np.max(np.abs(matrix))
    grows = rates.real > tuning.MOMENTS_ON_GRIDS.growing * largest
    left, right = left[:, grows].conj(), right[:, grows]
    weights = (rates[grows] + largest) / np.sum(left * right, axis=0)
    return matrix - ((right * weights) @ left.T).real


def at_start(scene: Scene, axes: dict[Symbol, Axis]) -> Callable:
    """Return the function that evaluates others at the starting point.

    Parameters
    ----------
    scene : Scene
    axes : dict
        See `mesh.axes.axes`.

    Returns
    -------
    callable
        Takes a solver, functions in rows and their parity; returns values.
    """
    start, mirrored = (start_row(scene, axes, side) for side in (1, -1))

    def at(solver, rows, parity):
        if not solver.mirrored:
            return rows @ start
        # where the start lies on a face between elements, this is the mean of both sides
        whole = (start + parity * mirrored) / 2
        half = rows.shape[1]
        return rows @ (whole[:half] + parity * whole[half:][::-1])

    return at
