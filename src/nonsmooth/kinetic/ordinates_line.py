"""Discrete ordinates of one state variable: the generator A on nodes, and its resolvent.

A is discretised by spectral elements in L^2(m) with Gauss-Lobatto quadrature, so that the mass
matrix and multiplication by g are diagonal. `mesh_line` says where the elements end.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nonsmooth.grids.elements import Axis, continuous, energy, lobatto, summed
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.mesh_line import element_edges
from nonsmooth.line.potential import depth
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class Ordinates:
    """Nodes of a scene with one state variable, or half of them if drift and g are odd.

    Attributes
    ----------
    axis : Axis
        Elements, of the whole grid.
    mirrored : bool
        Whether the grid is the half y >= 0, functions being even or odd.
    nodes, g, masses : numpy.ndarray, shape (k,)
        Velocities, the observable, and the masses of the invariant measure, of sum 1.
    stiffness : dict
        (sigma^2/2) <phi_i', phi_j'> for each parity, of the same scale as `masses`.
    start : dict
        Row vectors that interpolate functions of each parity at the start.
    """

    axis: Axis
    mirrored: bool
    nodes: np.ndarray
    g: np.ndarray
    masses: np.ndarray
    stiffness: dict
    start: dict

    @property
    def moving(self) -> np.ndarray:
        """Indices of the nodes with g != 0."""
        return np.flatnonzero(self.g)

    @property
    def ones(self) -> np.ndarray:
        """The function 1 at the nodes that move, times the root of the masses."""
        return np.sqrt(self.masses[self.moving])

    def resolvent(self, z: complex, parity: int, values: np.ndarray) -> np.ndarray:
        """Solve (z - A) u = f; for z = 0 and even functions, -A u = f - E f with E u = 0.

        Parameters
        ----------
        z : complex
        parity : {ODD, EVEN}
            EVEN unless the grid is mirrored.
        values : numpy.ndarray, shape (k, c)
            f, in columns.

        Returns
        -------
        numpy.ndarray, shape (k, c)
        """
        masses, stiffness = self.masses, self.stiffness[parity]
        if parity == ODD:  # 0 at the origin, the first node
            inner = slice(1, None)
            solution = np.zeros(values.shape, np.result_type(values, z, float))
            solution[inner] = _solve_scaled(
                stiffness[inner, inner] + z * np.diag(masses[inner]),
                masses[inner, None] * values[inner],
            )
            return solution
        return self.regular(z, values) + (masses @ values / z if z != 0 else 0.0)

    def regular(self, z: complex, values: np.ndarray) -> np.ndarray:
        """Solve (z - A) u = f - E f in even functions: the part of u that is finite as z -> 0.

        Parameters
        ----------
        z, values
            As for `resolvent`.

        Returns
        -------
        numpy.ndarray, shape (k, c)
        """
        masses, stiffness = self.masses, self.stiffness[EVEN]
        # Unknown are the differences to the value at the likeliest node; E u = 0 then gives that
        # value. The stiffness matrix without this node is regular, so that z may be small.
        pin = np.argmax(masses)
        rest = np.delete(np.arange(len(masses)), pin)
        weights = masses[rest]
        mean = masses @ values
        matrix = stiffness[np.ix_(rest, rest)] + z * (np.diag(weights) - np.outer(weights, weights))
        difference = np.zeros(values.shape, np.result_type(values, z, float))
        difference[rest] = _solve_scaled(matrix, weights[:, None] * (values[rest] - mean))
        return difference - masses @ difference


def _solve_scaled(matrix, right):
    """Solve a linear system whose diagonal has been scaled to 1."""
    scale = 1 / np.sqrt(np.abs(np.diag(matrix)))
    return scale[:, None] * np.linalg.solve(matrix * np.outer(scale, scale), scale[:, None] * right)


def ordinates(
    scene: Scene,
    degree: int,
    time: float | None = None,
    reach: float = np.inf,
    deepest: float | None = None,
    grading: float | None = None,
    distances: tuple[float, float] = (np.inf, np.inf),
    fold: bool = True,
) -> Ordinates:
    """Discretise a scene with the state y.

    Parameters
    ----------
    scene : Scene
        With white noise.
    degree : int
        Polynomial degree of the elements.
    time : float, optional
        Shortest time of interest, "1"; many relaxation times unless given.
    reach : float
        Largest change of velocity that matters.
    deepest : float, optional
        The grid ends where the density has fallen by exp(-deepest), "1".
    grading : float, optional
        Greatest width of an element over its distance to a zero of g and to the start.
    distances : (float, float)
        To the lower and to the upper wall.
    fold : bool, optional
        Whether half of the grid is taken if drift and g are odd.

    Returns
    -------
    Ordinates

    Raises
    ------
    SceneError
        If the scene has another state or noise.
    ToleranceError
        If it starts too far in the tails.
    """
    settings = tuning.LINE_ORDINATES
    time = settings.long_time / scene.damping if time is None else time
    deepest = settings.depth if deepest is None else deepest
    grading = settings.grading if grading is None else grading
    axis = continuous(element_edges(scene, time, reach, deepest, grading, distances), degree)
    density = np.exp(-depth(scene)(axis.nodes))
    masses = axis.weights * density
    total = masses.sum()
    g = vectorised(scene.numerical_observable(), (symbols.y,))(axis.nodes)
    g = np.where(np.abs(g) < 1e-13 * np.max(np.abs(g)), 0.0, g)  # so small a g is a rounded zero
    stiffness = _stiffness(axis, degree, density) * scene.noise.sigma**2 / 2 / total
    masses = masses / total
    row = axis.interpolation(scene.start.get("y", 0.0)).toarray()[0]
    grid = Ordinates(axis, False, axis.nodes, g, masses, {EVEN: stiffness}, {EVEN: row})
    return _halved(grid) if fold and scene.is_odd() else grid


def _halved(grid):
    """Restrict a symmetric grid to y >= 0, for odd and for even functions."""
    half = len(grid.nodes) // 2  # the node y = 0
    upper, lower = slice(half, None), slice(half, None, -1)
    own = np.where(grid.nodes[upper] == grid.nodes[half], 0.5, 1.0)  # it is its own mirror image
    stiffness, row = grid.stiffness[EVEN], grid.start[EVEN]
    halves, start = {}, {}
    for parity in (ODD, EVEN):
        folded = stiffness[upper, upper] + parity * stiffness[upper, lower]
        halves[parity] = 2 * folded * np.outer(own, own)
        halves[parity][0, 0] = 2 * stiffness[half, half] * 0.5
        start[parity] = (row[upper] + parity * row[lower]) * own
    masses = 2 * own * grid.masses[upper]
    return Ordinates(grid.axis, True, grid.nodes[upper], grid.g[upper], masses, halves, start)


@dataclass(frozen=True)
class Change:
    """Derivatives of a scene's functions with respect to a parameter.

    Attributes
    ----------
    depth, observable : callable
        Of Phi = -log m up to a constant, and of g, functions of arrays of velocities.
    diffusion : float
        Of log(sigma^2 / 2).
    """

    depth: Callable[[np.ndarray], np.ndarray]
    observable: Callable[[np.ndarray], np.ndarray]
    diffusion: float


@dataclass(frozen=True)
class ChangeOfOrdinates:
    """Derivatives of masses M, of masses times g, and of the stiffness, up to a common factor.

    Attributes
    ----------
    masses, flow : numpy.ndarray, shape (k,)
    stiffness : numpy.ndarray, shape (k, k)
    """

    masses: np.ndarray
    flow: np.ndarray
    stiffness: np.ndarray


def changed(scene: Scene, grid: Ordinates, change: Change) -> ChangeOfOrdinates:
    """Differentiate the discrete equations, on nodes that stay where they are.

    Parameters
    ----------
    scene : Scene
    grid : Ordinates
        Of that scene, whole.
    change : Change

    Returns
    -------
    ChangeOfOrdinates
    """
    axis, degree = grid.axis, len(grid.axis.local[0]) - 1
    bend = -change.depth(axis.nodes) * grid.masses
    flow = bend * grid.g + grid.masses / axis.weights * _summed_within(axis, change.observable)
    density = (bend + change.diffusion * grid.masses) / axis.weights
    stiffness = _stiffness(axis, degree, density) * scene.noise.sigma**2 / 2
    return ChangeOfOrdinates(bend, flow, stiffness)


def _summed_within(axis, function):
    """Values at nodes times weights, each taken within the element of its weight.

    At an edge the function may jump.
    """
    half, middle = np.diff(axis.edges) / 2, (axis.edges[1:] + axis.edges[:-1]) / 2
    degree = len(axis.local[0]) - 1
    _, weights, _ = lobatto(degree)
    inside = (1 - tuning.LINE_ORDINATES.inside) * axis.local[0]
    values = function(middle[:, None] + half[:, None] * inside) * half[:, None] * weights
    total = np.zeros(len(axis.nodes))
    np.add.at(total, np.arange(len(half))[:, None] * degree + np.arange(degree + 1), values)
    return total


def _stiffness(axis: Axis, degree, density):
    """<phi_i', phi_j'> by the elements' own quadrature."""
    _, weights, slope = lobatto(degree)
    return summed(
        energy(slope, weights * density[k * degree : (k + 1) * degree + 1] * 2 / width)
        for k, width in enumerate(np.diff(axis.edges))
    )
