"""First passage of int g from a start far in the tails, where the modes of `transport` cancel.

The velocity falls from the start to a level near the bulk, and on the way g keeps one sign: int g
moves towards one wall only. There the transform h(x, y) = E exp(-z tau) solves the parabolic
equation |g| d_s h = (A - z) h in the distance s to that wall, with h = 1 at s = 0 and, at the
level, the values of the modes of the bulk. It is marched in s without the weight m, so that nothing
cancels.

As long as drift and g are linear, (y, int g) is normal. That flight, in which a far start is all
but deterministic and its transform grows off the axis, is left out of the march, which ends with
the mean over the normal law.
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import sympy
from numpy.polynomial import legendre
from scipy.linalg import solve_banded
from scipy.linalg.lapack import zgbsv
from scipy.optimize import brentq
from scipy.special import ndtr

from nonsmooth import models, quadrature
from nonsmooth.elements import continuous, lagrange
from nonsmooth.errors import SceneError
from nonsmooth.expressions import vectorised
from nonsmooth.ordinates import ends_of_zeros
from nonsmooth.spectral import potential

_LEVEL = 8.0  # depth of the level: logarithm of the largest invariant density over that there
_SPREADS = 6.5  # standard deviations beyond which nothing is looked for; outside: 8e-11
_OUT_OF_REACH = 30.0  # ways that are exceeded with probability exp(-30) are left out
_STAGES = 5  # of the Radau IIA method, of order 9
# phase by which exp(-z t) turns in a step, times the degree; and in an element
_TURN, _ROTATION = 5.0, 40.0
_WIDTH = 0.9  # of elements, relative to the spread of velocities on the way to the level
_BEYOND = 4.0  # spreads by which the grid goes beyond the start
_COARSE = 7  # degree for the longest way
_POINTS = 48  # Gauss points of the normal law in each direction
_PROBED = 2001  # points at which g is looked at
_LINEAR = 1e-12  # deviation of what is called linear


@dataclass(frozen=True, eq=False)  # the same only if identical, to be a key of `march`
class Tail:
    """The state between the bulk and a far start, y turned so that the start is positive.

    Attributes
    ----------
    side : int
        Sign of the start.
    level, start : float
        Velocities, turned.
    towards : int
        1 if int g moves to the upper wall, -1 if to the lower.
    drift, speed : callable
        Of y: minus the drift, and |g|.
    sigma : float
    kinks : numpy.ndarray
        Velocities beyond the level at which drift or g may have a kink.
    floor : float
        The last such velocity below the level.
    lines : tuple or None
        (value at 0, slope) of drift and of |g| beyond the floor; None where they are not linear.
    """

    side: int
    level: float
    start: float
    towards: int
    drift: object
    speed: object
    sigma: float
    kinks: np.ndarray
    floor: float
    lines: tuple | None

    @cached_property
    def rate(self):
        """Largest rate at which the solution changes at the level, in time."""
        diffusion = self.sigma**2 / self.level**2
        return 3 * max(diffusion, float(self.drift(self.level)) / self.level)

    @cached_property
    def reach(self):
        """Way int |g| that is exceeded with probability exp(-_OUT_OF_REACH), before the level.

        Chernoff's bound with u(y) = E exp(theta int |g|), which solves A u + theta |g| u = 0;
        infinite where no such u is positive.
        """
        axis = _axis(self, self.start, _COARSE)
        generator, speed = _generator(self, axis), self.speed(axis.nodes)
        row = axis.interpolation(self.start).toarray()[0]
        fall = (self.start - self.level) / np.min(self.drift(axis.nodes))
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

    @cached_property
    def flight(self):
        """Time within which y stays above the floor, and (y, int g) is normal; 0 if it is not."""
        return self._above(self.floor)

    @cached_property
    def descent(self):
        """Time within which y stays above the level, at most `flight`."""
        return self._above(self.level)

    def _above(self, velocity):
        if self.lines is None:
            return 0.0
        (push, rate), _ = self.lines
        fall = (self.start - velocity) * rate / (push + rate * velocity)
        times = np.log1p(fall) / rate * np.linspace(0, 1, 401)[1:]
        laws = [self.law(t) for t in times]
        near = [law.mean[0] - velocity < _SPREADS * math.sqrt(law.covariance[0, 0]) for law in laws]
        first = near.index(True)  # the mean arrives at the last time
        return float(times[first - 1]) if first else 0.0

    def law(self, time):
        """Return the law of (y, int |g|), as if drift and g were linear everywhere.

        Parameters
        ----------
        time : float
            0 if `lines` is None.

        Returns
        -------
        Law
        """
        if time == 0:
            return Law(np.array([self.start, 0.0]), np.zeros((2, 2)))
        (push, rate), (offset, gain) = self.lines
        k = rate * time
        once, twice = -math.expm1(-k) / rate, -math.expm1(-2 * k) / (2 * rate)
        way = self.start * once - push * (time - once) / rate
        if k < 1e-2:  # the terms cancel
            series = 1 / 3 - k / 4 + 7 * k**2 / 60 - k**3 / 24 + 31 * k**4 / 2520
            variance = time**3 * series
        else:
            variance = (time - 2 * once + twice) / rate**2
        mixed = gain * once**2 / 2
        return Law(
            np.array([self.start * math.exp(-k) - push * once, offset * time + gain * way]),
            self.sigma**2 * np.array([[twice, mixed], [mixed, gain**2 * variance]]),
        )


def tail(scene):
    """Describe the tail in which a scene starts.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise, and a start beyond the level.

    Returns
    -------
    Tail

    Raises
    ------
    SceneError
        If g changes its sign between the level and the start, or beyond.
    """
    y = models.y
    energy, knot = potential(scene)
    expression = scene.numerical_observable()
    depth, g = vectorised(energy, (y,)), vectorised(expression, (y,))
    slope = vectorised(sympy.diff(energy, y) * scene.noise.sigma**2 / 2, (y,))
    start = abs(scene.start["y"])
    side = 1 if scene.start["y"] > 0 else -1
    level = brentq(lambda v: depth(side * v) - _LEVEL, 0.0, start)

    def drift(v):
        return side * slope(side * np.asarray(v, dtype=float))

    def speed(v):
        return np.abs(g(side * np.asarray(v, dtype=float)))

    probe = np.linspace(level, 2 * start, _PROBED)
    signs = np.sign(g(side * probe))
    towards = 1 if signs.sum() >= 0 else -1
    if np.any(signs * towards < 0):
        raise SceneError(
            f"the start y = {scene.start['y']:g} is too far in the tails for a g that changes its "
            "sign there; start nearer or use method='monte_carlo'"
        )
    everywhere = np.linspace(-2 * start, 2 * start, _PROBED)
    zeros, *others = [
        quadrature.sign_changes(vectorised(f, (y,)), everywhere)
        for f in [expression, *quadrature.switches(expression)]
    ]
    zeros = ends_of_zeros(g, zeros, 2 * start)
    places = side * np.concatenate([[knot, -knot], zeros, *others])
    kinks = np.unique(places[places > level])
    floor = max(places[(places > 0) & (places <= level)], default=0.0)
    lines = None if len(kinks) else tuple(_line(f, probe) for f in (drift, speed))
    if lines and None in lines:
        lines = None
    return Tail(side, level, start, towards, drift, speed, scene.noise.sigma, kinks, floor, lines)


def _line(function, points):
    """(value at 0, slope) of a function, None if it is not linear between the points."""
    values = function(points)
    slope = (values[-1] - values[0]) / (points[-1] - points[0])
    value = values[0] - slope * points[0]
    line = value + slope * points
    linear = np.all(np.abs(values - line) <= _LINEAR * np.max(np.abs(values)))
    return (float(value), float(slope)) if linear else None


@dataclass(frozen=True)
class Law:
    """Normal law of (y, int |g|), or a point.

    Attributes
    ----------
    mean : numpy.ndarray, shape (2,)
    covariance : numpy.ndarray, shape (2, 2)
    """

    mean: np.ndarray
    covariance: np.ndarray

    @property
    def top(self):
        """Velocity that is hardly exceeded."""
        return float(self.mean[0] + _SPREADS * np.sqrt(self.covariance[0, 0]))

    def passed(self, way):
        """P(int |g| >= way), for a positive way."""
        spread = np.sqrt(self.covariance[1, 1])
        return float(ndtr((self.mean[1] - way) / spread)) if spread > 0 else 0.0

    def points(self, way):
        """Quadrature points (y, int |g|) with int |g| < way.

        Parameters
        ----------
        way : float

        Returns
        -------
        velocities, ways, weights : numpy.ndarray, shape (q,)
            The weights sum up to 1.
        """
        if not np.any(self.covariance):
            return self.mean[:1], self.mean[1:], np.ones(1)
        node, weight = legendre.leggauss(_POINTS)
        spread = np.sqrt(self.covariance[0, 0])
        slope = self.covariance[0, 1] / self.covariance[0, 0]
        rest = np.sqrt(max(self.covariance[1, 1] - slope * self.covariance[0, 1], 1e-300))
        u = _SPREADS * node
        middle = self.mean[1] + slope * spread * u
        half = (np.clip((way - middle) / rest, -_SPREADS, _SPREADS) + _SPREADS) / 2
        v = -_SPREADS + half[:, None] * (node + 1)
        masses = (weight * np.exp(-(u**2) / 2))[:, None] * half[:, None] * weight
        masses *= np.exp(-(v**2) / 2)
        return (
            np.repeat(self.mean[0] + spread * u, _POINTS),
            (middle[:, None] + rest * v).ravel(),
            (masses / masses.sum()).ravel(),
        )


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
        self._length = min(distance, tail.reach)
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
