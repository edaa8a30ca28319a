"""Discrete ordinates of two state variables: the generator on half of a tensor grid.

For an odd drift and an odd g, functions are odd or even in the state, and half of the grid is
enough. Nodes with g != 0 are said to move. There are fewer elements than `grids.mesh` makes,
because adding and doubling costs the cube of the number of nodes that move; they are graded to
where g = 0.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from nonsmooth.grids.direct_solver import DirectSolver
from nonsmooth.grids.elements import continuous, discontinuous
from nonsmooth.grids.generator import evaluate, start_row
from nonsmooth.grids.grading import distinct, graded, mirrored
from nonsmooth.grids.mesh.axes import variables
from nonsmooth.grids.mesh.edges import kinks
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import fitted
from nonsmooth.kinetic import tuning
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class PlaneOrdinates:
    """Half of a grid, functions being odd or even in the state.

    Its unknowns are ordered: first those of nodes that move, then `held` ones, then the others.

    Attributes
    ----------
    speeds : numpy.ndarray, shape (k,)
        g at the nodes that move.
    ones : numpy.ndarray
        The function 1, in the unknowns of even functions.
    way : float
        How far int g goes within a relaxation time: the standard deviation of g times 1/C_b.
    held : int
        Number of unknowns at nodes that stand still, g = 0, but are not eliminated, because z - A
        restricted to them may be singular.
    generator : dict
        A for each parity, sparse.
    start : dict
        Row vectors that interpolate functions of each parity at the start.
    """

    speeds: np.ndarray
    ones: np.ndarray
    way: float
    held: int
    generator: dict
    start: dict

    def scattering(self, z: complex, parity: int) -> np.ndarray:
        """Return z - A on the nodes that move and those held, the others being eliminated."""
        many, A = len(self.speeds) + self.held, self.generator[parity]
        matrix = z * sp.eye_array(A.shape[0], format="csc") - A
        own = matrix[:many, :many].toarray()
        if many >= A.shape[0]:
            return own
        across = matrix[many:, :many].toarray()
        return own - matrix[:many, many:] @ spla.splu(matrix[many:, many:].tocsc()).solve(across)

    def start_row(self, z: complex, parity: int) -> np.ndarray:
        """Row vector that interpolates at the start from the nodes that move.

        The values at the other nodes follow from (z - A) h = 0 there.
        """
        many, row, A = len(self.speeds), self.start[parity], self.generator[parity]
        if not np.any(row[many:]):
            return row[:many]
        still = (z * sp.eye_array(A.shape[0], format="csc") - A)[many:]
        weights = spla.splu(still[:, many:].T.tocsc()).solve(row[many:] + 0 * z)
        return row[:many] - weights @ still[:, :many]


def boxed(scene: Scene) -> dict:
    """Half widths of a box that contains the invariant density and the start."""
    settings = tuning.PLANE_ORDINATES
    ends = fitted(scene, settings.depth, 0).ends
    return {
        symbol: max(end, settings.start * abs(scene.start.get(symbol.name, 0.0)))
        for symbol, end in ends.items()
    }


def plane_ordinates(scene: Scene, ends: dict, level: int, time: float) -> PlaneOrdinates:
    """Discretise a scene with two state variables, finite n, odd drift and odd g.

    Parameters
    ----------
    scene : Scene
    ends : dict
        Half widths of the box.
    level : int
        Of resolution, from 0.
    time : float
        Shortest time of interest, "1".

    Returns
    -------
    PlaneOrdinates
    """
    axes = _axes(scene, ends, level, time)
    solve = DirectSolver(scene, axes, True)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    row, half = start_row(scene, axes), len(g)
    start = {parity: row[:half] + parity * row[half:][::-1] for parity in (ODD, EVEN)}
    moving = _moving(solve, g, start[EVEN], time)
    order = np.append(moving, np.delete(np.arange(half), moving))
    generator = {parity: solve.matrix(parity)[order][:, order].tocsc() for parity in (ODD, EVEN)}
    way = math.sqrt(np.abs(2 * solve.fold(solve.stationary())) @ g**2) / scene.damping
    return PlaneOrdinates(
        g[moving],
        np.ones(half),
        way,
        0,
        generator,
        {p: start[p][order] for p in (ODD, EVEN)},
    )


def _moving(solve, g, start, time):
    """Find the nodes that carry the mean of |g|, in the long run and soon after the start."""
    matrix = sp.eye_array(len(g)) / time - solve.matrix(EVEN)
    visited = spla.splu(matrix.T.tocsc()).solve(start) / time
    flow = np.abs(g) * (np.abs(2 * solve.fold(solve.stationary())) + np.abs(visited))
    order = np.argsort(flow)
    return np.sort(order[np.cumsum(flow[order]) > tuning.PLANE_ORDINATES.dropped * flow.sum()])


def _axes(scene, ends, level, time):
    settings, made = tuning.PLANE_ORDINATES.levels[level], {}
    for symbol in variables(scene):
        end = ends[symbol]
        edges = _positive_edges(scene, symbol, end, settings, time)
        edges = mirrored(distinct(edges[(edges > 1e-12 * end) & (edges <= end)], 1e-9 * end))
        if symbol == scene.noise.driven:
            made[symbol] = continuous(edges, settings.driven)
        else:
            made[symbol] = discontinuous(edges, settings.other)
    return made


def _positive_edges(scene, symbol, end, level, time):
    """Edges > 0 of one variable: ends, kinks, and those graded to where g = 0."""
    settings, knot = tuning.PLANE_ORDINATES, kinks(scene).get(symbol, 0.0)
    force = scene.observes_penalty_force and scene.mechanics.argument.name == "x"
    observed = symbol in scene.numerical_observable().free_symbols
    if symbol == scene.noise.driven:
        if not (observed or force):
            return np.array([knot, end / 2, end])
        fast = settings.fast * scene.noise.sigma * math.sqrt(time)
        return np.append(graded(end, min(end / settings.coarsest, fast), level.ratio), knot)
    wall = knot < end and scene.mechanics.argument == symbol and symbol.name == "x"
    edges = np.array([end, knot])
    if wall:
        edges = np.append(edges, knot + (end - knot) * np.array(settings.in_wall))
    if force:  # g = 0 up to the kink
        largest, finest = (knot / part for part in settings.beside_knot)
        return np.append(edges, knot - graded(largest, finest, level.ratio))
    inner = knot if wall else end
    finest = max(level.finest * inner, 0.0 if wall else knot)
    return np.append(edges, graded(inner, finest, level.ratio))
