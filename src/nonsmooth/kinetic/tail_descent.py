"""The way of the velocity from a start far in the tails, where the modes of `transport` cancel.

It falls from the start to a level near the bulk, and on the way g keeps one sign: int g moves
towards one wall only, see `tail_transport`. As long as drift and g are linear, (y, int g) is
normal: that flight, in which a far start is all but deterministic and its transform grows off the
axis, is in closed form.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy
from numpy.polynomial import legendre
from scipy.optimize import brentq
from scipy.special import ndtr

from nonsmooth.errors import SceneError
from nonsmooth.line.kinks import isolated_zeros, sign_changes, switches
from nonsmooth.line.potential import potential
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised

_LEVEL = 8.0  # depth of the level: logarithm of the largest invariant density over that there
_SPREADS = 6.5  # standard deviations beyond which nothing is looked for; outside: 8e-11
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
    y = symbols.y
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
        sign_changes(vectorised(f, (y,)), everywhere) for f in [expression, *switches(expression)]
    ]
    zeros = isolated_zeros(g, zeros, 2 * start)
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
