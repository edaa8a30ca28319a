"""gamma^2 of scenes with several variables, on tensor grids that are refined until it settles.

Many grids, of which none is fine in all variables, are combined (`combination`); what the grids
beyond would add is the error.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.grids import mesh
from nonsmooth.grids.alternating_solver import Split
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.solvers import ODD, Direct

MARGIN = 0.15  # of the box, to see whether it matters
_SHIFTS = (12.0, 5.0, 30.0, 2.0)  # in the order in which they are likely to be the best
_FITS = 4
SPARE = 10.0  # the density outside the box is exp(-SPARE) smaller than the tolerance
_NORMAL_TAIL = 3.29  # standard deviations outside which a normal variable has the mass _TAIL
_TAIL = 1e-3  # mass outside a box, from which the box of the wanted depth is extrapolated
LARGEST = {2: 120_000, 3: 600_000, 4: 2_500_000}  # grid points


@dataclass(frozen=True)
class Grid:
    """Resolution of a scene's state.

    Attributes
    ----------
    ends : dict
        Half widths of the box.
    levels : dict
        Resolution level of each variable.
    margin : float
        Elements outside the box, see `mesh.axes`.
    shift : float
        Of `poisson.Split`.
    """

    ends: dict
    levels: dict
    margin: float = 0.0
    shift: float = 8.0

    def raised(self, symbol, by=1):
        """Return the grid with one variable resolved better."""
        return replace(self, levels=self.levels | {symbol: self.levels[symbol] + by})


def solver(scene, grid):
    """Discretise a scene; returns the axes and the solver of its Poisson equation."""
    axes = mesh.axes(scene, grid.ends, grid.levels, grid.margin)
    nodes = math.prod(len(axis.nodes) for axis in axes.values())
    mirrored = scene.is_odd() and nodes % 2 == 0  # no node is its own mirror image
    if len(axes) <= 2:
        return axes, Direct(scene, axes, mirrored)
    return axes, Split(scene, axes, mirrored, grid.shift)


def fitted(scene, depth, level):
    """Choose the box and the shift on coarse grids.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    depth : float
        Outside the box, the invariant density is of the order exp(-depth) of its maximum.
    level : int
        Of every variable.

    Returns
    -------
    Grid
    """
    grid = Grid(mesh.box(scene, depth), dict.fromkeys(mesh.variables(scene), level))
    for _ in range(_FITS):
        axes, solve = solver(scene, grid)
        masses = solve.stationary(1e-2).reshape([len(axis.nodes) for axis in axes.values()])
        found = {
            symbol: _extrapolated(
                axis.nodes,
                masses.sum(axis=tuple(k for k in range(len(axes)) if k != place)),
                depth,
            )
            for place, (symbol, axis) in enumerate(axes.items())
        }
        ends = mesh.narrowed(scene, grid.ends, found)
        change = max(abs(math.log(ends[symbol] / grid.ends[symbol])) for symbol in ends)
        grid = replace(grid, ends=ends)
        if change < 0.15:
            break
    return _with_best_shift(scene, grid) if len(grid.levels) > 2 else grid


def _extrapolated(nodes, masses, depth):
    """Half width for a depth, as if the tails beyond what coarse grids resolve were normal."""
    far = np.argsort(-np.abs(nodes))
    outside = np.cumsum(np.maximum(masses[far], 0.0))
    edge = np.interp(_TAIL, outside, np.abs(nodes[far]))
    return min(float(edge * math.sqrt(2 * depth) / _NORMAL_TAIL), 1.5 * nodes[-1])


def _with_best_shift(scene, grid):
    """Try which shift needs the fewest iterations."""
    count = {}
    for shift in _SHIFTS:
        axes, solve = solver(scene, replace(grid, shift=shift))
        solve.most = min(count.values(), default=solve.most)
        try:
            solve.solve(solve.fold(evaluate(scene.numerical_observable(), axes)), ODD, 1e-5)
        except ToleranceError:
            continue
        count[shift] = solve.iterations
    if not count:
        raise ToleranceError(
            "the iteration converges on no coarse grid, as in scenes that mix slowly; "
            "use Monte Carlo"
        )
    return replace(grid, shift=min(count, key=count.get))


def raised(grid, by=1):
    """Return the grid with all variables resolved better."""
    for symbol in grid.levels:
        grid = grid.raised(symbol, by)
    return grid


def points(scene, grid):
    """Return the number of nodes of a grid."""
    axes = mesh.axes(scene, grid.ends, grid.levels)
    return math.prod(len(axis.nodes) for axis in axes.values())


def affordable(scene, grid):
    """Whether a grid is small enough to be solved on."""
    return points(scene, grid) <= LARGEST[len(grid.levels)]
