"""gamma^2 = 2 E[g u] with u the Poisson solution of g (Theorem 6 of the paper), on tensor grids.

With two variables, both are first refined together, which is cheapest if few levels are enough.
Otherwise, and with more variables, the combination technique finds out how finely each variable
must be resolved. Its error is what the grids beyond those combined would add.
"""

import functools
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import require
from nonsmooth.grids import tuning as grid_tuning
from nonsmooth.grids import uniform_refinement
from nonsmooth.grids.combination_technique import Combination
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.mesh.box import narrowed
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import Grid, depth_for, fitted, points, solver
from nonsmooth.progress import counter
from nonsmooth.refine import Refined, until_agreement
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import x, y
from nonsmooth.statistics import tuning


def gamma2(scene: Scene, tol: float) -> tuple[float, float]:
    """Compute gamma^2 to a relative tolerance, by the method that suits the scene.

    Parameters
    ----------
    scene : Scene
        With two to four state variables.
    tol : float

    Returns
    -------
    value, error : float

    Raises
    ------
    ToleranceError
        As for `gamma2_by_combination`.
    """
    if uniform_refinement.applies(scene):
        found = gamma2_by_uniform_refinement(scene, tol)
        if found.met:
            return found.value, found.error
    return gamma2_by_combination(scene, tol)


def gamma2_on(scene: Scene, grid: Grid, accuracy: float) -> float:
    """Compute gamma^2 on one grid.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    grid : Grid
    accuracy : float
        Residual of the Poisson solver.

    Returns
    -------
    float
    """
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    u, mean = solve.solve(g, ODD, accuracy)
    _, half = solve.solve((g - mean) * u, EVEN, accuracy)
    return 2 * half


def correlation_time(scene: Scene, grid: Grid, value: float, accuracy: float) -> float:
    """Integral over time of the correlation of g, gamma^2 / (2 Var g), given gamma^2 = value."""
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    _, mean = solve.solve(g, ODD, accuracy)
    _, variance = solve.solve((g - mean) ** 2, EVEN, accuracy)
    return value / (2 * variance)


def gamma2_by_uniform_refinement(scene: Scene, tol: float) -> Refined:
    """Compute gamma^2 of a scene to which `uniform_refinement` applies.

    Parameters
    ----------
    scene : Scene
        With two state variables and a finite n.
    tol : float
        Relative.

    Returns
    -------
    Refined
        As for `uniform_refinement.refined`.
    """
    rounding = tuning.GAMMA2_ON_GRIDS.rounding

    def solve(grid):
        value = gamma2_on(scene, grid, tol)
        return value, rounding / 2 * tol * abs(value)

    return uniform_refinement.refined(
        fitted(scene, depth_for(tol), 1),
        solve,
        lambda error, value: error / (tol * value) if value > 0 else math.inf,
    )


def gamma2_by_combination(scene: Scene, tol: float) -> tuple[float, float]:
    """Compute gamma^2 to a relative tolerance, by the combination technique.

    Parameters
    ----------
    scene : Scene
        With two to four state variables. n = inf is approached by a large n and the known rate of
        convergence.
    tol : float

    Returns
    -------
    value, error : float
        The error is what grids beyond those combined may add (`Combination.error`), plus the
        effects of the finite box, of the residuals and of a finite n.

    Raises
    ------
    ToleranceError
        If the grid becomes too large; the message has the best value, its error and, where rare
        transitions make the equation ill-conditioned, their time scale.
    """
    if not math.isinf(scene.n):
        value, error, grid, accuracy = _combined(scene, tol)
        if not error <= tol * value:
            _refuse(scene, grid, value, error, tol, accuracy)
        return value, error
    chosen = tuning.GAMMA2_ON_GRIDS
    # the rates of convergence are n^(-1/2) where a wall is hit elastically, else 1/n
    elastic = scene.mechanics.in_potential
    stiff = chosen.stiff_elastic if elastic else chosen.stiff
    softer = chosen.softer * stiff
    value, error, below, accuracy = _combined(scene.with_n(stiff), tol / 2)
    fitted_below = replace(below, ends=narrowed(scene.with_n(softer), below.ends, below.ends))
    gap = gamma2_on(scene.with_n(stiff), below, accuracy) - gamma2_on(
        scene.with_n(softer), fitted_below, accuracy
    )
    rest = gap / ((10 if elastic else 100) - 1)
    value, error = value + rest, error + (0.2 if elastic else 1.0) * abs(rest)
    if not error <= tol * value:
        _refuse(scene.with_n(stiff), below, value, error, tol, accuracy)
    return value, error


def _combined(scene, tol):
    """Return gamma^2, its error, the costliest of the combined grids, and the residual."""
    chosen, count = tuning.GAMMA2_ON_GRIDS, scene.dimension
    coarse = fitted(scene, depth_for(tol), chosen.fitted[count])
    coarse = coarse.all_raised(chosen.coarse[count] - chosen.fitted[count])
    base, accuracy, residual = _on_coarsest(scene, coarse, tol)
    larger = gamma2_on(scene, coarse.enlarged(), accuracy)
    directions = _directions(coarse)

    def grid(index):
        levels = {s: level for part, level in zip(directions, index, strict=True) for s in part}
        return replace(coarse, levels=levels)

    def error(combination):
        return combination.error + 2 * abs(larger - base) + residual * abs(combination.value)

    combination = Combination(
        tuple(coarse.levels[part[0]] for part in directions),
        base,
        lambda index: gamma2_on(scene, grid(index), accuracy),
        lambda index: points(scene, grid(index)),
    )
    terms = functools.cache(lambda: _size_of_terms(scene, coarse, accuracy))

    def vanishes(combination):
        """Whether nothing is left but what rounding and the grids leave of larger terms."""
        bound = error(combination)
        return combination.value <= bound < math.inf and bound <= chosen.vanishing * terms()

    largest = grid_tuning.TENSOR_GRIDS.largest[count]
    _enlarge(combination, error, tol, largest, vanishes, 1 + len(directions))
    return combination.value, error(combination), grid(combination.dearest()), accuracy


def _enlarge(combination, error, tol, largest, vanishes, patience):
    """Add grids to a combination until its error is small enough, or there is no hope of that.

    There is none if nothing affordable is left, gamma^2 is 0, or no digit is right and refining
    every variable has not made the error smaller.
    """
    least, stalled = math.inf, 0
    left = tuning.GAMMA2_ON_GRIDS.work * largest
    with counter("grids") as advance:
        while not (error(combination) <= tol * combination.value or vanishes(combination)):
            try:
                cost = combination.refine(min(largest, left))
            except ToleranceError:  # a finer grid on which the iteration does not converge
                return
            left -= cost
            reached = error(combination)
            stalled = 0 if reached < least else stalled + 1
            least = min(least, reached)
            if not cost or (stalled >= patience and reached > abs(combination.value)):
                return
            advance(1)


def _size_of_terms(scene, grid, accuracy):
    """2 E |g u|, which is far above gamma^2 = 2 E[g u] where the terms cancel."""
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    u, mean = solve.solve(g, ODD, accuracy)
    return 2 * solve.solve(np.abs((g - mean) * u), EVEN, accuracy)[1]


def _refuse(scene, grid, value, error, tol, accuracy):
    """Raise a `ToleranceError` that says whether the scene mixes slowly."""
    time = abs(correlation_time(scene, grid, value, accuracy))
    slow = time > tuning.GAMMA2_ON_GRIDS.long * max(scene.damping, 1 / scene.damping)
    cure = f"the scene mixes slowly, g stays correlated for some {time:.0e}; loosen tol"
    require(False, value, error, tol, cure if slow else "loosen tol")


def _directions(grid):
    """Group the variables that are refined together.

    Displacement and velocity are. The motion mixes them: what refining both changes beyond the sum
    of the changes by either is not small, as the combination technique needs it to be. The
    variables of the noise are refined one by one.
    """
    noise = [(symbol,) for symbol in grid.levels if symbol not in (y, x)]
    return [*noise, tuple(symbol for symbol in grid.levels if symbol in (y, x))]


def _on_coarsest(scene, grid, tol):
    """Return gamma^2 on a grid, the residual it needs, and the relative error this leaves.

    The norm of a residual says little about the error: the residual is largest where the invariant
    measure has hardly any mass, and may stagnate there. So it is reduced until gamma^2 no longer
    changes.
    """
    chosen = tuning.GAMMA2_ON_GRIDS
    accuracy = tol * chosen.residual
    if len(grid.levels) <= 2:
        return gamma2_on(scene, grid, accuracy), accuracy, accuracy
    refined = until_agreement(
        _tenths(accuracy),
        lambda accuracy: (gamma2_on(scene, grid, accuracy), accuracy),
        lambda found: abs(found[-1][0] - found[-2][0]) / abs(found[-1][0]),
        met=lambda _, change: change <= chosen.iteration * tol,
    )
    # the smaller residual changed so little that the one before is good enough
    value, accuracy = refined.solutions[-2]
    return value, accuracy, max(2 * refined.error, accuracy)


def _tenths(number: float) -> Iterator[float]:
    while True:
        yield number
        number = number / 10
