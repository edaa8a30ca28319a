"""A start far in the tails: how the velocity falls from there to the bulk.

Functions on the grids of `ordinates_line` are weighted by the invariant density. Far in the tails,
where this density is below the rounding error of the modes, they have no correct digits. But from
there the velocity first falls to a level near the bulk, and g keeps its sign on the way, so that
int g moves towards one wall only (`tail_equation`). While y stays where drift and g are linear,
(y, int g) even has a normal law in closed form. In this first part of the way paths are almost
deterministic, which would make a Laplace transform hard to invert.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy
from numpy.polynomial import legendre
from scipy.optimize import brentq
from scipy.special import ndtr

from nonsmooth.errors import SceneError
from nonsmooth.kinetic import tuning
from nonsmooth.line.kinks import isolated_zeros, sign_changes, switches
from nonsmooth.line.potential import potential
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True, eq=False)  # compared by identity, to be a key of caches
class Tail:
    """The velocities between a level near the bulk and beyond a far start.

    The sign of y is such that the start is positive.

    Attributes
    ----------
    side : int
        Sign of the start in the scene.
    level, start : float
        Velocities at which the bulk and the paths begin.
    towards : int
        1 if int g moves to the upper wall, -1 if to the lower.
    drift, speed : callable
        Of y: minus the drift, and |g|.
    sigma : float
    kinks : numpy.ndarray
        Velocities beyond the level at which drift or g may have a kink.
    floor : float
        The largest velocity below the start at which they may have one, 0 if there is none.
    lines : tuple or None
        (value at 0, slope) of drift and of |g| beyond the floor, up to where no path rises; None
        if they are not linear there.
    """

    side: int
    level: float
    start: float
    towards: int
    drift: Callable
    speed: Callable
    sigma: float
    kinks: np.ndarray
    floor: float
    lines: tuple | None

    @cached_property
    def rate(self) -> float:
        """Largest rate in time at which the solution changes at the level."""
        diffusion = self.sigma**2 / self.level**2
        return tuning.TAIL_DESCENT.rate * max(diffusion, float(self.drift(self.level)) / self.level)

    @cached_property
    def flight(self) -> float:
        """Time until which y stays above the floor, so that (y, int g) is normal; 0 if it never is.

        Paths leave earlier with a probability of about 1e-10.
        """
        return self._above(self.floor)

    @cached_property
    def descent(self) -> float:
        """Time until which y stays above level and floor; 0 if `flight` is 0.

        It ends well before the flight, so that times after the flight are not too near to its end.
        """
        most = tuning.TAIL_DESCENT.share * self.flight
        return min(self._above(max(self.level, self.floor)), most)

    def _above(self, velocity):
        """Time until which y stays above a velocity, if drift and g are linear down to there."""
        if self.lines is None:
            return 0.0
        spreads = tuning.TAIL_DESCENT.spreads
        (push, rate), _ = self.lines
        fall = (self.start - velocity) * rate / (push + rate * velocity)
        times = np.log1p(fall) / rate * np.linspace(0, 1, tuning.TAIL_DESCENT.times)[1:]
        laws = [self.law(t) for t in times]
        near = [law.mean[0] - velocity < spreads * math.sqrt(law.covariance[0, 0]) for law in laws]
        first = near.index(True)  # there is one, because at the last time the mean has arrived
        return float(times[first - 1]) if first else 0.0

    def law(self, time: float) -> "NormalLaw":
        """Return the law of (y, int |g|) at a time, as if drift and g were linear everywhere.

        Parameters
        ----------
        time : float
            0 if `lines` is None.

        Returns
        -------
        NormalLaw
        """
        if time == 0 or self.lines is None:
            return NormalLaw(np.array([self.start, 0.0]), np.zeros((2, 2)))
        (push, rate), (offset, gain) = self.lines
        k = rate * time
        once, twice = -math.expm1(-k) / rate, -math.expm1(-2 * k) / (2 * rate)
        way = self.start * once - push * (time - once) / rate
        if k < tuning.TAIL_DESCENT.series:  # the terms of the formula cancel
            series = 1 / 3 - k / 4 + 7 * k**2 / 60 - k**3 / 24 + 31 * k**4 / 2520
            variance = time**3 * series
        else:
            variance = (time - 2 * once + twice) / rate**2
        mixed = gain * once**2 / 2
        return NormalLaw(
            np.array([self.start * math.exp(-k) - push * once, offset * time + gain * way]),
            self.sigma**2 * np.array([[twice, mixed], [mixed, gain**2 * variance]]),
        )


def tail(scene: Scene) -> Tail:
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
    settings, y = tuning.TAIL_DESCENT, symbols.y
    energy, knot = potential(scene)
    expression = scene.numerical_observable()
    depth, g = vectorised(energy, (y,)), vectorised(expression, (y,))
    slope = vectorised(sympy.diff(energy, y) * scene.noise.sigma**2 / 2, (y,))
    start = abs(scene.start["y"])
    side = 1 if scene.start["y"] > 0 else -1
    level = brentq(lambda v: depth(side * v) - settings.level, 0.0, start)

    def drift(v):
        return side * slope(side * np.asarray(v, dtype=float))

    def speed(v):
        return np.abs(g(side * np.asarray(v, dtype=float)))

    probe = np.linspace(level, 2 * start, settings.probed)
    signs = np.sign(g(side * probe))
    towards = 1 if signs.sum() >= 0 else -1
    if np.any(signs * towards < 0):
        raise SceneError(
            f"the start y = {scene.start['y']:g} is too far in the tails for a g that changes its "
            "sign there; start nearer or use method='monte_carlo'"
        )
    everywhere = np.linspace(-2 * start, 2 * start, settings.probed)
    zeros, *others = [
        sign_changes(vectorised(f, (y,)), everywhere) for f in [expression, *switches(expression)]
    ]
    zeros = isolated_zeros(g, zeros, 2 * start)
    places = side * np.concatenate([[knot, -knot], zeros, *others])
    kinks = np.unique(places[places > level])
    floor = max(places[(places > 0) & (places < start)], default=0.0)
    # exceeded with a probability of exp(-2 spreads start / spread)
    ceiling = start + settings.spreads * scene.noise.sigma * math.sqrt(start / drift(start))
    beyond = np.linspace(max(level, floor), ceiling, settings.probed)[1:]
    bent = np.any((places >= start) & (places < ceiling))
    lines = None if bent else tuple(_line(f, beyond) for f in (drift, speed))
    if lines and None in lines:
        lines = None
    return Tail(side, level, start, towards, drift, speed, scene.noise.sigma, kinks, floor, lines)


def _line(function, points):
    """Value at 0 and slope of a function; None if it is not linear between the points."""
    values = function(points)
    slope = (values[-1] - values[0]) / (points[-1] - points[0])
    value = values[0] - slope * points[0]
    line = value + slope * points
    linear = np.all(np.abs(values - line) <= tuning.TAIL_DESCENT.linear * np.max(np.abs(values)))
    return (float(value), float(slope)) if linear else None


@dataclass(frozen=True)
class NormalLaw:
    """Normal law of (y, int |g|); a single point if the covariance is 0.

    Attributes
    ----------
    mean : numpy.ndarray, shape (2,)
    covariance : numpy.ndarray, shape (2, 2)
    """

    mean: np.ndarray
    covariance: np.ndarray

    @property
    def top(self) -> float:
        """Velocity that is exceeded with a probability of 4e-11."""
        return float(self.mean[0] + tuning.TAIL_DESCENT.spreads * np.sqrt(self.covariance[0, 0]))

    def passed(self, way: float) -> float:
        """P(int |g| >= way), for a positive way."""
        spread = np.sqrt(self.covariance[1, 1])
        if spread == 0:  # as where g is constant
            return float(self.mean[1] >= way)
        return float(ndtr((self.mean[1] - way) / spread))

    def points(self, way: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Quadrature points for the law of (y, int |g|) given that int |g| < way.

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
        spreads = tuning.TAIL_DESCENT.spreads
        node, weight = legendre.leggauss(tuning.TAIL_DESCENT.points)
        spread = np.sqrt(self.covariance[0, 0])
        slope = self.covariance[0, 1] / self.covariance[0, 0]
        rest = np.sqrt(max(self.covariance[1, 1] - slope * self.covariance[0, 1], 1e-300))
        u = spreads * node
        middle = self.mean[1] + slope * spread * u
        half = (np.clip((way - middle) / rest, -spreads, spreads) + spreads) / 2
        v = -spreads + half[:, None] * (node + 1)
        masses = (weight * np.exp(-(u**2) / 2))[:, None] * half[:, None] * weight
        masses *= np.exp(-(v**2) / 2)
        return (
            np.repeat(self.mean[0] + spread * u, len(node)),
            (middle[:, None] + rest * v).ravel(),
            (masses / masses.sum()).ravel(),
        )
