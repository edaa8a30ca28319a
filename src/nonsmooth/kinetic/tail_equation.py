"""First passage of int g on the way from a far start to the bulk: the equation of the tail.

There the transform h(x, y) = E exp(-z tau) solves the parabolic equation |g| d_s h = (A - z) h in
the distance s to the wall that int g moves to, with h = 1 at s = 0 and, at the level, the values of
the modes of the bulk. It is marched in s without the weight m, so that nothing cancels.
"""

import math
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import solve_banded
from scipy.linalg.lapack import zgbsv

from nonsmooth.errors import SceneError
from nonsmooth.grids.elements import continuous, lagrange

_OUT_OF_REACH = 30.0  # ways that are exceeded with probability exp(-30) are left out
_STAGES = 5  # of the Radau IIA method, of order 9
# phase by which exp(-z t) turns in a step, times the degree; and in an element
_TURN, _ROTATION = 5.0, 40.0
_WIDTH = 0.9  # of elements, relative to the spread of velocities on the way to the level
_BEYOND = 4.0  # spreads by which the grid goes beyond the start
_COARSE = 7  # degree for the longest way


@lru_cache(maxsize=16)
def march(tail, lower, upper, degree):
    """Return the `March` from where the start's descent ends."""
    return March(tail, tail.law(tail.descent), lower, upper, degree)


class March:
    """The equation of the tail, from its wall to the place of the start.

    Parameters
    ----------
    tail : Tail
    law : Law
        Of velocity and way at the beginning; taken of those that have not passed the wall.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    degree : int
        Polynomial degree of the elements; steps are refined with it.

    Raises
    ------
    SceneError
        If the wall is infinitely far and no bound of the way is found.
    """

    def __init__(self, tail, law, lower, upper, degree):
        self._tail, self._law, self._degree = tail, law, degree
        distance, self._other = (upper, -lower) if tail.towards > 0 else (-lower, upper)
        self._length = min(distance, reach(tail))
        if np.isinf(self._length):
            raise SceneError(
                "g grows too fast in the tails for a start there; start nearer or use "
                "method='monte_carlo'"
            )
        self._gap = distance - self._length
        self._grids = {}

    def mean(self, z, above, below):
        """E exp(-z tau).

        Parameters
        ----------
        z : complex
        above, below : transport.Waves
            Of the two walls, at the level.

        Returns
        -------
        complex
        """
        tail = self._tail
        octave = max(0, math.ceil(math.log2(abs(z) / tail.rate)))
        if octave not in self._grids:
            points = self._law.points(self._length)
            size = tail.rate * 2**octave
            self._grids[octave] = _Grid(
                tail, self._law.top, self._length, points, self._degree, size
            )
        grid = self._grids[octave]
        own, opposite = (above, below) if tail.towards > 0 else (below, above)
        ends, later = grid.step * np.arange(grid.count + 1), radau(_STAGES)[0] * grid.step
        first, boundary = 0.0, np.zeros((grid.count, _STAGES), complex)
        if np.isfinite(self._gap):
            first += own.at(self._gap)
            boundary += own.grid(self._gap + ends[:-1], later)
        if np.isfinite(self._other):
            first += opposite.at(self._other + self._length)
            boundary += opposite.grid(self._other + ends[-2::-1], grid.step - later)
        # where the wall is out of reach, any values do
        return grid.mean(z, first, boundary, 1.0 if self._gap == 0 else first)


class _Grid:
    """Elements in y and equal steps in s for |z| up to some size."""

    def __init__(self, tail, top, length, points, degree, size):
        velocities, ways, masses = points
        axis = _axis(tail, top, degree, size)
        speed, generator = tail.speed(axis.nodes), _generator(tail, axis)
        self._degree = degree
        slowest = speed[0] if speed[0] > 0 else np.max(speed)
        steps = length * degree * size / (_TURN * slowest) if slowest > 0 else 1.0
        self.count = max(1, math.ceil(steps))
        self.step = length / self.count
        width = self.step if self.step > 0 else 1.0  # nothing moves
        self._pace = speed[1:] / width
        self._band, self._entering = _band(generator[1:, 1:], degree), generator[1:, 0]
        nodes, matrix = radau(_STAGES)
        self._shifts, self._vectors = np.linalg.eig(np.linalg.inv(matrix))
        # where nothing moves, the end of the step is the stationary solution
        place = np.clip(length - ways, 0.0, length) / width if length > 0 else np.ones(len(ways))
        where = np.minimum(place.astype(int), self.count - 1)
        within = lagrange(2 * np.append(0.0, nodes) - 1, 2 * (place - where) - 1)[0]
        across = axis.interpolation(velocities)
        self._first = int(where.min())
        self._weights = np.zeros((self.count - self._first, len(speed), _STAGES + 1))
        for k in np.unique(where):
            here = np.flatnonzero(where == k)
            self._weights[k - self._first] = across[here].T @ (within[here] * masses[here, None])

    def mean(self, z, first, boundary, begin):
        """March from the value `begin`; `first`, `boundary`: at the level, in the steps' stages."""
        degree, size = self._degree, len(self._pace)
        inverse = np.linalg.inv(self._vectors)
        carry = np.empty((_STAGES, size, size), complex)
        enter = np.empty((_STAGES, size), complex)
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
        enter = np.einsum("ki,in,ij->knj", self._vectors, enter, inverse)
        last, changes = np.ascontiguousarray(carry[-1]), boundary @ enter[-1].T
        edge, inner = first, np.full(size, begin, complex)
        total = 0.0
        for k in range(self.count):
            if k >= self._first:
                stages = carry @ inner + enter @ boundary[k]
                weights = self._weights[k - self._first]
                total += weights[0, 0] * edge + weights[0, 1:] @ boundary[k]
                total += weights[1:, 0] @ inner + np.sum(weights[1:, 1:].T * stages)
            edge, inner = boundary[k, -1], last @ inner + changes[k]
        return total


def _axis(tail, top, degree, size=0.0):
    """Elements from the level to beyond `top`, fine enough for exp(-i `size` t)."""

    def spread(v):
        return tail.sigma * math.sqrt(v / float(tail.drift(v)))

    edges, end = [tail.level], top + _BEYOND * spread(top)
    while edges[-1] < end:
        v = edges[-1]
        turned = _ROTATION * float(tail.drift(v)) / size if size > 0 else math.inf
        edges.append(v + min(v, _WIDTH * spread(v), turned))
    edges = np.array(edges)
    return continuous(np.unique(np.append(edges, tail.kinks[tail.kinks < edges[-1]])), degree)


def _generator(tail, axis):
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
def radau(stages):
    """Nodes in (0, 1] and the matrix of the Radau IIA method, of order 2 `stages` - 1."""
    nodes = legendre.legroots([0] * (stages - 1) + [-1, 1])
    nodes = (np.sort(nodes) + 1) / 2
    point, weight = legendre.leggauss(stages)
    at = nodes[:, None] * (point + 1) / 2
    values = lagrange(2 * nodes - 1, 2 * at.ravel() - 1)[0].reshape(stages, stages, stages)
    return nodes, np.einsum("iqj,q,i->ij", values, weight, nodes / 2)


@lru_cache(maxsize=16)  # the same for every degree
def reach(tail):
    """Way int |g| that is exceeded with probability exp(-_OUT_OF_REACH), before the level.

    Chernoff's bound with u(y) = E exp(theta int |g|), which solves A u + theta |g| u = 0.

    Parameters
    ----------
    tail : Tail

    Returns
    -------
    float
        Infinite where no such u is positive.
    """
    axis = _axis(tail, tail.start, _COARSE)
    generator, speed = _generator(tail, axis), tail.speed(axis.nodes)
    row = axis.interpolation(tail.start).toarray()[0]
    fall = (tail.start - tail.level) / np.min(tail.drift(axis.nodes))
    if not np.any(speed):
        return 0.0
    least = np.inf
    for theta in np.geomspace(1e-3, 1e3, 49) / (np.max(speed) * fall):
        matrix = -_band(generator[1:, 1:], _COARSE)
        matrix[_COARSE] -= theta * speed[1:]
        u = np.append(1.0, solve_banded((_COARSE, _COARSE), matrix, generator[1:, 0]))
        if not np.all(u > 0):
            break
        least = min(least, (np.log(row @ u) + _OUT_OF_REACH) / theta)
    return least
