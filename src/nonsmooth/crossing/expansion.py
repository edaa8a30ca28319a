"""The corrected formulas for threshold crossing in a form that stays a probability.

In the scene's own time and displacement, p = 1. A wave exp(q x) between the walls grows like
exp(L(q) t), L = D q^2 + C q^3 + B q^4. Below each wall it meets a half space: the Laplace transform
of the time of passage to a single threshold b is, with w = sqrt(z/D) and up to O(w^3),

    exp(-w l + (h - S - B/D + C l / (2 D)) w^2 + (B/D - 5 C^2 / (4 D^2)) l w^3 / 2),

l = b + kappa - u being the distance to the threshold at which Brownian motion is absorbed, and
h - u^2/2 standing for h; for the lower threshold C and u change sign. Two walls reflect waves as
those of Brownian motion are at b + kappa. So each wall is reached

- at the times at which a random clock, see `random_clock`, of the spread
  B/D^2 - 5 C^2 / (4 D^3), shows those of Brownian motion: z = D q^2 + B q^4 solved for D q^2;
- later by (S + B/D - h - C l / (2 D)) / D.

If the spread b is negative, the clock s is multiplied by exp(b times the logarithmic derivative of
the rate of passage). For odd g order 3 has two more such factors: waves see the threshold at
kappa - kappa_3 q^2, and the start gives r - u h + u^3/3.

All orders are distribution functions: what is positive in an exponent X is taken as X / (1 + X),
and a lead d > 0 of the time t as the factor 1 + d / (t + d), so that no clock turns back; and
the last order is mixed with order 1, of which

    1 - exp(-(2 m / b)^4),  m^2 = kappa^2 + u^2 + |B|/D + (C/D)^2

is taken: where the layer at the walls is as thick as the interval, expansion means nothing. Order 2
of odd g is no farther from order 3 than half of what order 1 is: the median of three distribution
functions. All this is O(p^-2), for order 2 O(p^(-3/2)). For odd g neither is then worse than order
1 but where that is right by chance; without symmetry order 2 may be, by a third, where W is small.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nonsmooth.crossing.brownian import (
    brownian_crossing,
    brownian_exit,
    brownian_exit_density,
    brownian_first_passage_density,
)
from nonsmooth.crossing.random_clock import averaged

_THIN = 2.0  # thickness, in distances of the wall over m, beyond which order 1 is left
_HALF = 0.5  # distance of order 2 from order 3, at most, in those of order 1
_DEEPEST = 300.0  # no slopes are taken where a rate is below exp(-300) of the largest
_STEP = 1e-4  # relative, of difference quotients; their error is of the order of its square


@dataclass(frozen=True)
class Constants:
    """Constants of the expansion; those beyond `known` are 0. See `milne`, `half_space`.

    Attributes
    ----------
    diffusion, lower, upper, poisson : float
        D, kappa of either wall, and u at the start.
    skewness : float
        C.
    dispersion, lower_corner, upper_corner, start : float
        B, S of either wall, and h at the start: of order 2.
    stretch, third : float
        kappa_3, and r at the start: of order 3, for odd g.
    """

    diffusion: float
    lower: float
    upper: float
    poisson: float
    skewness: float = 0.0
    dispersion: float = 0.0
    lower_corner: float = 0.0
    upper_corner: float = 0.0
    start: float = 0.0
    stretch: float = 0.0
    third: float = 0.0


@dataclass(frozen=True)
class Formula:
    """The corrected formulas of a scene and an interval.

    Attributes
    ----------
    constants : Constants
    known : {1, 2, 3}
        The highest order that they suffice for.
    lower, upper : float
        Of int g.
    """

    constants: Constants
    known: int
    lower: float
    upper: float

    @property
    def above(self):
        """Where Brownian motion is absorbed above."""
        return self.upper + self.constants.upper - self.constants.poisson

    @property
    def below(self):
        """Where Brownian motion is absorbed below."""
        return self.lower - self.constants.lower - self.constants.poisson

    @cached_property
    def length(self):
        """Length m of the layer and of all that the velocity remembers."""
        c = self.constants
        return np.sqrt(
            max(c.lower, c.upper) ** 2
            + c.poisson**2
            + abs(c.dispersion) / c.diffusion
            + (c.skewness / c.diffusion) ** 2
        )

    @cached_property
    def second(self):
        """Length s of the terms of order 2; m where they are not known."""
        if self.known == 1:
            return self.length
        c = self.constants
        return np.sqrt(
            max(abs(c.lower_corner), abs(c.upper_corner))
            + abs(c.start - c.poisson**2 / 2)
            + abs(c.dispersion) / c.diffusion
            + (c.skewness / c.diffusion) ** 2
        )

    @property
    def thickness(self):
        """Thickness of the layer in distances of the nearer threshold."""
        return self.length / min(-self.lower, self.upper)

    @property
    def share(self):
        """Share of the last order in what is evaluated; the rest is order 1."""
        return float(np.exp(-((_THIN * self.thickness) ** 4)))

    def orders(self, times):
        """Return the distribution functions of all known orders.

        Parameters
        ----------
        times : numpy.ndarray, shape (k,)
            "1", positive.

        Returns
        -------
        list of numpy.ndarray, shape (k,)
        """
        first, last = self.first(times), self.last(times)
        if self.known < 3:
            return [first, last][: self.known]
        second = self._mixed(2, times)
        reach = _HALF * np.abs(last - first)
        return [first, last + np.clip(second - last, -reach, reach), last]

    def first(self, times):
        """Distribution function of order 1; see `orders`."""
        return self._order(1, times)

    def last(self, times):
        """Distribution function of the highest known order; see `orders`."""
        return self._mixed(self.known, times)

    def frequency(self, times):
        """Inverse times over which the rate of passage changes, shape (k,)."""
        c = self.constants
        late = self._either().slopes(times)[1]
        early = min(self.above, -self.below) ** 2 / (4 * c.diffusion * times**2)
        return 1 / times + np.maximum(np.abs(late), early)

    def _mixed(self, order, times):
        """Evaluate an order, mixed with order 1 where the layer is thick."""
        first = self._order(1, times)
        return first + self.share * (self._order(order, times) - first)

    def _order(self, order, times):
        """Evaluate an order alone."""
        c = self.constants
        D = c.diffusion
        spread = (c.dispersion / D - 5 / 4 * (c.skewness / D) ** 2) / D if order > 1 else 0.0
        total = np.zeros(times.shape)
        for wall in self._walls():
            reached = np.maximum(times + wall.lead, 0.0)
            if order > 1:
                head = c.start - c.poisson**2 / 2 - wall.corner - c.dispersion / D
                if spread < 0:  # which the clock's slope delays less
                    head += D * spread
                reached = _sooner(reached, head / D)

            def crossed(clock, wall=wall):
                return wall.crossed(clock * np.exp(self._exponent(order, wall, spread, clock)))

            total += averaged(crossed, reached, max(spread, 0.0))
        return np.clip(total, 0.0, 1.0)

    def _exponent(self, order, wall, spread, clock):
        """Logarithm of the factor of a clock."""
        if order == 1 or (order == 2 and spread >= 0):
            return 0.0
        c = self.constants
        at, late, outwards, right = wall.slopes(clock)
        exponent = min(spread, 0.0) * late
        if order == 3:
            jump = c.third - c.poisson * c.start + c.poisson**3 / 3
            exponent = exponent + (jump * right - c.stretch * outwards) / (c.diffusion * at)
        return np.where(exponent > 0, exponent / (1 + np.maximum(exponent, 0.0)), exponent)

    def _either(self):
        """Passage through one of the two levels."""
        c = self.constants
        return Passage(self.above, self.below, 2 * c.diffusion, EITHER, c.upper_corner, 0.0)

    def _walls(self):
        """Return the passages whose probabilities add up."""
        c = self.constants
        if c.skewness == 0 and c.lower_corner == c.upper_corner:
            return [self._either()]
        lead = c.skewness / (2 * c.diffusion**2)
        return [
            Passage(self.above, self.below, 2 * c.diffusion, side, corner, lead * distance)
            for side, corner, distance in (
                (UPPER, c.upper_corner, self.above),
                (LOWER, c.lower_corner, self.below),
            )
            if np.isfinite(distance)
        ]


UPPER, LOWER, EITHER = 1, -1, 0


@dataclass(frozen=True)
class Passage:
    """Passage of Brownian motion through one of two levels before the other, or through either.

    Attributes
    ----------
    above, below, rate : float
        The levels, and the variance per unit of time.
    side : {UPPER, LOWER, EITHER}
    corner, lead : float
        S, and the time by which skewness makes the passage earlier.
    """

    above: float
    below: float
    rate: float
    side: int
    corner: float
    lead: float

    def crossed(self, clock):
        """Probability of the passage before a time."""
        variance = np.maximum(self.rate * clock, 1e-300)
        if self.side == UPPER:
            return brownian_exit(self.above, variance, self.below)
        if self.side == LOWER:
            return brownian_exit(-self.below, variance, -self.above)
        return brownian_crossing(self.above, variance, self.below)

    def slopes(self, times):
        """Return T and the logarithmic derivatives of the rate of passage.

        In T, for moving both levels outwards, and for moving the start to the right.
        """
        near, width = self._distance(), self.above - self.below
        times = np.clip(
            times,
            near**2 / (2 * self.rate * _DEEPEST),
            2 * width**2 / (np.pi**2 * self.rate) * _DEEPEST,
        )

        def log_rate(times, outwards=0.0, right=0.0):
            above, below = self.above + outwards - right, self.below - outwards - right
            if self.side == UPPER:
                return np.log(brownian_exit_density(above, self.rate * times, below))
            if self.side == LOWER:
                return np.log(brownian_exit_density(-below, self.rate * times, -above))
            return np.log(brownian_first_passage_density(above, self.rate * times, below))

        step = _STEP * min(self.above, -self.below)
        return (
            times,
            (log_rate(times * (1 + _STEP)) - log_rate(times * (1 - _STEP))) / (2 * _STEP * times),
            (log_rate(times, outwards=step) - log_rate(times, outwards=-step)) / (2 * step),
            (log_rate(times, right=step) - log_rate(times, right=-step)) / (2 * step),
        )

    def _distance(self):
        """Distance to the level, or to the nearer of both."""
        if self.side == EITHER:
            return min(self.above, -self.below)
        return self.above if self.side == UPPER else -self.below


def _sooner(times, lead):
    """Advance times by a lead, or delay them by a negative one, so that they stay in order."""
    if lead > 0:
        return times * (1 + lead / (times + lead))
    return np.maximum(times + lead, 0.0)
