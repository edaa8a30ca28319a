"""The public function for invariant densities, and its choice between methods."""

import math
from collections.abc import Mapping

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.checks import (
    require_choice,
    require_list,
    require_seed,
    require_threads,
    require_tolerance,
)
from nonsmooth.errors import SceneError, ToleranceError, answered, quoted
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.mesh.box import half_widths, is_known, suits
from nonsmooth.results import dataset
from nonsmooth.scenes.scene import Scene, require_random
from nonsmooth.scenes.symbols import TITLES, x
from nonsmooth.statistics import tuning
from nonsmooth.statistics.density.closed_form import closed_form
from nonsmooth.statistics.density.found import Density, relative_error
from nonsmooth.statistics.density.on_grids import first_grid, solved_densities
from nonsmooth.statistics.density.sampled import are_cells, sampled_densities

METHODS = ("deterministic", "monte_carlo")


def invariant_density(
    scene: Scene,
    tol: float | None = None,
    points: Mapping[str, ArrayLike] | None = None,
    method: str | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
) -> xr.Dataset:
    """Invariant density: marginals of every variable and of the last two together.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Error allowed, relative to the largest value of each density. Unless given, it is 5e-2, and
        grids aim at 1e-8, 1e-4, 1e-2 or 5e-2 for one to four variables; what misses 5e-2 is
        returned with a warning. ``"deterministic"`` warns of what misses its aim.
    points : dict, optional
        Maps the names of all variables of the state to points at which the densities are wanted;
        201 equidistant ones over the support unless given.
    method : {"deterministic", "monte_carlo"}, optional
        Unless given, ``"deterministic"``; ``"monte_carlo"`` for what that does not reach, and, if
        there is no closed form, at n = inf and for functions of the noise alone.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.

    Returns
    -------
    xarray.Dataset
        `density_y` and so on over the points of each variable, and the joint density of the last
        two variables of the state, `density_y_x` or `density_eta_y`. Each has an error
        (`density_y_error`), which holds at every point. Where there is a closed form (dry friction
        and obstacles with white noise), it is that of the normalisation; on grids the largest
        difference between two of them. A density by Monte Carlo has the attribute `cell_methods`:
        it is averaged over the cells around the points, whose edges lie in the middle between them.
        So it shows how much mass there is also where there is no density, as on walls at n = inf.

    Raises
    ------
    SceneError
        If an argument is out of range, or no method does what is asked for.
    ToleranceError
        If `tol` cannot be met; the best densities are its `result`.
    """
    require_random(scene)
    tol = None if tol is None else min(require_tolerance(tol), tuning.INVARIANT_DENSITY.loosest)
    points = None if points is None else _require_points(scene, points)
    method = None if method is None else require_choice("method", method, METHODS)
    seed, threads = require_seed(seed), require_threads(threads)
    closed = closed_form(scene) if method != "monte_carlo" else {}
    sampling = method == "monte_carlo" or math.isinf(scene.n) or not suits(scene)
    if method == "deterministic" and sampling and not closed:
        raise SceneError(
            "at n = inf, without the velocity or with a noise of another kind, densities are not "
            "solved for; choose a finite n, another observable or noise, or method='monte_carlo'"
        )
    accuracy = tuning.INVARIANT_DENSITY.tol[scene.dimension] if tol is None else tol
    if closed:
        points = points or _equidistant(half_widths(scene, tensor_grid.depth_for(accuracy)))
        return _dataset(_of_closed_form(closed, points), points)
    grid = None if sampling else _grid(scene, accuracy, method)
    if points is None:
        points = _equidistant(_support(scene, accuracy) if grid is None else grid.ends)

    def solve():
        if grid is None:
            return sampled_densities(scene, tol, points, seed, threads)
        try:
            return solved_densities(scene, grid, accuracy, points, quick=tol is None)
        except ToleranceError as refused:
            if method == "deterministic" or not are_cells(points):
                raise
            return _completed(refused, scene, tol, points, seed, threads)

    return answered(solve, lambda found: _dataset(found, points), tol_given=tol is not None)


def _grid(scene, accuracy, method):
    """Return the first grid, or None if there is none and the method is free."""
    try:
        return answered(lambda: first_grid(scene, accuracy), lambda grid: grid)
    except (SceneError, ToleranceError):
        if method == "deterministic":
            raise
        return None


def _completed(refused, scene, tol, points, seed, threads):
    """Replace what grids have not reached by histograms that have smaller errors."""
    solved = refused.result or {}
    allowed = tuning.SAMPLED_DENSITY.tolerance if tol is None else tol
    reached = {key: part for key, part in solved.items() if relative_error(part) <= allowed}
    if reached and len(reached) == len(solved):
        return solved
    try:
        sampled = sampled_densities(scene, tol, points, seed, threads)
    except ToleranceError as missed:
        sampled = missed.result or {}
    found = {
        key: min((part[key] for part in (solved, sampled) if key in part), key=relative_error)
        for key in {**sampled, **solved}
    } | reached
    worst = max(found, key=lambda key: relative_error(found[key]), default=None)
    if worst is None:
        raise refused
    if relative_error(found[worst]) > allowed:
        raise ToleranceError(
            f"the invariant density of {', '.join(worst)}, with values up to "
            f"{np.max(found[worst].value):.3g}, has a relative error of "
            f"{relative_error(found[worst]):.1e}, above {allowed:g}; loosen tol",
            found,
        )
    return found


def _require_points(scene, points):
    """Return the points of every variable of the state as arrays."""
    if not isinstance(points, Mapping) or set(points) != set(scene.state):
        example = ", ".join(f"'{name}': [0.0, 0.5]" for name in scene.state)
        raise SceneError(
            f"points is {quoted(points)}; give those of every variable of the state, {{{example}}}"
        )
    return {name: require_list(f"points[{name!r}]", points[name]) for name in scene.state}


def _equidistant(ends):
    count = tuning.INVARIANT_DENSITY.points
    return {symbol.name: np.linspace(-end, end, count) for symbol, end in ends.items()}


def _support(scene, accuracy):
    """Return half widths of a box for points; at n = inf a displacement ends at the walls."""
    if not is_known(scene):
        raise SceneError(
            f"the invariant density of {scene.noise.title} is not known, so that no points can be "
            "chosen; give points of every variable"
        )
    limit = math.isinf(scene.n)
    soft = scene.with_n(tuning.SAMPLED_DENSITY.soft) if limit else scene
    try:
        grid = _grid(soft, accuracy, None) if suits(soft) else None
        depth = tensor_grid.depth_for(accuracy)
        ends = half_widths(soft, depth) if grid is None else grid.ends
    except SceneError as unknown:
        raise SceneError(f"{unknown}; here, give points of every variable") from None
    walled = limit and scene.mechanics.argument == x
    return {
        symbol: scene.mechanics.wall if walled and symbol == x else end
        for symbol, end in ends.items()
        if symbol.name in scene.state
    }


def _of_closed_form(closed, points):
    """Densities and their errors; the variables are independent."""
    found = {(name,): closed[name](points[name]) for name in closed}
    found = {key: Density(value, float(np.max(error))) for key, (value, error) in found.items()}
    if len(closed) > 1:
        velocity, displacement = found["y",], found["x",]
        found["y", "x"] = Density(
            np.outer(velocity.value, displacement.value),
            velocity.error * displacement.value.max() + displacement.error * velocity.value.max(),
        )
    return found


def _dataset(found, points):
    coords = {key[0]: (key, points[key[0]], TITLES[key[0]]) for key in found if len(key) == 1}
    variables = {}
    for key, density in found.items():
        name, title = f"density_{'_'.join(key)}", f"density of the {_titles(key)}"
        variables[name] = key, density.value, title
        variables[f"{name}_error"] = (), density.error, f"error of the {title}"
    data = dataset(coords, variables)
    for key, density in found.items():
        if density.averaged:
            data[f"density_{'_'.join(key)}"].attrs["cell_methods"] = f"{': '.join(key)}: mean"
    return data


def _titles(names):
    return " and the ".join(TITLES[name] for name in names)
