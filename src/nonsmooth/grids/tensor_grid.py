"""Tensor grids of a scene's state: their box, their resolution, and the solver on them."""

import math
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from sympy import Symbol

from nonsmooth.errors import ToleranceError
from nonsmooth.grids import tuning
from nonsmooth.grids.alternating_solver import AlternatingSolver
from nonsmooth.grids.direct_solver import DirectSolver
from nonsmooth.grids.elements import Axis
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.mesh import box
from nonsmooth.grids.mesh.axes import axes as axes_of
from nonsmooth.grids.mesh.axes import variables
from nonsmooth.grids.solver import ODD, PoissonSolver
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class Grid:
    """Resolution of a scene's state.

    Attributes
    ----------
    ends : dict
        Maps symbols to half widths of the box.
    levels : dict
        Maps symbols to resolution levels, see `mesh.axes.axes`.
    margin : float
        Width of the elements that are added outside the box, see `mesh.axes.axes`.
    shift, adjoint_shift : float
        The shifts of `AlternatingSolver`, if this is used, for the Poisson equation and for the
        invariant measure.
    of_density : bool
        Whether densities are solved for, see `mesh.axes.axes`.
    """

    ends: Mapping[Symbol, float]
    levels: Mapping[Symbol, int]
    margin: float = 0.0
    shift: float = tuning.ALTERNATING_DIRECTIONS.shift
    adjoint_shift: float = tuning.ALTERNATING_DIRECTIONS.shift
    of_density: bool = False

    def raised(self, symbol: Symbol) -> "Grid":
        """Return the grid with one variable resolved better."""
        return replace(self, levels={**self.levels, symbol: self.levels[symbol] + 1})

    def all_raised(self, by: int = 1) -> "Grid":
        """Return the grid with all variables resolved better by so many levels."""
        return replace(self, levels={symbol: level + by for symbol, level in self.levels.items()})

    def at_level(self, level: int, margin: float = 0.0) -> "Grid":
        """Return the grid with all variables at one level."""
        return replace(self, levels=dict.fromkeys(self.levels, level), margin=margin)

    def with_levels(self, levels: Iterable[int]) -> "Grid":
        """Return the grid with a level for each variable, in their order."""
        return replace(self, levels=dict(zip(self.levels, levels, strict=True)))

    def enlarged(self) -> "Grid":
        """Return the grid on a larger box, to see whether its size matters."""
        return replace(self, margin=tuning.TENSOR_GRIDS.margin)


def solver(
    scene: Scene, grid: Grid, odd: bool | None = None
) -> tuple[dict[Symbol, Axis], PoissonSolver]:
    """Discretise a scene.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    grid : Grid
    odd : bool, optional
        Whether all functions of interest are odd or even in the state, so that half of the grid is
        enough; unless given, if drift and g are odd.

    Returns
    -------
    axes : dict
        Maps symbols to `Axis`.
    solver : PoissonSolver
        Of the scene's Poisson equation.
    """
    return _discretised(scene, grid, scene.is_odd() if odd is None else odd, grid.shift)


def direct_solver(scene: Scene, grid: Grid) -> tuple[dict[Symbol, Axis], DirectSolver]:
    """Discretise a scene with one or two variables, as `solver` does."""
    axes, found = solver(scene, grid)
    assert isinstance(found, DirectSolver)
    return axes, found


def invariant_measure(
    scene: Scene, grid: Grid, accuracy: float
) -> tuple[dict[Symbol, Axis], np.ndarray]:
    """Solve for the invariant measure, which is even if the drift is odd, whatever g is.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    grid : Grid
    accuracy : float
        Residual of an iterative solver; a direct one ignores it.

    Returns
    -------
    axes : dict
        Maps symbols to `Axis`.
    masses : numpy.ndarray, shape (nodes of the first axis, ...)
        At the nodes, of sum 1.
    """
    axes, solve = _for_measure(scene, grid)
    masses = solve.stationary(accuracy)
    return axes, masses.reshape([len(axis.nodes) for axis in axes.values()])


def _for_measure(scene, grid):
    return _discretised(scene, grid, scene.has_odd_drift(), grid.adjoint_shift)


def _discretised(scene, grid, odd, shift):
    axes = axes_of(scene, grid.ends, grid.levels, grid.margin, grid.of_density)
    # no node is its own mirror image
    mirrored = odd and math.prod(len(axis.nodes) for axis in axes.values()) % 2 == 0
    if len(axes) <= 2:
        return axes, DirectSolver(scene, axes, mirrored)
    return axes, AlternatingSolver(scene, axes, mirrored, shift)


def depth_for(tol: float) -> float:
    """Return the depth of a box that is deep enough for a relative tolerance."""
    return max(math.log(1 / tol), 0.0) + tuning.TENSOR_GRIDS.spare


def fitted(scene: Scene, depth: float, level: int) -> Grid:
    """Choose the box and the shifts on coarse grids.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    depth : float
        Outside the box, the invariant density is of the order exp(-depth) of its maximum.
    level : int
        Resolution level of every variable.

    Returns
    -------
    Grid
    """
    chosen = tuning.TENSOR_GRIDS
    widest = box.half_widths(scene, depth)
    grid = Grid(widest, dict.fromkeys(variables(scene), level))
    if len(grid.levels) > 2:
        grid = replace(grid, adjoint_shift=_adjoint_shift(scene, grid.at_level(0)))
    for _ in range(chosen.fits):
        axes, masses = invariant_measure(scene, grid, chosen.fit_accuracy)
        found = {
            symbol: _extrapolated(
                axis.nodes,
                masses.sum(axis=tuple(k for k in range(len(axes)) if k != place)),
                depth,
            )
            for place, (symbol, axis) in enumerate(axes.items())
        }
        if scene.noise.kind == "white":  # the box is large enough: coarse grids smear the density
            found = {symbol: min(end, widest[symbol]) for symbol, end in found.items()}
        ends = box.narrowed(scene, grid.ends, found)
        change = max(abs(math.log(ends[symbol] / grid.ends[symbol])) for symbol in ends)
        grid = replace(grid, ends=ends)
        if change < chosen.settled:
            break
    if len(grid.levels) > 2:
        grid = replace(grid, shift=_shift(scene, grid.at_level(0)))
    return grid


def around_start(scene: Scene, ends: Mapping[Symbol, float]) -> dict[Symbol, float]:
    """Half widths of a box that contains another one and the start, which is not at its edge."""
    share = tuning.TENSOR_GRIDS.around
    return {
        symbol: max(end, share * abs(scene.start.get(symbol.name, 0.0)))
        for symbol, end in ends.items()
    }


def _extrapolated(nodes, masses, depth):
    """Half width at a depth; beyond what coarse grids resolve, tails are taken to be normal."""
    chosen = tuning.TENSOR_GRIDS
    far = np.argsort(-np.abs(nodes))
    outside = np.cumsum(np.maximum(masses[far], 0.0))
    edge = np.interp(chosen.tail, outside, np.abs(nodes[far]))
    width = float(edge * math.sqrt(2 * depth) / chosen.normal_tail)
    return min(width, chosen.widening * nodes[-1])


def _adjoint_shift(scene, grid):
    """Choose the shift for the invariant measure."""

    def iterations(shift, most):
        _, solve = _for_measure(scene, replace(grid, adjoint_shift=shift))
        solve.most = min(solve.most, most)
        solve.stationary(tuning.TENSOR_GRIDS.fit_accuracy)
        return solve.iterations

    return _best_shift(iterations)


def _shift(scene, grid):
    """Choose the shift for the Poisson equation."""

    def iterations(shift, most):
        axes, solve = solver(scene, replace(grid, shift=shift))
        solve.most = min(solve.most, most)
        g = solve.fold(evaluate(scene.numerical_observable(), axes))
        solve.solve(g, ODD, tuning.ALTERNATING_DIRECTIONS.pilot_accuracy)
        return solve.iterations

    return _best_shift(iterations)


def _best_shift(iterations):
    """Return the shift that needs the fewest iterations, going on from one to the next better one.

    `iterations` takes a shift and how many there may be, and raises a `ToleranceError` if there are
    more.
    """
    shifts = tuning.ALTERNATING_DIRECTIONS.shifts
    count: dict[float, int] = {}

    def try_in_turn(untried):
        for shift in untried:
            before = min(count.values(), default=math.inf)
            with suppress(ToleranceError):
                count[shift] = iterations(shift, before)
            if before < math.inf and shift not in count:
                break

    likeliest = shifts.index(tuning.ALTERNATING_DIRECTIONS.shift)
    try_in_turn(shifts[likeliest:])
    if min(count, key=count.__getitem__, default=shifts[likeliest]) == shifts[likeliest]:
        try_in_turn(reversed(shifts[:likeliest]))
    if not count:
        raise ToleranceError(
            "the iteration converges on no coarse grid, as in scenes that mix slowly; "
            "use Monte Carlo"
        )
    return min(count, key=count.__getitem__)


def points(scene: Scene, grid: Grid) -> int:
    """Return the number of nodes of a grid."""
    axes = axes_of(scene, grid.ends, grid.levels, of_density=grid.of_density)
    return math.prod(len(axis.nodes) for axis in axes.values())
