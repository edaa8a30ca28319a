"""The invariant density of Z^n (Theorem 4 of the paper) and its marginals, without Monte Carlo.

Dry friction and obstacles with white noise have closed forms. Elsewhere the masses of the
discretised invariant measure at the nodes of a tensor grid are divided by the nodes' weights.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike
from scipy.integrate import quad
from scipy.ndimage import maximum_filter1d

from nonsmooth.checks import require_list, require_tolerance
from nonsmooth.errors import SceneError, ToleranceError, answered, quoted
from nonsmooth.estimate import not_negative
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.mesh.box import half_widths
from nonsmooth.grids.mesh.edges import kinks
from nonsmooth.grids.tensor_grid import Grid
from nonsmooth.line import quadrature
from nonsmooth.refine import until_agreement
from nonsmooth.results import dataset
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.scene import Scene, require_random
from nonsmooth.scenes.symbols import STATE_VARIABLES, TITLES
from nonsmooth.statistics import tuning


def invariant_density(
    scene: Scene, tol: float | None = None, points: Mapping[str, ArrayLike] | None = None
) -> xr.Dataset:
    """Invariant density: marginals of every variable and of the last two together.

    Parameters
    ----------
    scene : Scene
        With a finite n, unless there is a closed form: at n = inf mass concentrates on sets of
        measure zero else.
    tol : float, optional
        Error allowed, relative to the largest value of each density. Unless given, it is 1e-8,
        1e-6, 1e-2 or 5e-2 for one to four variables, and what misses that within about half a
        minute is returned with a warning.
    points : dict, optional
        Maps the names of all variables of the state to points at which the densities are wanted;
        201 equidistant ones over the support unless given.

    Returns
    -------
    xarray.Dataset
        `density_y` and so on over the points of each variable, and the joint density of the last
        two variables of the state, `density_y_x` or `density_eta_y`. Each has an error
        (`density_y_error`), the largest difference between two grids. Solutions on grids oscillate
        about 0 where a density is small; negative values become 0. Where there is a closed form
        (dry friction and obstacles with white noise), it is the error of the normalisation.

    Raises
    ------
    SceneError
        If an argument is out of range, or there is no density at n = inf.
    ToleranceError
        If `tol` cannot be met; the best densities are its `result`.
    """
    require_random(scene)
    tol_given = tol is not None
    tol = None if tol is None else require_tolerance(tol)
    points = None if points is None else _require_points(scene, points)
    tol = tuning.INVARIANT_DENSITY.tol[scene.dimension] if tol is None else tol
    tol = min(tol, tuning.INVARIANT_DENSITY.loosest)
    if closed := closed_form(scene):
        if points is None:
            points = _equidistant(half_widths(scene, tensor_grid.depth_for(tol)))
        found, error = _of_closed_form(closed, points)
        return _dataset(found, error, points)
    _require_finite(scene)
    grid = _first_grid(scene, tol)
    if points is None:
        points = _equidistant(grid.ends)
    names = [symbol.name for symbol in STATE_VARIABLES if symbol.name in scene.state]
    accuracy = tol * tuning.INVARIANT_DENSITY.residual

    def present(refined):
        clipped = {key: not_negative(*both) for key, both in refined.items()}
        return _dataset(
            {key: value for key, (value, _) in clipped.items()},
            {key: np.max(error) + _outside(value, tol) for key, (value, error) in clipped.items()},
            points,
        )

    most = math.inf if tol_given else tuning.INVARIANT_DENSITY.largest[scene.dimension]
    return answered(
        lambda: _refined(
            scene, grid, tol, lambda grid: densities_on(scene, grid, names, points, accuracy), most
        ),
        present,
        tol_given,
    )


def _first_grid(scene, tol):
    """Return the first grid, with a box that suits the tolerance."""
    chosen = tuning.INVARIANT_DENSITY
    level = chosen.fitted[scene.dimension]
    grid = tensor_grid.fitted(scene, tensor_grid.depth_for(tol), level)
    return grid.all_raised(chosen.first - level)


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


def _of_closed_form(closed, points):
    """Densities and their errors; the variables are independent."""
    found = {(name,): closed[name](points[name])[0] for name in closed}
    error = {(name,): np.max(closed[name](points[name])[1]) for name in closed}
    if len(closed) > 1:
        found["y", "x"] = np.outer(found["y",], found["x",])
        error["y", "x"] = error["y",] * found["x",].max() + error["x",] * found["y",].max()
    return found, error


def _refined(scene, grid, tol, solve, most=math.inf):
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
    most : float
        Points of the finest grid.

    Returns
    -------
    dict
        For each array the pair of its values on the last grid and of their differences to those on
        the one before. Two grids may agree where the error changes its sign, so a difference counts
        as at least a part of the one before.
    """

    def difference(found):
        change = {key: np.zeros_like(values) for key, values in found[0].items()}
        for coarse, fine in pairwise(found):
            change = {
                key: np.maximum(
                    np.abs(fine[key] - coarse[key]),
                    change[key] / tuning.INVARIANT_DENSITY.gain,
                )
                for key in fine
            }
        return change

    def relative(values, difference):
        return max(np.max(difference[key]) / np.max(values[key]) for key in values)

    result = until_agreement(
        _affordable(scene, grid, most),
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


def _affordable(scene: Scene, grid: Grid, most: float) -> Iterator[Grid]:
    """Yield a grid and finer ones, as long as they can be solved on and have few enough points."""
    yield grid
    while (
        tensor_grid.affordable(scene, grid := grid.all_raised())
        and tensor_grid.points(scene, grid) <= most
    ):
        yield grid


def _dataset(found, error, points):
    coords = {key[0]: (key, points[key[0]], TITLES[key[0]]) for key in found if len(key) == 1}
    variables = {}
    for key, value in found.items():
        name, title = f"density_{'_'.join(key)}", f"density of the {_titles(key)}"
        variables[name] = key, value, title
        variables[f"{name}_error"] = (), error[key], f"error of the {title}"
    return dataset(coords, variables)


def _titles(names):
    return " and the ".join(TITLES[name] for name in names)


def _require_finite(scene):
    if math.isinf(scene.n):
        raise SceneError(
            "at n = inf the invariant measure of this package's models has no density in general; "
            "choose a finite n"
        )


def closed_form(scene: Scene) -> dict[str, Callable]:
    """Marginal densities of the scenes whose variables are independent and known in closed form.

    Returns
    -------
    dict
        Name -> function of points that returns values and errors. A velocity alone with white
        noise has a density by quadrature; obstacles with white noise have the Gibbs measure
        exp(-2 C_b/sigma^2 (y^2/2 + U_n(x))), at n = inf between the walls. The dict is empty for
        all other scenes.
    """
    if scene.is_line:
        return {"y": lambda y: quadrature.density(scene, y)}
    if scene.noise.kind != "white" or not scene.mechanics.in_potential:
        return {}
    inverse = 2 * scene.damping / scene.noise.sigma**2
    U, rigid = scene.potential_expression, math.isinf(scene.n)
    if not rigid:
        U += scene.mechanics.added_potential.subs(penalization, scene.n)
    energy = vectorised(U, (STATE_VARIABLES[-1],))
    end = half_widths(scene, tuning.INVARIANT_DENSITY.deepest)[STATE_VARIABLES[-1]]
    lowest = float(np.min(energy(np.linspace(-end, end, 2001))))
    wall, _, _ = scene.mechanics.penalty.at(scene.n)
    pieces = np.unique([-end, -wall, 0.0, wall, end])

    def shape(x):
        x = np.asarray(x, dtype=float)
        if not rigid:
            return np.exp(-inverse * (energy(x) - lowest))
        held = np.clip(x, -wall, wall)  # beyond, a potential may fall without bound
        return np.where(x == held, np.exp(-inverse * (energy(held) - lowest)), 0.0)

    # with its full output it does not warn of an error that is returned anyway
    parts = [
        quad(shape, *ends, epsabs=0, epsrel=1e-12, limit=200, full_output=True)[:2]
        for ends in pairwise(pieces)
    ]
    total, error = (sum(part) for part in zip(*parts, strict=True))

    def velocity(y):
        value = math.sqrt(inverse / (2 * math.pi)) * np.exp(-inverse * np.square(y) / 2)
        return value, 4 * np.finfo(float).eps * value * (1 + inverse * np.square(y))

    def displacement(x):
        value = shape(x) / total
        depth = inverse * np.abs(energy(np.asarray(x, dtype=float)))
        return value, value * (error / total + 8 * np.finfo(float).eps * (1 + depth))

    return {"y": velocity, "x": displacement}


def bin_averages(
    scene: Scene, edges: Mapping[str, ArrayLike], tol: float
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Invariant probabilities of bins, divided by their widths: what a histogram estimates.

    Where friction or a wall concentrates the density, averages over bins have converged already on
    grids on which the values at points have not.

    Parameters
    ----------
    scene : Scene
        As for `invariant_density`.
    edges : dict
        Maps names of variables to the edges of their bins.
    tol : float
        Error allowed, relative to the largest average of each variable.

    Returns
    -------
    dict
        Name -> (averages, errors), of each bin. On grids the difference of two of them oscillates
        from bin to bin; the error of a bin is twice the largest of those near it, at most the
        largest of all, and what the density may be outside of the grids.

    Raises
    ------
    SceneError
        If there is no density at n = inf.
    ToleranceError
        If `tol` cannot be met.
    """
    if closed := closed_form(scene):
        return _averages_of_closed_form(scene, closed, edges)
    _require_finite(scene)
    grid = _first_grid(scene, tol)
    accuracy = tol * tuning.INVARIANT_DENSITY.residual

    def present(refined):
        clipped = {name: not_negative(*both) for name, both in refined.items()}
        return {
            name: (value, _largest_near(error) + _outside(value, tol))
            for name, (value, error) in clipped.items()
        }

    return answered(
        lambda: _refined(scene, grid, tol, lambda grid: _averages_on(scene, grid, edges, accuracy)),
        present,
    )


def _largest_near(error):
    """Take the largest error of the bins around each, with a margin; at most that of all bins."""
    chosen = tuning.INVARIANT_DENSITY
    reach = math.ceil(len(error) * chosen.near)
    around = maximum_filter1d(error, 2 * reach + 1, mode="nearest")
    return np.minimum(chosen.safety * around, np.max(error))


def _outside(value, tol):
    """Size of a density outside the box of `depth_for(tol)`, where the grids have none."""
    return math.exp(-tensor_grid.depth_for(tol)) * np.max(value)


def _averages_of_closed_form(scene, closed, edges):
    """Averages and their errors, by Gauss quadrature in each bin."""
    chosen, averages = tuning.INVARIANT_DENSITY, {}
    for name, ends in edges.items():
        points, weights = _averaging(ends, _cuts(scene, name), chosen.gauss)
        value, inexact = closed[name](points)
        average = weights @ value
        coarse, fewer = _averaging(ends, _cuts(scene, name), chosen.fewer)
        error = np.abs(average - fewer @ closed[name](coarse)[0]) + weights @ inexact
        averages[name] = average, error
    return averages


def _averages_on(scene, grid, edges, accuracy):
    axes, solve = tensor_grid.solver(scene, grid)
    masses = solve.stationary(accuracy).reshape([len(axis.nodes) for axis in axes.values()])
    found, gauss = {}, tuning.INVARIANT_DENSITY.gauss
    for place, (symbol, axis) in enumerate(axes.items()):
        if symbol.name in edges:
            marginal = masses.sum(axis=tuple(k for k in range(len(axes)) if k != place))
            points, weights = _averaging(edges[symbol.name], axis.edges, gauss)
            found[symbol.name] = weights @ (axis.densities(points) @ marginal)
    return found


def _cuts(scene, name):
    """Return the kinks of one variable, at which bins are cut."""
    return np.array([k for s, k in kinks(scene).items() if s.name == name for k in (-k, k)])


def _averaging(edges, cuts, count):
    """Return quadrature points, and the matrix that turns values there into averages over bins.

    Bins are cut at kinks of the density, so that the quadrature converges in each piece.
    """
    nodes, gauss = leggauss(count)
    inside = cuts[(cuts > edges[0]) & (cuts < edges[-1])]
    pieces = np.unique(np.concatenate([edges, inside]))
    half = np.diff(pieces) / 2
    points = ((pieces[:-1] + half)[:, None] + half[:, None] * nodes).ravel()
    weights = np.zeros((len(edges) - 1, len(half), len(nodes)))
    place = np.clip(np.searchsorted(edges, pieces[:-1] + half) - 1, 0, len(edges) - 2)
    weights[place, np.arange(len(half))] = half[:, None] * gauss
    return points, weights.reshape(len(edges) - 1, -1) / np.diff(edges)[:, None]


def densities_on(
    scene: Scene,
    grid: Grid,
    names: list[str],
    points: Mapping[str, ArrayLike],
    accuracy: float,
) -> dict[tuple[str, ...], np.ndarray]:
    """Marginal densities on one grid.

    Parameters
    ----------
    scene : Scene
    grid : Grid
    names : list of str
        Of all variables of the state; the last two get a joint density, too.
    points : dict
        Maps names to points.
    accuracy : float
        Residual of an iterative solver; a direct one ignores it.

    Returns
    -------
    dict
        Maps tuples of names to values at the points.
    """
    axes, solve = tensor_grid.solver(scene, grid)
    shape = [len(axis.nodes) for axis in axes.values()]
    masses = solve.stationary(accuracy).reshape(shape)
    order = [symbol.name for symbol in axes]
    at = {symbol.name: axis.densities(points[symbol.name]) for symbol, axis in axes.items()}
    found = {}
    for key in [(name,) for name in names] + [tuple(names[-2:])] * (len(names) > 1):
        rest = tuple(place for place, name in enumerate(order) if name not in key)
        joint = masses.sum(axis=rest)
        for place, name in enumerate(name for name in order if name in key):
            joint = np.moveaxis(np.tensordot(at[name], joint, axes=(1, place)), 0, place)
        if [name for name in order if name in key] != list(key):
            joint = joint.T
        found[key] = joint
    return found
