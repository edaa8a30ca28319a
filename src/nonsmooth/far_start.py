"""First passage of int g from a start far in the tails, where the modes of `transport` cancel.

The velocity falls from the start to a level near the bulk, and on the way g keeps one sign: int g
moves towards one wall only. There the transform h(x, y) = E exp(-z tau) solves the parabolic
equation g d_s h = (A - z) h in the distance s to that wall, with h = 1 at s = 0 and, at the level,
the values of the modes of the bulk. It is marched in s without weights, so that nothing cancels.

As long as drift and g are linear and the level is out of reach, (y, int g) is normal. That phase,
in which a far start is all but deterministic and its transform grows off the axis, is left out of
the march, which ends with the mean over the normal law.
"""

from dataclasses import dataclass, replace
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
from nonsmooth.expressions import vectorised
from nonsmooth.ordinates import ordinates
from nonsmooth.spectral import potential
from nonsmooth.transport import waves

LEVEL = 8.0  # depth of the level
_SPREADS = 6.5  # standard deviations beyond which nothing is looked for; outside: 8e-11
_OUT_OF_REACH = 30.0  # distances beyond which paths move with probability exp(-30) are left out
_STAGES = 5  # of the Radau IIA method, of order 9
_TURN, _ROTATION = 5.0, 12.0  # of exp(-z int dt) in a step, times the degree, and in an element
_WIDTH = 0.9  # of elements, relative to the spread of velocities on the way to the level
_COARSE = 7
_BEYOND = 4.0
_NORMAL = 48  # Gauss points in each direction of the normal law


@dataclass(frozen=True)
class Approach:
    """The tail beyond the level, y turned so that the start is positive.

    Attributes
    ----------
    side : int
        Sign of the start.
    level, start : float
        Velocities, both positive.
    towards : int
        1 if int g moves to the upper wall, -1 if to the lower.
    drift, speed : callable
        Of y: -d<y>/dt, and |g|.
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
    linear: tuple | None

    @property
    def rate(self):
        v = np.array([self.start, 2 * self.start])
        return float(np.diff(self.drift(v))[0] / self.start)

    @property
    def relaxation(self):
        """Rate"""
        return 3 * max(self.sigma**2 / self.level**2, float(self.drift(self.level)) / self.level)

    @cached_property
    def reach(self):
        return reach(self)


def approach(scene):
    """Describe the tail between the bulk and the start; None if g changes its sign there."""
    y = models.y
    energy, knot = potential(scene)
    depth = vectorised(energy, (y,))
    start = scene.start.get("y", 0.0)
    side = 1 if start > 0 else -1
    level = brentq(lambda v: depth(side * v) - LEVEL, 0.0, abs(start))
    expression = scene.numerical_observable()
    g = vectorised(expression, (y,))
    places = [knot, -knot]
    inside = np.linspace(-2 * abs(start), 2 * abs(start), 2001)
    for f in [expression, *quadrature.switches(expression)]:
        places.extend(quadrature.sign_changes(vectorised(f, (y,)), inside))
    places = side * np.array(places)
    places = places[places > 0]
    slope = vectorised(sympy.diff(energy, y) * scene.noise.sigma**2 / 2, (y,))
    probe = np.linspace(level, 2 * abs(start), 2001)
    sign = np.sign(g(side * probe))
    towards = 1 if sign.sum() >= 0 else -1
    if np.any(sign * towards < 0):
        return None
    kinks = np.sort(places[places > level])
    floor = max(places[places <= level], default=0.0)

    def drift(v):
        return side * slope(side * np.asarray(v, dtype=float))

    def speed(v):
        return np.abs(g(side * np.asarray(v, dtype=float)))

    linear = None
    if not len(kinks):
        ends = np.array([floor + 1e-3 * (level - floor), 2 * abs(start)])
        lines = [np.diff(f(ends)) / np.diff(ends) for f in (drift, speed)]
        laws = [(float(f(ends[:1])[0] - k[0] * ends[0]), float(k[0])) for f, k in zip((drift, speed), lines)]
        if all(
            np.allclose(f(probe), a + b * probe, rtol=1e-12, atol=0)
            for f, (a, b) in zip((drift, speed), laws, strict=True)
        ):
            linear = laws
    return Approach(side, level, abs(start), towards, drift, speed, scene.noise.sigma, kinks, floor, linear)


@dataclass(frozen=True)
class Law:
    """Normal law of (y, int |g|) at a time; a point at time 0."""

    time: float
    mean: np.ndarray
    covariance: np.ndarray

    def passed(self, distance):
        """P(int |g| >= distance)."""
        spread = np.sqrt(self.covariance[1, 1])
        if spread == 0:
            return 0.0
        return float(ndtr((self.mean[1] - distance) / spread))

    def points(self, distance):
        """Points (y, int |g|) and weights, int |g| < distance; the weights sum up to P of it."""
        if self.time == 0:
            return self.mean[:1], self.mean[1:], np.ones(1)
        node, weight = legendre.leggauss(_NORMAL)
        sy = np.sqrt(self.covariance[0, 0])
        slope = self.covariance[0, 1] / self.covariance[0, 0]
        sx = np.sqrt(max(self.covariance[1, 1] - slope * self.covariance[0, 1], 0.0))
        u = _SPREADS * node
        mass = _SPREADS * weight * np.exp(-(u**2) / 2) / np.sqrt(2 * np.pi)
        middle = self.mean[1] + slope * sy * u
        high = np.clip((distance - middle) / sx, -_SPREADS, _SPREADS)
        half = (high + _SPREADS) / 2
        v = -_SPREADS + half[:, None] * (node + 1)
        masses = half[:, None] * weight * np.exp(-(v**2) / 2) / np.sqrt(2 * np.pi)
        return (
            np.repeat(self.mean[0] + sy * u, _NORMAL),
            (middle[:, None] + sx * v).ravel(),
            (mass[:, None] * masses).ravel(),
        )


def law(tail, time):
    """Return the law from the start, as if drift and g were linear everywhere."""
    if time == 0:
        return Law(0.0, np.array([tail.start, 0.0]), np.zeros((2, 2)))
    (push, rate), (offset, gain) = tail.linear
    # dy = -(push + rate y) dt + sigma dW
    k = rate * time
    f1 = -np.expm1(-k) / rate
    mean_y = tail.start * np.exp(-k) - push * f1
    area = tail.start * f1 - push * (time - f1) / rate
    s2 = tail.sigma**2
    f2 = -np.expm1(-2 * k) / (2 * rate)
    # (1 - exp(-k))/rate is the response of the area to a kick a time before
    var_y = s2 * f2
    cov = s2 * f1**2 / 2
    if k < 1e-2:  # the terms cancel
        var_x = s2 * time**3 * (1 / 3 - k / 4 + 7 * k**2 / 60 - k**3 / 24 + 31 * k**4 / 2520)
    else:
        var_x = s2 * (time - 2 * f1 + f2) / rate**2
    mean_x = offset * time + gain * area
    return Law(
        time,
        np.array([mean_y, mean_x]),
        np.array([[var_y, gain * cov], [gain * cov, gain**2 * var_x]]),
    )


def free_time(tail, velocity):
    """Longest time within which y does not fall to a velocity; 0 where the law is not normal."""
    if tail.linear is None:
        return 0.0

    def margin(time):
        now = law(tail, time)
        return (now.mean[0] - velocity) / np.sqrt(now.covariance[0, 0]) - _SPREADS

    (push, rate), _ = tail.linear
    last = np.log1p((tail.start - velocity) * rate / (push + rate * velocity)) / rate
    times = last * np.linspace(0, 1, 400)[1:]
    below = np.flatnonzero([margin(t) < 0 for t in times])
    return float(times[below[0] - 1]) if below[0] > 0 else 0.0


def reach(tail):
    """Distance that int |g| exceeds with probability exp(-_OUT_OF_REACH) only, before the level.

    Chernoff's bound with u(y) = E exp(theta int |g|), which solves A u + theta |g| u = 0.
    """
    axis = _axis(tail, tail.start, _COARSE)
    generator, speed = _generator(tail, axis), tail.speed(axis.nodes)
    row = axis.interpolation(tail.start).toarray()[0]
    best = np.inf
    scale = np.max(speed) * (tail.start - tail.level) / np.min(tail.drift(axis.nodes))
    if scale == 0:
        return 0.0
    for theta in np.geomspace(1e-3, 1e3, 49) / scale:
        matrix = _band(generator[1:, 1:], _COARSE) * -1
        matrix[_COARSE] -= theta * speed[1:]
        u = np.append(1.0, solve_banded((_COARSE, _COARSE), matrix, generator[1:, 0]))
        if not np.all(u > 0):
            break
        best = min(best, (np.log(row @ u) + _OUT_OF_REACH) / theta)
    return best


def _axis(tail, top, degree, turn=0.0):
    """Elements from the level to beyond `top`, graded to where u is exp(-i turn int dt)."""

    def spread(v):
        return tail.sigma * np.sqrt(v / float(tail.drift(v)))

    edges, end = [tail.level], top + _BEYOND * min(spread(top), tail.sigma / np.sqrt(tail.rate))
    while edges[-1] < end:
        v = edges[-1]
        width = min(v, _WIDTH * spread(v), _ROTATION * float(tail.drift(v)) / max(turn, 1e-300))
        edges.append(v + width)
    edges = np.array(edges)
    kinks = tail.kinks[tail.kinks < edges[-1]]
    return continuous(np.unique(np.append(edges, kinks)), degree)


def _generator(tail, axis):
    generator = tail.sigma**2 / 2 * axis.curvature.toarray()
    return generator - tail.drift(axis.nodes)[:, None] * axis.slope.toarray()


def _band(matrix, width):
    """Diagonals of a matrix as `solve_banded` wants them."""
    size = len(matrix)
    band = np.zeros((2 * width + 1, size))
    for k in range(-width, width + 1):
        band[width - k, max(k, 0) : size + min(k, 0)] = np.diag(matrix, k)
    return band


@lru_cache(maxsize=4)
def radau(stages):
    """Nodes on (0, 1] and the matrix of the Radau IIA method."""
    last = legendre.legsub([0] * stages + [1], [0] * (stages - 1) + [1])
    nodes = np.sort((legendre.legroots(last).real + 1) / 2)
    nodes[-1] = 1.0
    point, weight = legendre.leggauss(stages)
    at = nodes[:, None] * (point + 1) / 2
    values = lagrange(2 * nodes - 1, 2 * at.ravel() - 1)[0].reshape(stages, stages, stages)
    return nodes, np.einsum("iqj,q,i->ij", values, weight, nodes / 2)


class March:
    """The equation of the tail, from its wall to the place of the start.

    Parameters
    ----------
    tail : Approach
    law : Law
        Of the start of the march.
    lower, upper : float
    degree : int
    """

    def __init__(self, tail, law, lower, upper, degree):
        self._tail, self._law, self._degree = tail, law, degree
        distance, self._other = (upper, -lower) if tail.towards > 0 else (-lower, upper)
        self._length = min(distance, tail.reach)
        self._gap = distance - self._length if np.isfinite(distance) else np.inf
        self._points = law.points(self._length)
        self._grids = {}

    def mean(self, z, above, below):
        """E exp(-z tau), given the waves of the walls at the level."""
        octave = max(0, int(np.ceil(np.log2(abs(z) / self._tail.relaxation))))
        if octave not in self._grids:
            self._grids[octave] = _Grid(
                self._tail,
                self._law.mean[0] + _SPREADS * np.sqrt(self._law.covariance[0, 0]),
                self._length,
                self._points,
                self._degree,
                self._tail.relaxation * 2**octave,
            )
        grid = self._grids[octave]
        own, opposite = (above, below) if self._tail.towards > 0 else (below, above)
        ends = grid.step * np.arange(grid.count + 1)
        later = radau(_STAGES)[0] * grid.step
        boundary = np.zeros((grid.count, _STAGES), complex)
        first = 0.0
        if np.isfinite(self._gap):
            boundary += own.product(self._gap + ends[:-1], later)
            first += own.at(self._gap)
        if np.isfinite(self._other):
            boundary += opposite.product(self._other + ends[-2::-1], grid.step - later)
            first += opposite.at(self._other + self._length)
        return grid.mean(z, first, boundary, 1.0 if self._gap == 0 else first)


class _Grid:
    """Discretisation of the tail for |z| up to some size."""

    def __init__(self, tail, top, length, points, degree, size):
        velocities, ways, masses = points
        self._degree, self._axis = degree, _axis(tail, top, degree, size)
        nodes = self._axis.nodes
        speed = tail.speed(nodes)
        gain = speed[0] if speed[0] > 0 else np.max(speed)
        self.count = max(1, int(np.ceil(length * degree * size / (_TURN * max(gain, 1e-300)))))
        self.step = length / self.count
        self._pace = speed[1:] / max(self.step, 1e-300)
        generator = _generator(tail, self._axis)
        self._band, self._entering = _band(generator[1:, 1:], degree), generator[1:, 0]
        place, matrix = radau(_STAGES)
        self._shifts, self._vectors = np.linalg.eig(np.linalg.inv(matrix))
        s = np.clip(length - ways, 0.0, length) / max(self.step, 1e-300)
        where = np.minimum(s.astype(int), self.count - 1)
        local = lagrange(2 * np.append(0.0, place) - 1, 2 * (s - where) - 1)[0]
        across = self._axis.interpolation(velocities)
        self._first = int(where.min())
        self._weights = np.zeros((self.count - self._first, len(nodes), _STAGES + 1))
        for k in np.unique(where):
            here = np.flatnonzero(where == k)
            self._weights[k - self._first] = across[here].T @ (
                local[here] * (masses[here] / masses.sum())[:, None]
            )

    def mean(self, z, first, boundary, begin):
        degree, size = self._degree, len(self._pace)
        inverse = np.linalg.inv(self._vectors)
        carry = np.empty((_STAGES, size, size), complex)
        enter = np.empty((_STAGES, size), complex)
        for i, shift in enumerate(self._shifts):
            band = np.zeros((3 * degree + 1, size), complex)
            band[degree:] = -self._band
            band[2 * degree] += shift * self._pace + z
            right = np.column_stack([np.diag(shift * inverse[i].sum() * self._pace), self._entering])
            _, _, solution, failed = zgbsv(degree, degree, band, right.astype(complex))
            carry[i], enter[i] = solution[:, :-1], solution[:, -1]
        carry = np.tensordot(self._vectors, carry, 1)
        enter = np.einsum("ki,in,ij->knj", self._vectors, enter, inverse)
        edge, inner = first, np.full(size, begin, complex)
        last = np.ascontiguousarray(carry[-1])
        changes = boundary @ enter[-1].T
        total = 0.0
        for k in range(self.count):
            if k >= self._first:
                stages = carry @ inner + enter @ boundary[k]
                here = self._weights[k - self._first]
                total += here[0, 0] * edge + here[0, 1:] @ boundary[k]
                total += here[1:, 0] @ inner + np.sum(here[1:, 1:].T * stages)
            edge, inner = boundary[k, -1], last @ inner + changes[k]
        return total
