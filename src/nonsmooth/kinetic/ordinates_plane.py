"""Discrete ordinates of two state variables: the generator on half of a tensor grid.

The elements are fewer than those of `mesh`, for the cost is the cube of the number of nodes that
move, g != 0; they are graded to where g = 0.
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

_DEPTH = 14.0  # the density outside the box is of the order exp(-14) of its maximum
# polynomial degree of the variable that noise drives and of the other; ratio of graded edges, and
# the element where g = 0, relative to the end: of slabs, and of a march, which many nodes cost less
_LEVELS = (
    (4, 2, 4.0, 0.1),
    (5, 3, 4.0, 0.1),
    (6, 3, 4.0, 0.1),
    (7, 4, 3.0, 0.1),
    (6, 4, 3.0, 0.01),
    (8, 4, 3.0, 0.01),
    (8, 4, 2.0, 0.01),
)
_FAST = 1.5  # the same in a variable that noise drives, in units of sigma sqrt(t)
_WITHIN = (0.125, 0.35)  # edges in a wall, relative to its depth
DROPPED = 1e-5  # part of the mean of |g| that nodes may carry that are taken to stand still


@dataclass(frozen=True)
class PlaneOrdinates:
    """Half of a tensor grid, functions being odd or even.

    Attributes
    ----------
    speeds : numpy.ndarray, shape (k,)
        g at the moving nodes.
    ones : numpy.ndarray
        The function 1, at all nodes of even functions.
    way : float
        Standard deviation of g times the relaxation time of the damping.
    held : int
        Number of nodes that stand still, but cannot be eliminated, for they may be stuck.
    generator : dict
        A for each parity, sparse: the moving nodes, those held, and the others.
    start : dict
        Row vectors that interpolate functions of each parity at the start.
    """

    speeds: np.ndarray
    ones: np.ndarray
    way: float
    held: int
    generator: dict
    start: dict

    def scattering(self, z, parity):
        """Return z - A on the moving nodes and those held, having eliminated the others."""
        many, A = len(self.speeds) + self.held, self.generator[parity]
        matrix = z * sp.eye_array(A.shape[0], format="csc") - A
        own = matrix[:many, :many].toarray()
        if many >= A.shape[0]:
            return own
        across = matrix[many:, :many].toarray()
        return own - matrix[:many, many:] @ spla.splu(matrix[many:, many:].tocsc()).solve(across)

    def start_row(self, z, parity):
        """Row vector that interpolates at the start from the moving nodes.

        Where nodes stand still, (z - A) h = 0.
        """
        many, row, A = len(self.speeds), self.start[parity], self.generator[parity]
        if not np.any(row[many:]):
            return row[:many]
        still = (z * sp.eye_array(A.shape[0], format="csc") - A)[many:]
        weights = spla.splu(still[:, many:].T.tocsc()).solve(row[many:] + 0 * z)
        return row[:many] - weights @ still[:, :many]


def boxed(scene):
    """Half widths of a box that holds the invariant density and the start."""
    ends = fitted(scene, _DEPTH, 0).ends
    return {
        symbol: max(end, 1.25 * abs(scene.start.get(symbol.name, 0.0)))
        for symbol, end in ends.items()
    }


def plane_ordinates(scene, ends, level, time):
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
    """Find the nodes that carry the mean of |g|, of the stationary law and from the start."""
    matrix = sp.eye_array(len(g)) / time - solve.matrix(EVEN)
    visited = spla.splu(matrix.T.tocsc()).solve(start) / time
    flow = np.abs(g) * (np.abs(2 * solve.fold(solve.stationary())) + np.abs(visited))
    order = np.argsort(flow)
    return np.sort(order[np.cumsum(flow[order]) > DROPPED * flow.sum()])


def _axes(scene, ends, level, time):
    driven_degree, degree, ratio, finest = _LEVELS[level]
    made = {}
    for symbol in variables(scene):
        end = ends[symbol]
        edges = _positive(scene, symbol, end, ratio, finest, time)
        edges = mirrored(distinct(edges[(edges > 1e-12 * end) & (edges <= end)], 1e-9 * end))
        if symbol == scene.noise.driven:
            made[symbol] = continuous(edges, driven_degree)
        else:
            made[symbol] = discontinuous(edges, degree)
    return made


def _positive(scene, symbol, end, ratio, share, time):
    """Edges on one side of the origin."""
    knot = kinks(scene).get(symbol, 0.0)
    force = scene.observes_penalty_force and scene.mechanics.argument.name == "x"
    observed = symbol in scene.numerical_observable().free_symbols
    if symbol == scene.noise.driven:
        if not (observed or force):
            return np.array([knot, end / 2, end])
        finest = min(end / 9, _FAST * scene.noise.sigma * math.sqrt(time))
        return np.append(graded(end, finest, ratio), knot)
    wall = knot < end and scene.mechanics.argument == symbol and symbol.name == "x"
    edges = np.array([end, knot])
    if wall:
        edges = np.append(edges, knot + (end - knot) * np.array(_WITHIN))
    if force:
        return np.append(edges, knot - graded(knot / 2, knot / 64, ratio))
    inner = knot if wall else end
    return np.append(edges, graded(inner, max(share * inner, 0.0 if wall else knot), ratio))
