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
from scipy.linalg.lapack import zgbtrf, zgbtrs
from scipy.optimize import brentq
from scipy.special import ndtr

from nonsmooth import models, quadrature
from nonsmooth.elements import continuous, lagrange
from nonsmooth.expressions import vectorised
from nonsmooth.ordinates import ordinates
from nonsmooth.spectral import potential
from nonsmooth.transport import waves

LEVEL = 8.0  # depth of the level
_SPREADS = 7.5  # standard deviations beyond which nothing is looked for; outside: 6e-14
_OUT_OF_REACH = 30.0  # distances beyond which paths move with probability exp(-30) are left out
_STAGES = 5  # of the Radau IIA method, of order 9
_STEP, _TURN = 1.0, 6.0  # steps over relaxation and over |z|, times the degree's reciprocal
_WIDTH = 0.6  # of elements, relative to the spread of velocities
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
    axis, generator, speed = _tail(tail, tail.start, 7)
    row = axis.interpolation(tail.start).toarray()[0]
    best = np.inf
    scale = np.max(speed) * (tail.start - tail.level) / np.min(tail.drift(axis.nodes))
    if scale == 0:
        return 0.0
    for theta in np.geomspace(1e-3, 1e3, 49) / scale:
        matrix = -generator - theta * np.diag(speed)
        u = np.ones(len(speed))
        u[1:] = np.linalg.solve(matrix[1:, 1:], -matrix[1:, 0])
        if not np.all(u > 0):
            break
        best = min(best, (np.log(row @ u) + _OUT_OF_REACH) / theta)
    return best


def _tail(tail, top, degree, edges_per_width=1.0):
    """Axis from the level to beyond `top`, the generator on it, and |g|."""
    spread = tail.sigma / np.sqrt(2 * _rate(tail))
    end = top + 4 * min(spread, tail.sigma * np.sqrt(top / float(tail.drift(top))))
    edges = [tail.level]
    while edges[-1] < end:
        v = edges[-1]
        width = min(v, tail.sigma * np.sqrt(v / float(tail.drift(v)))) * _WIDTH
        edges.append(v + width)
    edges = np.array(edges)
    edges = np.unique(np.append(edges, tail.kinks[tail.kinks < edges[-1]]))
    axis = continuous(edges, degree)
    generator = tail.sigma**2 / 2 * axis.curvature.toarray()
    generator -= tail.drift(axis.nodes)[:, None] * axis.slope.toarray()
    return axis, generator, tail.speed(axis.nodes)


def _rate(tail):
    v = np.array([tail.start, 2 * tail.start])
    return float(np.diff(tail.drift(v))[0] / tail.start)


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
    distance : float
        To the wall; possibly infinite.
    degree : int
    """

    def __init__(self, tail, law, distance, other, degree):
        self.other = other
        self.tail, self.law, self.degree = tail, law, degree
        spread = np.sqrt(law.covariance[0, 0])
        self.axis, generator, self.speed = _tail(tail, law.mean[0] + _SPREADS * spread, degree)
        self.length = min(distance, reach(tail) + 0.0)
        self.gap = 0.0 if self.length == distance else distance - self.length
        self.points = law.points(self.length)
        self.mass = self.points[2].sum()
        inner = generator[1:, 1:]
        self.entering = generator[1:, 0]
        size = len(inner)
        self.band = np.zeros((2 * degree + 1, size), complex)
        for k in range(-degree, degree + 1):
            self.band[degree - k, max(k, 0) : size + min(k, 0)] = np.diag(inner, k)
        nodes, matrix = radau(_STAGES)
        values, vectors = np.linalg.eig(np.linalg.inv(matrix))
        self.nodes, self.shifts, self.vectors = nodes, values, vectors
        self.weights = {}

    def steps(self, z):
        tail = self.tail
        gain = self.speed[0] if self.speed[0] > 0 else np.max(self.speed)
        level = tail.level
        relaxation = min(level**2 / tail.sigma**2, level / float(tail.drift(level)))
        step = gain * min(_STEP * relaxation, _TURN / abs(z)) / self.degree
        return int(np.ceil(self.length / step))

    def mean_weights(self, count):
        """Weights of the values in each step, at its start and its stages, and at the nodes."""
        if count not in self.weights:
            v, moved, mass = self.points
            s = np.clip(self.length - moved, 0.0, self.length)
            step = self.length / count
            where = np.minimum((s / step).astype(int), count - 1)
            local = 2 * (s / step - where) - 1
            rows = lagrange(2 * np.append(0.0, self.nodes) - 1, local)[0] * mass[:, None]
            across = self.axis.interpolation(v)
            result = np.zeros((count, _STAGES + 1, len(self.axis.nodes)))
            for k in np.unique(where):
                here = where == k
                result[k] = (across[np.flatnonzero(here)].T @ rows[here]).T
            self.weights[count] = result
        return self.weights[count]

    def mean(self, z, above, below):
        """E exp(-z tau), given s -> h at the level."""
        own, opposite = (above, below) if self.tail.towards > 0 else (below, above)

        def boundary(s):
            return own.at(s + self.gap) + opposite.at(self.other + self.length - s)

        count = self.steps(z)
        step = self.length / count
        weights = self.mean_weights(count)
        degree, size = self.degree, len(self.speed) - 1
        speed = self.speed[1:] / step
        factors = []
        for shift in self.shifts:
            ab = np.zeros((3 * degree + 1, size), complex)
            ab[degree:] = -self.band
            ab[2 * degree] += shift * speed + z
            lu, pivots, info = zgbtrf(ab, degree, degree)
            factors.append((lu, pivots))
        inverse = np.linalg.inv(self.vectors)
        ones = inverse.sum(axis=1)
        times = (np.arange(count)[:, None] + self.nodes) * step
        values = boundary(times.ravel()).reshape(count, _STAGES)
        start = boundary(np.zeros(1))[0]
        u = np.full(size, 1.0 if self.gap == 0 else start, complex)
        edge = start
        total = 0.0
        for k in range(count):
            right = inverse @ values[k]
            stages = np.empty((_STAGES, size), complex)
            for i, shift in enumerate(self.shifts):
                b = shift * ones[i] * speed * u + self.entering * right[i]
                stages[i] = zgbtrs(factors[i][0], degree, degree, b, factors[i][1])[0]
            stages = self.vectors @ stages
            here = weights[k]
            if here.any():
                total += here[0, 0] * edge + here[0, 1:] @ u
                total += here[1:, 0] @ values[k] + np.sum(here[1:, 1:] * stages)
            u, edge = stages[-1], values[k, -1]
        return total / self.mass
