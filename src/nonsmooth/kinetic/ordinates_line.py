"""Discrete ordinates: the generator A on nodes of the state, and the resolvent (z - A)^-1.

A is discretised by spectral elements in L^2(m) with Gauss-Lobatto quadrature, so that the mass
matrix and multiplication by g are diagonal. Next to the threshold, functions behave like |y|^(1/2)
where g = 0 (grazing); the elements are graded towards the zeros of g.
"""

from dataclasses import dataclass

import numpy as np

from nonsmooth.grids.elements import continuous, lobatto
from nonsmooth.grids.grading import distinct
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.line.kinks import isolated_zeros, sign_changes, switches
from nonsmooth.line.potential import potential
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised

UNHURRIED = 1e3  # a time beyond which the grid no longer depends on it, in units of 1 / C_b
_DEEPEST = 40.0  # the grid ends where the density has fallen by exp(-40)
_STEEPEST = 12.0  # logarithm of the ratio of the densities at the ends of an element
_GRADING = 3.0
_FINEST = 0.1  # width at a zero of g; the error is of the order of its cube
# width relative to the spread of velocities on the way to a wall; depth over which all digits count
_CROSSING, _DIGITS = 3.0, 26.0
_PASSING = 1.0  # width at the start; the solution is smooth there
_REACH = 12.0  # velocities reached within a time t are these many times sigma sqrt(t)


@dataclass(frozen=True)
class Ordinates:
    """Nodes of a one-dimensional scene, or its half grid if drift and g are odd.

    Attributes
    ----------
    mirrored : bool
        Whether the grid is the half y >= 0, functions being even or odd.
    nodes, g, masses : numpy.ndarray, shape (k,)
        Velocities, the centred observable, and the invariant measure, of sum 1.
    stiffness : dict
        (sigma^2/2) <phi_i', phi_j'> for each parity, of the same scale as `masses`.
    start : dict
        Row vectors that interpolate functions of each parity at the start.
    """

    mirrored: bool
    nodes: np.ndarray
    g: np.ndarray
    masses: np.ndarray
    stiffness: dict
    start: dict

    @property
    def moving(self):
        """Indices of the nodes with g != 0."""
        return np.flatnonzero(self.g)

    def resolvent(self, z, parity, values):
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

    def regular(self, z, values):
        """Solve (z - A) u = f in even functions but for E f / z: what is finite as z -> 0.

        Parameters
        ----------
        z, values
            As of `resolvent`.

        Returns
        -------
        numpy.ndarray, shape (k, c)
        """
        masses, stiffness = self.masses, self.stiffness[EVEN]
        # the difference to the value at the likeliest node, and that value from the mean: what is
        # left of stiffness is regular, however small z
        pin = np.argmax(masses)
        rest = np.delete(np.arange(len(masses)), pin)
        weights = masses[rest]
        mean = masses @ values
        matrix = stiffness[np.ix_(rest, rest)] + z * (np.diag(weights) - np.outer(weights, weights))
        difference = np.zeros(values.shape, np.result_type(values, z, float))
        difference[rest] = _solve_scaled(matrix, weights[:, None] * (values[rest] - mean))
        return difference - masses @ difference


def _solve_scaled(matrix, right):
    scale = 1 / np.sqrt(np.abs(np.diag(matrix)))
    return scale[:, None] * np.linalg.solve(matrix * np.outer(scale, scale), scale[:, None] * right)


def ordinates(
    scene,
    degree,
    time,
    reach=np.inf,
    deepest=_DEEPEST,
    grading=_GRADING,
    distances=(np.inf, np.inf),
):
    """Discretise a scene with the state y.

    Parameters
    ----------
    scene : Scene
    degree : int
        Polynomial degree of the elements.
    time : float
        Shortest time of interest, "1".
    reach : float
        Largest change of velocity that matters.
    deepest : float
        The grid ends where the density has fallen by exp(-deepest), "1".
    grading : float
        Greatest width of an element over its distance to a zero of g and to the start.
    distances : (float, float)
        To the lower and to the upper wall.

    Returns
    -------
    Ordinates
    """
    energy, knot = potential(scene)
    depth = vectorised(energy, (symbols.y,))
    expression = scene.numerical_observable()
    observable = vectorised(expression, (symbols.y,))
    edges = _edges(
        scene,
        depth,
        [knot, -knot],
        [expression, *switches(expression)],
        time,
        reach,
        deepest,
        grading,
        distances,
    )
    axis = continuous(edges, degree)
    y = axis.nodes
    density = np.exp(-depth(y))
    masses = axis.weights * density
    total = masses.sum()
    g = observable(y)
    g = np.where(np.abs(g) < 1e-13 * np.max(np.abs(g)), 0.0, g)
    stiffness = _stiffness(axis, degree, density) * scene.noise.sigma**2 / 2 / total
    masses = masses / total
    row = axis.interpolation(scene.start.get("y", 0.0)).toarray()[0]
    if not scene.is_odd():
        return Ordinates(False, y, g, masses, {EVEN: stiffness}, {EVEN: row})
    half = len(y) // 2  # the node y = 0
    upper, lower = slice(half, None), slice(half, None, -1)
    own = np.where(np.arange(len(y) - half) == 0, 0.5, 1.0)  # the node 0 is its own mirror image
    halves, start = {}, {}
    for parity in (ODD, EVEN):
        folded = stiffness[upper, upper] + parity * stiffness[upper, lower]
        halves[parity] = 2 * folded * np.outer(own, own)
        halves[parity][0, 0] = 2 * stiffness[half, half] * 0.5
        start[parity] = (row[upper] + parity * row[lower]) * own
    return Ordinates(True, y[upper], g[upper], 2 * own * masses[upper], halves, start)


def _stiffness(axis, degree, density):
    """<phi_i', phi_j'> by the elements' own quadrature."""
    _, weights, slope = lobatto(degree)
    matrix = np.zeros((len(axis.nodes), len(axis.nodes)))
    for k, width in enumerate(np.diff(axis.edges)):
        here = slice(k * degree, (k + 1) * degree + 1)
        local = slope.T @ ((weights * density[here] * 2 / width)[:, None] * slope)
        # constants have no energy: enforced, or rounding of the smallest elements costs digits
        matrix[here, here] += local - np.diag(local.sum(axis=1))
    return matrix


def _edges(scene, depth, kinks, switches, time, reach, deepest, grading, distances):
    """Edges on kinks and on zeros of g, graded towards these and towards the start."""
    start = scene.start.get("y", 0.0)
    end = scene.noise.sigma * np.sqrt(deepest / scene.damping)
    while depth(0.98 * end) > deepest:
        end *= 0.98
    inside = np.linspace(-end, end, 4001)
    weight = np.exp(-depth(inside))
    fine = min(
        np.sqrt(np.sum(weight * inside**2) / np.sum(weight)), scene.noise.sigma * np.sqrt(time)
    )
    end = min(max(end, abs(start) + _REACH * fine), abs(start) + reach)
    inside = np.linspace(-end, end, 501)
    functions = [vectorised(f, (symbols.y,)) for f in switches]
    zeros, *others = [sign_changes(f, inside) for f in functions]
    zeros = isolated_zeros(functions[0], np.concatenate([zeros, *others]), end)
    starts = [start, -start] if scene.is_odd() else [start]
    singular = np.append(zeros, starts)
    finest = np.append(np.full(len(zeros), _FINEST), np.full(len(starts), _PASSING)) * fine
    g = functions[0]

    def crossing_width(y):
        """Spread of the velocities of paths that go from y to a wall; wider where they are rare."""
        flow = g(y)
        lower, upper = (min(distances),) * 2 if scene.is_odd() else distances
        distance = np.where(flow > 0, upper, lower)
        share = np.clip((deepest - depth(y)) / _DIGITS, 0.1, 1.0)
        return (
            _CROSSING
            * scene.noise.sigma
            * np.sqrt(distance / np.maximum(np.abs(flow), 1e-300))
            / share
        )

    edges = np.concatenate([[-end, 0.0, end], kinks, zeros, *others])
    edges = distinct(edges[np.abs(edges) <= end], 1e-12 * end)
    if scene.is_odd():
        edges = (edges - edges[::-1]) / 2
    while True:
        left, right = edges[:-1], edges[1:]
        distance = np.maximum(left[:, None] - singular, singular - right[:, None])
        allowed = np.min(np.maximum(finest, grading * distance), axis=1)
        allowed = np.minimum(allowed, np.minimum(crossing_width(left), crossing_width(right)))
        steep = np.abs(depth(right) - depth(left)) > _STEEPEST
        split = (right - left > 1.001 * allowed) | steep
        if not split.any():
            return edges
        # a third where one end is singular, so that the elements shrink fast
        left, right = left[split], right[split]
        at_left = np.min(np.abs(left[:, None] - singular), axis=1) < 1e-9 * (right - left)
        at_right = np.min(np.abs(right[:, None] - singular), axis=1) < 1e-9 * (right - left)
        part = np.where(at_left & ~at_right, 0.3, np.where(at_right & ~at_left, 0.7, 0.5))
        edges = np.sort(np.append(edges, left + part * (right - left)))
