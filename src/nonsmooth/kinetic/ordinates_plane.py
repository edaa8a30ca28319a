"""Discrete ordinates of two state variables: the generator on half of a tensor grid.

For an odd drift and an odd g, functions are odd or even in the state, and half of the grid is
enough. Nodes with g != 0 are said to move. There are fewer elements than `grids.mesh` makes,
because adding and doubling costs the cube of the number of nodes that move; they are graded to
where g = 0.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
import sympy

from nonsmooth.errors import ToleranceError
from nonsmooth.grids.direct_solver import DirectSolver, folded
from nonsmooth.grids.elements import Axis, continuous, discontinuous
from nonsmooth.grids.generator import Change, assemble, evaluate, start_row
from nonsmooth.grids.grading import distinct, graded, mirrored
from nonsmooth.grids.mesh.axes import variables
from nonsmooth.grids.mesh.edges import kinks
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import around_start, fitted
from nonsmooth.kinetic import tuning
from nonsmooth.scenes.scene import Scene


class UnstableError(RuntimeError):
    """A grid whose generator is far from dissipative, so that solutions grow."""


@dataclass(frozen=True)
class PlaneOrdinates:
    """Half of a grid, functions being odd or even in the state.

    Its unknowns are ordered: first those of nodes that move, then the others.

    Attributes
    ----------
    speeds : numpy.ndarray, shape (k,)
        g at the nodes that move.
    masses : numpy.ndarray, shape (k,)
        Positive weights of these nodes in whose inner product the generator hardly amplifies: the
        invariant measure, and where paths go soon after the start.
    ones : numpy.ndarray
        The function 1, in the unknowns of even functions.
    way : float
        How far int g goes within a relaxation time: the standard deviation of g times 1/C_b.
    generator : dict
        A for each parity, sparse.
    start : dict
        Row vectors that interpolate functions of each parity at the start.
    change : dict, optional
        Derivative of the generator on the same nodes, for each parity, sparse.

    Raises
    ------
    ToleranceError
        If no node moves.
    """

    speeds: np.ndarray
    masses: np.ndarray
    ones: np.ndarray
    way: float
    generator: dict
    start: dict
    change: dict | None = None

    def __post_init__(self) -> None:
        """Refuse a grid on which nothing happens."""
        if len(self.speeds) == 0:
            raise ToleranceError(
                "g is 0 as far as grids reach, where paths hardly ever leave; choose another "
                "observable, or method='monte_carlo'"
            )

    def changed(self, part: complex) -> "PlaneOrdinates":
        """Add a part of the derivative to the generator."""
        assert self.change is not None
        generator = {parity: A + part * self.change[parity] for parity, A in self.generator.items()}
        return replace(self, generator=generator)


def boxed(scene: Scene) -> dict:
    """Half widths of a box that contains the invariant density and the start.

    Raises
    ------
    ToleranceError
        If the start is outside of that density: functions on the grids are weighted by it, and all
        levels may agree on a wrong probability.
    """
    ends = fitted(scene, tuning.PLANE_ORDINATES.depth, 0).ends
    for symbol, end in ends.items():
        start = scene.start.get(symbol.name, 0.0)
        if abs(start) > end:
            raise ToleranceError(
                f"the start {symbol} = {start:g} is too far in the tails, beyond {end:.2g}, where "
                "grids of two variables are not accurate; start nearer or use method='monte_carlo'"
            )
    return around_start(scene, ends)


def plane_ordinates(
    scene: Scene,
    ends: dict,
    level: tuning.PlaneLevel,
    time: float,
    change: Change | None = None,
) -> PlaneOrdinates:
    """Discretise a scene with two state variables, finite n, odd drift and odd g.

    Parameters
    ----------
    scene : Scene
    ends : dict
        Half widths of the box.
    level : PlaneLevel
        Resolution.
    time : float
        Shortest time of interest, "1".
    change : Change, optional
        Of the scene, if derivatives are wanted.

    Returns
    -------
    PlaneOrdinates
    """
    made = axes(scene, ends, level, time)
    solve = DirectSolver(scene, made, True)
    g = solve.fold(evaluate(scene.numerical_observable(), made))
    row, half = start_row(scene, made), len(g)
    start = {parity: row[:half] + parity * row[half:][::-1] for parity in (ODD, EVEN)}
    if not any(scene.start.values()):
        start[ODD][:] = 0  # elements that end at the centre give odd functions half of a jump there
    weights = _weights(solve, start[EVEN], time)
    moving = _carriers(weights * np.abs(g), level.dropped)
    order = np.append(moving, np.setdiff1d(np.arange(half), moving))

    def ordered(whole):
        return {p: folded(whole, p)[order][:, order].tocsc() for p in (ODD, EVEN)}

    return PlaneOrdinates(
        g[moving],
        weights[moving],
        np.ones(len(order)),
        math.sqrt(weights @ g**2 / weights.sum()) / scene.damping,
        ordered(solve.generator),
        {p: start[p][order] for p in (ODD, EVEN)},
        None if change is None else ordered(assemble(scene, made, change=change)),
    )


def _weights(solve, start, time):
    """Masses of the invariant measure and of the nodes visited soon after the start."""
    matrix = sp.eye_array(len(start)) / time - solve.matrix(EVEN)
    visited = spla.splu(matrix.T.tocsc()).solve(start) / time
    return np.abs(2 * solve.fold(solve.stationary())) + np.abs(visited)


def _carriers(amounts, dropped):
    """Find the nodes that carry the sum of what is at all nodes, but for a small part of it."""
    order = np.argsort(amounts)
    return np.sort(order[np.cumsum(amounts[order]) > dropped * amounts.sum()])


def axes(
    scene: Scene, ends: dict, level: tuning.PlaneLevel, time: float
) -> dict[sympy.Symbol, Axis]:
    """Make the axes of a tensor grid: no node is its own mirror image.

    Parameters
    ----------
    scene, ends, level, time
        As for `plane_ordinates`.

    Returns
    -------
    dict
        From symbols to axes.
    """
    made = {}
    for symbol in variables(scene):
        edges, degree = _elements(scene, symbol, ends[symbol], level, time)
        make = continuous if symbol == scene.noise.driven else discontinuous
        made[symbol] = make(edges, degree)
    return made


def _elements(scene, symbol, end, level, time):
    """Edges of one variable: ends, kinks, and those graded to where g = 0; and their degrees."""
    settings, knot = tuning.PLANE_ORDINATES, kinks(scene).get(symbol, 0.0)
    force = scene.observes_penalty_force and scene.mechanics.argument.name == "x"
    observed = symbol in scene.numerical_observable().free_symbols

    def symmetric(*edges):
        edges = np.hstack(edges)
        return mirrored(distinct(edges[(edges > 1e-12 * end) & (edges <= end)], 1e-9 * end))

    if symbol == scene.noise.driven:
        if not (observed or force):
            return symmetric(knot, end / 2, end), level.driven
        degree, coarsest = level.observed
        finest = min(end / coarsest, settings.fast * scene.noise.sigma * math.sqrt(time))
        return symmetric(graded(end, finest, settings.ratio), knot), degree
    wall = knot < end and scene.mechanics.argument == symbol and symbol.name == "x"
    edges = np.array([knot, end])
    if wall:
        edges = np.append(edges, knot + (end - knot) * settings.in_wall)
    if force:  # g = 0 up to the kink
        largest, finest = (knot / part for part in settings.beside_knot)
        return symmetric(edges, knot - graded(largest, finest, level.ratio)), level.other
    if wall and not observed:  # nothing happens between the walls
        soft = level.soft is not None and end - knot > settings.soft * knot
        degree, places = level.soft if soft else level.between
        edges = symmetric(edges, knot * np.array(places))
        inside = np.abs(edges[1:] + edges[:-1]) < 2 * knot
        return edges, np.where(inside, degree, level.other)
    inner = knot if wall else end
    finest = max(level.finest * inner, 0.0 if wall else knot)
    return symmetric(edges, settings.outer * inner, graded(inner, finest, level.ratio)), level.other
