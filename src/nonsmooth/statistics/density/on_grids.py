"""Invariant densities on tensor grids.

The masses of the discretised invariant measure at the nodes are divided by the nodes' weights.
"""

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import ToleranceError, answered
from nonsmooth.estimate import not_negative
from nonsmooth.grids import tensor_grid
from nonsmooth.grids import tuning as grid_tuning
from nonsmooth.grids.mesh.axes import axes as axes_of
from nonsmooth.grids.mesh.layers import is_held, misses_layer, resolves_layer
from nonsmooth.grids.tensor_grid import Grid
from nonsmooth.refine import further_terms, until_agreement
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning
from nonsmooth.statistics.density.found import Density, Found, keys


def first_grid(scene: Scene, tol: float) -> Grid:
    """Return the coarsest grid for densities, with a box that suits the tolerance."""
    chosen = tuning.INVARIANT_DENSITY
    level = chosen.fitted[scene.dimension]
    grid = tensor_grid.fitted(scene, tensor_grid.depth_for(tol), level)
    first = 0 if _has_layers(scene, grid) else chosen.first
    return replace(grid.all_raised(first - level), of_density=True)


def solved_densities(
    scene: Scene, grid: Grid, tol: float, points: Mapping[str, ArrayLike], quick: bool
) -> Found:
    """Solve for densities on finer and finer grids.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    grid : Grid
        The first.
    tol : float
        Error allowed, relative to the largest value of each density.
    points : dict
        Of all variables.
    quick : bool
        Whether to end with grids that take some seconds.

    Returns
    -------
    dict
        Names of variables -> `Density`. The error is the largest of those of `refined`, and what
        the density may be outside of the grids. Solutions oscillate about 0 where a density is
        small; negative values become 0.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best densities are its `result`.
    """
    accuracy = tol * tuning.INVARIANT_DENSITY.residual
    held = scene.mechanics.argument.name
    missed = [key for key in keys(scene) if held in key] if _misses_layer(scene, grid) else []

    def present(refined):
        found = {}
        for key, both in refined.items():
            value, error = not_negative(*both)
            found[key] = Density(value, float(np.max(error)) + outside(value, tol))
        return found

    found = answered(
        lambda: refined(
            scene,
            grid,
            tol,
            lambda grid: densities_on(scene, grid, points, accuracy),
            quick,
            at_points=True,
            missed=missed,
        ),
        present,
    )
    if missed:
        raise ToleranceError(
            f"the invariant density has layers for which {held} needs too many elements; choose a "
            "smaller n or method='monte_carlo'",
            found,
        )
    return found


def _misses_layer(scene, grid):
    """Whether no finer grid resolves the layer of a density: only degrees are raised."""
    if scene.dimension < 3:
        return is_held(scene) and not _has_layers(scene, grid)
    held = axes_of(scene, grid.ends, grid.levels, of_density=True)[scene.mechanics.argument]
    return misses_layer(scene, grid.ends, held.edges)


def _has_layers(scene, grid):
    """Whether the elements of a grid resolve layers."""
    return resolves_layer(scene, grid.ends[scene.noise.driven])


def outside(value: np.ndarray, tol: float) -> float:
    """Size of a density outside the box of `depth_for(tol)`, where the grids have none."""
    return math.exp(-tensor_grid.depth_for(tol)) * float(np.max(value))


def refined(
    scene: Scene,
    grid: Grid,
    tol: float,
    solve: Callable[[Grid], dict],
    quick: bool = False,
    at_points: bool = False,
    missed: Collection = (),
) -> dict:
    """Refine a grid until two levels agree.

    Parameters
    ----------
    scene : Scene
    grid : Grid
        The first.
    tol : float
        Error allowed, relative to the largest value of each array.
    solve : callable
        Takes a grid; returns a dict of arrays.
    quick : bool
        Whether to end with grids that take some seconds.
    at_points : bool
        Whether the values are densities at points, which converge more slowly than averages.
    missed : collection
        Keys of arrays that no grid resolves. On anything about them grids may agree, so that their
        errors are infinite, and refinement ends without them.

    Returns
    -------
    dict
        For each array the pair of its values on the last grid and of their differences to those on
        the one before. Two grids may agree where the error changes its sign, so a difference counts
        as at least a part of the one before. Grids that resolve layers converge slowly where the
        velocity is 0 at the kink; their differences count twice. At points, where differences fall
        slowly, the error is what is left of a geometric series of them; those of three and four
        variables count three times where a stiff force holds one of them, whose layer is thinner
        than any element, and if there is no other difference to compare with. So do averages of the
        variable that is held.

    Raises
    ------
    ToleranceError
        If `tol` is not met; what the last grid gives is its `result`.
    """
    chosen, many = tuning.INVARIANT_DENSITY, scene.dimension > 2
    held = scene.mechanics.argument.name if many and is_held(scene) else None
    safety = chosen.layered_safety if _has_layers(scene, grid) else 1.0
    first = chosen.unresolved_safety if many and at_points else safety

    def least(key, levels):
        if held and (at_points or held in key):
            return chosen.unresolved_safety
        return safety if levels > 2 else first

    def difference(found):
        left = {
            key: _left([level[key] for level in found], least(key, len(found)), at_points)
            for key in found[0]
        }
        return left | {key: np.full_like(left[key], math.inf) for key in missed}

    def relative(values, difference):
        tiny = np.finfo(float).tiny
        known = [key for key in values if key not in missed]
        return max(np.max(difference[key]) / max(np.max(values[key]), tiny) for key in known)

    result = until_agreement(
        _affordable(scene, grid, quick),
        solve,
        difference,
        met=lambda values, difference: relative(values, difference) <= tol,
    )
    if result.error is None:
        raise ToleranceError(
            "the invariant density has an unknown error on the only affordable grid; loosen tol"
        )
    found = {key: (result.value[key], result.error[key]) for key in result.value}
    if not result.met:
        raise ToleranceError(
            f"the invariant density, with values up to "
            f"{max(np.max(value) for value in result.value.values()):.3g}, has a relative error of "
            f"{relative(result.value, result.error):.1e} on the finest grid, above tol = {tol:g}; "
            "loosen tol",
            found,
        )
    return found


def _left(levels: list[np.ndarray], least: float, slow: bool) -> np.ndarray:
    """Estimate the error of the last values by their difference to those before.

    It counts `least` times, or as many times as a geometric series says, if they may be `slow`.
    """
    steps = [np.abs(fine - coarse) for coarse, fine in pairwise(levels)]
    change = steps[0]
    for step in steps[1:]:
        change = np.maximum(step, change / tuning.INVARIANT_DENSITY.gain)
    sizes = [float(np.max(step)) for step in steps[-2:]]
    if not slow or len(sizes) < 2 or sizes[0] == 0:
        return least * change
    return np.maximum(further_terms(sizes[1] / sizes[0]), least) * change


def _affordable(scene: Scene, grid: Grid, quick: bool) -> Iterator[Grid]:
    """Yield a grid and finer ones, as long as they can be solved on and have few enough points."""
    chosen, count = tuning.INVARIANT_DENSITY, scene.dimension
    layers = _has_layers(scene, grid)
    most: float = chosen.largest_layered if layers else grid_tuning.TENSOR_GRIDS.largest[count]
    if quick:
        most = min(most, chosen.quick.get(count, math.inf))
    yield grid
    while tensor_grid.points(scene, grid := grid.all_raised()) <= most:
        yield grid


def densities_on(
    scene: Scene,
    grid: Grid,
    points: Mapping[str, ArrayLike],
    accuracy: float,
) -> dict[tuple[str, ...], np.ndarray]:
    """Marginal densities on one grid.

    Parameters
    ----------
    scene : Scene
    grid : Grid
    points : dict
        Maps names of all variables to points.
    accuracy : float
        Residual of an iterative solver; a direct one ignores it.

    Returns
    -------
    dict
        Maps tuples of names to values at the points.
    """
    axes, masses = tensor_grid.invariant_measure(scene, grid, accuracy)
    order = [symbol.name for symbol in axes]
    at = {symbol.name: axis.densities(points[symbol.name]) for symbol, axis in axes.items()}
    found = {}
    for key in keys(scene):
        rest = tuple(place for place, name in enumerate(order) if name not in key)
        joint = masses.sum(axis=rest)
        for place, name in enumerate(name for name in order if name in key):
            joint = np.moveaxis(np.tensordot(at[name], joint, axes=(1, place)), 0, place)
        if [name for name in order if name in key] != list(key):
            joint = joint.T
        found[key] = joint
    return found
