"""First passage of x' = g out of an interval for the state y with white noise, by `transport`."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from nonsmooth.kinetic import tail_equation
from nonsmooth.kinetic.case_modes import first_passage, waves
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.kinetic.tail_descent import Tail
from nonsmooth.scenes.scene import Scene

# polynomial degree; nodes of a contour for a single time, and their spacing while the probability
# rises; more nodes, of larger real part, would only make the rounding errors grow
_LEVELS = (
    (4, 7, 1.2),
    (6, 10, 0.9),
    (7, 11, 0.85),
    (9, 13, 0.75),
    (11, 15, 0.7),
    (14, 17, 0.65),
)
_DENSER = 0.65  # spacing of nodes where, from a far start, the probability rises fast up to 1
_COARSE = 6  # degree in the search for saddles
_SPARE = 18.0  # exponent of what is neglected, relative to the probability
_DEPTH = 26.0  # the grid ends where the density has fallen by exp(-26), relative to the same


@dataclass(frozen=True)
class Line:
    """A scene with the state y and white noise, and an interval.

    Attributes
    ----------
    relative : bool
        Whether small probabilities are wanted to relative accuracy.
    """

    scene: Scene
    lower: float
    upper: float
    tol = 1e-7
    relative = True
    levels: ClassVar[tuple[tuple, ...]] = _LEVELS
    loose = 1e-4
    cure = "loosen tol"
    # what is taken as 0: probabilities, and values of the transform
    negligible, rounded = 1e-14, 1e-70
    # what no refinement shows, relative: of mirror images, modes come in squares, and fast ones
    # lose half of their digits
    inexact = 2e-9
    # last time over first time of a contour while the probability rises, terms left out there, and
    # those left out of a hyperbola
    narrow, last, least = 2.5, 1e-12, 1e-10

    @property
    def two_sided(self):
        """Whether both levels are finite."""
        return np.isfinite(self.lower) and np.isfinite(self.upper)

    def near_axis(self, radius, depth):
        """Return z -> E exp(-z tau) for |z| = radius; on the axis, of the order exp(-depth)."""
        time = depth / radius
        return self._on(_COARSE, time, self._reach(time, depth / 2), _DEPTH + depth)

    def transform(self, degree, times, rarity):
        """Return z -> E exp(-z tau) for probabilities from exp(-rarity) on, at given times."""
        return self._on(degree, times[0], self._reach(times[-1], rarity), _DEPTH + rarity)

    def _on(self, degree, time, reach, depth):
        grid = ordinates(
            self.scene, degree, time, reach, depth, distances=(-self.lower, self.upper)
        )
        return lambda z: first_passage(grid, z, self.lower, self.upper)

    def _reach(self, time, depth):
        """Change of velocity that is exceeded by `time` with at most 4 exp(-depth - _SPARE).

        That of Brownian motion without drift, which points to the origin.
        """
        return self.scene.noise.sigma * np.sqrt(2 * time * (depth + _SPARE))


@dataclass(frozen=True)
class Late(Line):
    """What is left of a far start after its descent to the bulk.

    Attributes
    ----------
    tail : Tail
    """

    tail: Tail
    relative = False
    levels = tuple((degree, count, _DENSER * spacing) for degree, count, spacing in _LEVELS)
    last = 1e-9
    cure = "loosen tol, or use method='monte_carlo'"

    def _on(self, degree, time, reach, depth):
        tail = self.tail
        grid = ordinates(
            replace(self.scene, start={"y": tail.side * tail.level}),
            degree,
            time,
            reach,
            depth,
            distances=(-self.lower, self.upper),
        )
        march = tail_equation.equation(tail, self.lower, self.upper, degree)
        return lambda z: march.mean(z, *waves(grid, z, self.lower, self.upper))
