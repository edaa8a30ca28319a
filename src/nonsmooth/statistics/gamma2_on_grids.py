"""gamma^2 of scenes with several variables, on tensor grids that are refined until it settles."""

import math
from dataclasses import replace

from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import require
from nonsmooth.grids import tuning
from nonsmooth.grids.combination_technique import Combination
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.mesh.box import narrowed
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import depth_for, fitted, points, solver
from nonsmooth.grids.uniform_refinement import refined
from nonsmooth.scenes.symbols import x, y

# levels by the number of variables: of the grids for box and shift, of the coarsest for gamma^2
_FITTED, _COARSE = {2: 2, 3: 1, 4: 0}, {2: 2, 3: 1, 4: 1}
_ACCURACY = 0.02  # residual of the iteration, relative to the tolerance, to begin with


_ITERATION = 0.1  # what a tenth of the residual may change, relative to the tolerance


_STIFF = {True: 1e12, False: 1e7}  # n that stands for inf, for elastic walls and otherwise


_LONG = 100.0  # correlation time of a slow scene, relative to that of its damping


_WORK = 8  # largest grids that may be spent on one value


def growth_rate(scene, grid, accuracy):
    """gamma^2 = 2 E[g u] on one grid, u the Poisson solution of g (Theorem thm3)."""
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    u, mean = solve.solve(g, ODD, accuracy)
    _, half = solve.solve((g - mean) * u, EVEN, accuracy)
    return 2 * half


def correlation_time(scene, grid, growth, accuracy):
    """Integral over time of the correlation of g, gamma^2 / (2 Var g), given gamma^2 = growth."""
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    _, mean = solve.solve(g, ODD, accuracy)
    _, variance = solve.solve((g - mean) ** 2, EVEN, accuracy)
    return growth / (2 * variance)


def growth_to(scene, tol):
    """Compute gamma^2 to a relative tolerance.

    Parameters
    ----------
    scene : Scene
        n = inf is approached by a large n and the known rate of convergence.
    tol : float

    Returns
    -------
    value, error : float
        The error is what grids beyond those combined may add, see `Combination.error`; to it come
        the box, the residuals and n.

    Raises
    ------
    ToleranceError
        If the grid becomes too large; the message has the best value, its error and, where rare
        transitions make the equation ill-conditioned, their time scale.
    """
    if not math.isinf(scene.n):
        return _refined(scene, tol)[:2]
    # ASSUME: METHODS' empirical rates, n^(-1/2) where a wall is hit elastically, else 1/n
    elastic = scene.mechanics.in_potential
    stiff, softer = _STIFF[elastic], 1e-2 * _STIFF[elastic]
    value, error, below, accuracy = _refined(scene.with_n(stiff), tol / 2)
    fitted_below = replace(below, ends=narrowed(scene.with_n(softer), below.ends, below.ends))
    gap = growth_rate(scene.with_n(stiff), below, accuracy) - growth_rate(
        scene.with_n(softer), fitted_below, accuracy
    )
    rest = gap / ((10 if elastic else 100) - 1)
    value, error = value + rest, error + (0.2 if elastic else 1.0) * abs(rest)
    require(error <= tol * abs(value), value, error, tol)
    return value, error


def _refined(scene, tol):
    """gamma^2, its error, the dearest of the combined grids, and the residual."""
    count = scene.dimension
    coarse = fitted(scene, depth_for(tol), _FITTED[count])
    coarse = coarse.all_raised(_COARSE[count] - _FITTED[count])
    base, accuracy, residual = _iterated(scene, coarse, tol)
    larger = growth_rate(scene, coarse.enlarged(), accuracy)
    directions = _directions(coarse)

    def grid(index):
        levels = {s: level for part, level in zip(directions, index, strict=True) for s in part}
        return replace(coarse, levels=levels)

    combination = Combination(
        tuple(coarse.levels[part[0]] for part in directions),
        base,
        lambda index: growth_rate(scene, grid(index), accuracy),
        lambda index: points(scene, grid(index)),
    )
    largest = tuning.TENSOR_GRIDS.largest[count]
    left = _WORK * largest
    while True:
        value = combination.value
        error = combination.error + 2 * abs(larger - base) + residual * abs(value)
        if error <= tol * abs(value):
            break
        try:
            cost = combination.refine(min(largest, left))
        except ToleranceError:  # a finer grid on which the iteration does not converge
            break
        left -= cost
        if not cost:
            break
    best = grid(combination.dearest())
    if error > tol * abs(value):
        time = abs(correlation_time(scene, best, value, accuracy))
        slow = time > _LONG * max(scene.damping, 1 / scene.damping)
        cure = f"the scene mixes slowly, g stays correlated for some {time:.0e}; loosen tol"
        require(False, value, error, tol, cure if slow else "loosen tol")
    return value, error, best, accuracy


def _directions(grid):
    """Group the variables that are refined together.

    Those of the oscillator are, beside noise of its own: transport mixes them, so that what they
    change together is no smaller than what one of them changes.
    """
    noise = [(symbol,) for symbol in grid.levels if symbol not in (y, x)]
    return [*noise, tuple(symbol for symbol in grid.levels if symbol in (y, x))]


def _iterated(scene, grid, tol):
    """gamma^2 on a grid, the residual that it needs, and what that leaves of relative error.

    The norm of a residual says little: it is largest where there is no mass, and may stagnate
    there.
    """
    accuracy = tol * _ACCURACY
    value = growth_rate(scene, grid, accuracy)
    if len(grid.levels) <= 2:
        return value, accuracy, accuracy
    while True:
        finer = growth_rate(scene, grid, accuracy / 10)
        change = abs(finer - value) / abs(finer)
        if change <= _ITERATION * tol:
            return value, accuracy, max(2 * change, accuracy)
        value, accuracy = finer, accuracy / 10


_RESIDUE = 1e-3  # of the tolerance, for rounding


def growth_on_ladder(scene, tol):
    """Compute gamma^2 of a scene to which this `applies`.

    Parameters
    ----------
    scene : Scene
    tol : float
        Relative.

    Returns
    -------
    (value, error) or None
        As of `climb`.
    """

    def solve(grid):
        value = growth_rate(scene, grid, tol)
        return value, _RESIDUE / 2 * tol * abs(value)

    found = refined(
        fitted(scene, depth_for(tol), 1),
        solve,
        lambda error, value: error / (tol * abs(value)),
    )
    return (found.value, found.error) if found.met else None
