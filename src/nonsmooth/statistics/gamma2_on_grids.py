"""gamma^2 = 2 E[g u] with u the Poisson solution of g (Theorem 6 of the paper), on tensor grids.

With two variables, both are first refined together, which is cheapest if few levels are enough.
Otherwise, and with more variables, `combined_grids` finds out how finely each variable must be
resolved.
"""

import math
from collections.abc import Callable

import numpy as np

from nonsmooth.errors import ToleranceError, quoted
from nonsmooth.estimate import require
from nonsmooth.grids import uniform_refinement
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import Grid, depth_for, fitted, solver
from nonsmooth.refine import Refined
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning
from nonsmooth.statistics.combined_grids import combined


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
        As for `gamma2_by_combination`; if g is 0 on all nodes.
    """
    value, error = _gamma2(scene, tol)
    if value == error == 0:
        raise ToleranceError(
            f"g = {quoted(scene.observable)} is 0 as far as grids reach, where paths hardly ever "
            "leave, so that gamma^2 is too small to be computed; choose another observable"
        )
    return value, error


def _gamma2(scene, tol):
    if uniform_refinement.applies(scene):
        found = gamma2_by_uniform_refinement(scene, tol)
        if found.met:
            return found.value, found.error
    return gamma2_by_combination(scene, tol)


def gamma2_on(scene: Scene, grid: Grid) -> Callable[[float], float]:
    """Compute gamma^2 on one grid.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    grid : Grid

    Returns
    -------
    callable
        Takes the residual of the Poisson solver; returns gamma^2. Each call goes on from the
        solutions of the one before.
    """
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    u = h = None

    def value(accuracy):
        nonlocal u, h
        u, mean = solve.solve(g, ODD, accuracy, u)
        h, half = solve.solve((g - mean) * u, EVEN, accuracy, h)
        return 2 * half

    return value


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
        value = gamma2_on(scene, grid)(tol)
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
        The error is that of `combined`.

    Raises
    ------
    ToleranceError
        If the grid becomes too large; the message has the best value, its error and, where rare
        transitions make the equation ill-conditioned, their time scale.
    """
    found = combined(scene, tol, gamma2_on, lambda value, tol: tol * value, _floor)
    if not found.error <= tol * found.value:
        _refuse(found, tol)
    return found.value, found.error


def _floor(scene, grid, accuracy):
    """Return what rounding and grids leave of 2 E |g u|.

    This is far above gamma^2 = 2 E[g u] where the terms cancel.
    """
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    u, mean = solve.solve(g, ODD, accuracy)
    terms = 2 * solve.solve(np.abs((g - mean) * u), EVEN, accuracy)[1]
    return tuning.GAMMA2_ON_GRIDS.vanishing * terms


def _refuse(found, tol):
    """Raise a `ToleranceError` that says whether the scene mixes slowly."""
    damping = found.scene.damping
    time = abs(correlation_time(found.scene, found.grid, found.value, found.accuracy))
    slow = time > tuning.GAMMA2_ON_GRIDS.long * max(damping, 1 / damping)
    cure = f"the scene mixes slowly, g stays correlated for some {time:.0e}; loosen tol"
    require(False, found.value, found.error, tol, cure if slow else "loosen tol")
