"""The Poisson solution u of g, -A u = g, at points of the state, on tensor grids."""

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

import numpy as np
from sympy import Symbol

from nonsmooth.boundary_layer import tuning
from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.grids.generator import at_points, evaluate
from nonsmooth.grids.mesh.axes import variables
from nonsmooth.grids.mesh.box import is_known
from nonsmooth.grids.solver import ODD
from nonsmooth.grids.tensor_grid import Grid, around_start, depth_for, fitted, solver
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.combined_grids import combined, with_finite_n
from nonsmooth.statistics.tuning import GAMMA2_ON_GRIDS

Points = Mapping[Symbol, np.ndarray]


def on_coarse_grid(scene: Scene) -> Callable[[Points], np.ndarray] | None:
    """Return u on a coarse grid, a function of points, or None if no grid can be solved on.

    Parameters
    ----------
    scene : Scene
        With two to four state variables and odd g.
    """
    accuracy, scene = tuning.POISSON.coarse, with_finite_n(scene)
    if not is_known(scene):
        return None
    try:
        grid = fitted(scene, depth_for(accuracy), GAMMA2_ON_GRIDS.coarse[scene.dimension])
        u, axes = _solved(scene, grid, accuracy)
    except ToleranceError:
        return None
    return lambda points: at_points(u, axes, points)


def mean_at(
    scene: Scene, points: Points, tol: float, unit: float, known: np.ndarray | float = 0.0
) -> tuple[float, float]:
    """Compute the mean of u over points, or of what u is beyond values that are known.

    Parameters
    ----------
    scene : Scene
        As for `on_coarse_grid`.
    points : dict
        Maps the symbols of the state to arrays of shape (m,). If there are many, some of them are
        taken.
    tol : float
        Error wanted, over `unit`, which is about as large as u.
    unit : float
    known : numpy.ndarray, shape (m,), optional

    Returns
    -------
    value, error : float
        The error contains two standard errors if only some of the points are taken.

    Raises
    ------
    ToleranceError
        If the equations of the coarsest grid cannot be solved.
    """
    count = len(next(iter(points.values())))
    some = slice(None, None, math.ceil(count / tuning.POISSON.points))
    taken = {symbol: values[some] for symbol, values in points.items()}
    known = np.broadcast_to(known, count)[some]
    spreads = [0.0]

    def mean(scene: Scene, grid: Grid, accuracy: float) -> float:
        u, axes = _solved(scene, grid, accuracy)
        rest = at_points(u, axes, taken) - known
        spreads.append(float(np.std(rest)))
        return float(np.mean(rest))

    found = combined(
        scene, tol, lambda scene, grid: partial(mean, scene, grid), lambda _, tol: tol * unit
    )
    left_out = 1 - len(known) / count
    return found.value, found.error + 2 * max(spreads) * math.sqrt(left_out / len(known))


def at_start(scene: Scene, unit: float) -> Estimate | None:
    """Compute u at the start; None if grids are not good enough.

    Parameters
    ----------
    scene : Scene
        As for `on_coarse_grid`.
    unit : float
        About as large as u.

    Returns
    -------
    Estimate or None
        Its error is at most `tuning.POISSON.at_start` units.
    """
    if not is_known(scene):
        return None
    began = time.perf_counter()
    most = tuning.POISSON.at_start
    start = {s: np.array([scene.start.get(s.name, 0.0)]) for s in variables(scene)}
    try:
        value, error = mean_at(scene, start, most, unit)
    except ToleranceError:
        return None
    if not error <= most * unit:
        return None
    return Estimate(value, error, "tensor grids", time.perf_counter() - began)


def _solved(scene, grid, accuracy):
    """Return u at the nodes of a grid that contains the start, and its axes."""
    axes, solve = solver(scene, replace(grid, ends=around_start(scene, grid.ends)))
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    u, _ = solve.solve(g, ODD, accuracy)
    return solve.unfold(u, ODD), axes
