"""The kinetic equation between a far start and the bulk, see `tail_descent`.

There int g moves towards one wall only. In the distance s to this wall the transform
h = E exp(-z tau) solves the parabolic equation |g| d_s h = (A - z) h, with h = 1 at s = 0 and, at
the level of velocity where the bulk begins, the values that `case_modes` has found. It is marched
in s by the implicit Runge-Kutta method Radau IIA, on elements in y that are not weighted by the
invariant density, so that no digits are lost.
"""

import math
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from scipy.integrate import cumulative_trapezoid, trapezoid
from scipy.linalg import solve_banded
from scipy.linalg.lapack import zgbsv

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.grids.elements import Axis, continuous, lagrange
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.case_modes import Waves
from nonsmooth.kinetic.tail_descent import NormalLaw, Tail


@lru_cache(maxsize=16)
def equation(tail: Tail, lower: float, upper: float, degree: int) -> "TailEquation":
    """Return the equation for paths that begin where the start's descent ends."""
    return TailEquation(tail, tail.law(tail.descent), lower, upper, degree)


class TailEquation:
    """The kinetic equation above the level, from the wall to the place of the start.

    Parameters
    ----------
    tail : Tail
    law : NormalLaw
        Of velocity and way at the beginning, conditioned on the wall not being passed.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    degree : int
        Polynomial degree of the elements; a higher one also makes elements and steps shorter.

    Raises
    ------
    SceneError
        If the wall is infinitely far and no bound of the way is found.
    ToleranceError
        If noise is so weak that paths from the start are almost deterministic.
    """

    def __init__(self, tail: Tail, law: NormalLaw, lower: float, upper: float, degree: int):
        self._tail = tail
        distance, self._other = (upper, -lower) if tail.towards > 0 else (-lower, upper)
        self._length = min(distance, reach(tail))
        if np.isinf(self._length):
            raise SceneError(
                "g grows too fast in the tails for a start there; start nearer or use "
                "method='monte_carlo'"
            )
        self._gap = distance - self._length
        # one grid for all z, so that fits in z see no jumps between grids
        settings = tuning.TAIL_EQUATION
        fastest = max(tail.rate, settings.front * front_rate(tail, law, distance))
        size = fastest * 2 ** (degree / settings.degrees)
        points = law.points(self._length)
        self._grid = _Grid(tail, law.top, self._length, points, degree, size)

    def mean(self, z: complex, above: Waves, below: Waves) -> complex:
        """E exp(-z tau), the mean over paths and over the law at the beginning.

        Parameters
        ----------
        z : complex
        above, below : Waves
            Of the two walls, for paths that begin at the level.

        Returns
        -------
        complex
        """
        grid = self._grid
        own, opposite = (above, below) if self._tail.towards > 0 else (below, above)
        ends, later = grid.step * np.arange(grid.count + 1), grid.stages * grid.step
        first: complex = 0.0
        boundary = np.zeros((grid.count, len(grid.stages)), complex)
        if np.isfinite(self._gap):
            first += own.at(self._gap)
            boundary += own.grid(self._gap + ends[:-1], later)
        if np.isfinite(self._other):
            first += opposite.at(self._other + self._length)
            boundary += opposite.grid(self._other + ends[-2::-1], grid.step - later)
        # where the wall is out of reach, the values there do not matter
        return grid.mean(z, first, boundary, 1.0 if self._gap == 0 else first)


def front_rate(tail: Tail, law: NormalLaw, distance: float) -> float:
    """Return how fast W rises when paths reach a wall above the level: one over their spread.

    A small change of the velocity, where it is u, lets a path turn up later at every velocity
    below. So it adds (|g(u)| - |g(v)|) / drift(u) to the way at the time at which it is v.

    Parameters
    ----------
    tail : Tail
    law : NormalLaw
        Of velocity and way at the beginning, as if paths went on beyond the wall.
    distance : float
        Of the wall.

    Returns
    -------
    float
        By the standard deviation to first order in sigma; 0 if the path without noise is at the
        level before.

    Raises
    ------
    ToleranceError
        If it rises so fast that a transform does not tell W.
    """
    start, begun = law.mean
    v = np.linspace(start, tail.level, tuning.TAIL_EQUATION.path)
    way = begun + cumulative_trapezoid(tail.speed(v) / tail.drift(v), -v, initial=0.0)
    if way[-1] < distance:
        return 0.0
    end = np.interp(distance, way, v)
    v = np.linspace(start, end, tuning.TAIL_EQUATION.path)
    drift, added = tail.drift(v), (tail.speed(v) - tail.speed(end)) / tail.drift(v)
    first = np.array([added[0], 1.0])
    variance = tail.sigma**2 * trapezoid(added**2 / drift, -v) + first @ law.covariance @ first
    spread = math.sqrt(max(variance, 0.0)) / float(tail.speed(end))
    if trapezoid(1 / drift, -v) > tuning.TAIL_EQUATION.sharpest * spread:
        raise _too_sharp(tail)
    return 1 / spread


class _Grid:
    """Elements in y and equal steps in s, accurate for |z| up to some size, and stable beyond.

    Attributes
    ----------
    count : int
        Number of steps.
    step : float
        Their length; 0 if nothing moves.
    stages : numpy.ndarray
        Places of the stages within a step, relative to its length.
    """

    def __init__(self, tail, top, length, points, degree, size):
        velocities, ways, masses = points
        axis = _axis(tail, top, degree, size)
        speed, generator = tail.speed(axis.nodes), _generator(tail, axis)
        settings = tuning.TAIL_EQUATION
        self._degree = degree
        slowest = speed[0] if speed[0] > 0 else np.max(speed)
        steps = length * size / (settings.turn * slowest) if slowest > 0 else 1.0
        self.count = max(1, math.ceil(steps))
        self.step = length / self.count
        width = self.step if self.step > 0 else 1.0
        if self.count * len(speed) ** 2 > settings.work:
            raise _too_sharp(tail)
        self._pace = speed[1:] / width
        self._band, self._entering = _band(generator[1:, 1:], degree), generator[1:, 0]
        self.stages, matrix = radau(settings.stages)
        self._shifts, self._vectors = np.linalg.eig(np.linalg.inv(matrix))
        # if nothing moves, the stationary solution is wanted, which the end of a step has
        place = np.clip(length - ways, 0.0, length) / width if length > 0 else np.ones(len(ways))
        where = np.minimum(place.astype(int), self.count - 1)
        within = lagrange(2 * np.append(0.0, self.stages) - 1, 2 * (place - where) - 1)[0]
        across = axis.interpolation(velocities)
        self._first = int(where.min())
        self._weights = np.zeros((self.count - self._first, len(speed), settings.stages + 1))
        for k in np.unique(where):
            here = np.flatnonzero(where == k)
            self._weights[k - self._first] = across[here].T @ (within[here] * masses[here, None])

    def mean(self, z, first, boundary, begin):
        """March in s and take the mean over the law at the beginning.

        Parameters
        ----------
        z : complex
        first : complex
            h at the level, at the wall.
        boundary : numpy.ndarray, shape (count, stages)
            h at the level, in the stages of all steps.
        begin : complex
            h at the wall, above the level.
        """
        carry, enter = self._propagators(z)
        last, changes = np.ascontiguousarray(carry[-1]), boundary @ enter[-1].T
        edge, inner = first, np.full(len(self._pace), begin, complex)
        total = 0.0
        for k in range(self.count):
            if k >= self._first:
                stages = carry @ inner + enter @ boundary[k]
                weights = self._weights[k - self._first]
                total += weights[0, 0] * edge + weights[0, 1:] @ boundary[k]
                total += weights[1:, 0] @ inner + np.sum(weights[1:, 1:].T * stages)
            edge, inner = boundary[k, -1], last @ inner + changes[k]
        return total

    def _propagators(self, z):
        """Matrices from h at the beginning of a step, and from h at the level, to the stages.

        The stages are decoupled by the eigenvectors of the Runge-Kutta matrix.
        """
        degree, size, many = self._degree, len(self._pace), len(self.stages)
        inverse = np.linalg.inv(self._vectors)
        carry = np.empty((many, size, size), complex)
        enter = np.empty((many, size), complex)
        for i, shift in enumerate(self._shifts):
            band = np.zeros((3 * degree + 1, size), complex)
            band[degree:] = -self._band
            band[2 * degree] += shift * self._pace + z
            right = np.zeros((size, size + 1), complex)
            np.fill_diagonal(right, shift * inverse[i].sum() * self._pace)
            right[:, -1] = self._entering
            solution = zgbsv(degree, degree, band, right)[2]
            carry[i], enter[i] = solution[:, :-1], solution[:, -1]
        carry = np.tensordot(self._vectors, carry, 1)
        return carry, np.einsum("ki,in,ij->knj", self._vectors, enter, inverse)


def _axis(tail, top, degree, size=0.0):
    """Elements from the level to beyond `top`, fine enough for exp(-z t) with |z| = `size`.

    Weak noise needs many, because each has the width of what noise spreads.
    """
    settings = tuning.TAIL_EQUATION

    def spread(v):
        return tail.sigma * math.sqrt(v / float(tail.drift(v)))

    edges, end = [tail.level], top + settings.beyond * spread(top)
    while edges[-1] < end:
        if len(edges) > settings.most:
            raise _too_sharp(tail)
        v = edges[-1]
        turned = settings.rotation * float(tail.drift(v)) / size if size > 0 else math.inf
        edges.append(v + min(v, settings.width * spread(v), turned))
    edges = np.array(edges)
    return continuous(np.unique(np.append(edges, tail.kinks[tail.kinks < edges[-1]])), degree)


def _too_sharp(tail):
    """Say that paths differ so little that the grid would be too fine."""
    return ToleranceError(
        f"paths from the start y = {tail.side * tail.start:g} far in the tails hardly differ by a "
        f"noise of sigma = {tail.sigma:g}; start nearer or use method='monte_carlo'"
    )


def _generator(tail, axis: Axis):
    """Matrix of A at the nodes."""
    assert axis.curvature is not None  # the elements are continuous
    generator = tail.sigma**2 / 2 * axis.curvature.toarray()
    return generator - tail.drift(axis.nodes)[:, None] * axis.slope.toarray()


def _band(matrix, width):
    """Diagonals of a matrix, in rows, as `solve_banded` wants them."""
    size = len(matrix)
    band = np.zeros((2 * width + 1, size))
    for k in range(-width, width + 1):
        band[width - k, max(k, 0) : size + min(k, 0)] = np.diag(matrix, k)
    return band


@lru_cache(maxsize=4)
def radau(stages: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes in (0, 1] and the matrix of the Radau IIA method, of order 2 `stages` - 1."""
    nodes = legendre.legroots([0] * (stages - 1) + [-1, 1])
    nodes = (np.sort(nodes) + 1) / 2
    point, weight = legendre.leggauss(stages)
    at = nodes[:, None] * (point + 1) / 2
    values = lagrange(2 * nodes - 1, 2 * at.ravel() - 1)[0].reshape(stages, stages, stages)
    return nodes, np.einsum("iqj,q,i->ij", values, weight, nodes / 2)


@lru_cache(maxsize=16)
def reach(tail: Tail) -> float:
    """Bound the way int |g| on the descent to the level, up to a probability of exp(-30).

    This is Chernoff's bound with u(y) = E exp(theta int |g|), which solves A u + theta |g| u = 0.

    Parameters
    ----------
    tail : Tail

    Returns
    -------
    float
        Infinite where no such u is positive.
    """
    settings = tuning.TAIL_EQUATION
    degree = settings.coarse
    axis = _axis(tail, tail.start, degree)
    generator, speed = _generator(tail, axis), tail.speed(axis.nodes)
    row = axis.interpolation(tail.start).toarray()[0]
    fall = (tail.start - tail.level) / np.min(tail.drift(axis.nodes))
    if not np.any(speed):
        return 0.0
    least = np.inf
    for theta in np.geomspace(1e-3, 1e3, settings.exponents) / (np.max(speed) * fall):
        matrix = -_band(generator[1:, 1:], degree)
        matrix[degree] -= theta * speed[1:]
        u = np.append(1.0, solve_banded((degree, degree), matrix, generator[1:, 0]))
        if not np.all(u > 0):
            break
        least = min(least, (np.log(row @ u) + settings.unlikely) / theta)
    return least
