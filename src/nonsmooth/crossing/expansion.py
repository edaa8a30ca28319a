"""The orders of the corrected formula, as distribution functions of the time of crossing.

Everything is in the scene's own time and displacement, where p = 1. `docs/methods/crossing.md` has
the derivation. In short, with the constants of `boundary_layer.constants`:

- Order 1 is Brownian motion of the variance 2 D t between moved thresholds. Each of them is kappa
  farther out than the scene's, and the start is moved to the right by u. Without symmetry the
  passage of the upper threshold is C / (2 D^2) times its distance earlier, and that of the lower
  one later.
  With E g != 0, only order 1 is known, and each passage is weighted (`drift`).
- Order 2 is the mean of these probabilities over a random clock (`random_clock`) of the spread
  beta = B/D^2 - 5 C^2 / (4 D^3); passages are (S + B/D - h + u^2/2) / D later. If beta is negative,
  there is no such clock. Then the time is multiplied by the exponential of beta times the
  logarithmic derivative of the rate of passage.
- Order 3 multiplies the time by more factors of this kind: with kappa3, which moves the thresholds
  for short waves; with r - u h + u^3/3 - (C/D) (h - u^2/2), which moves the start; and without
  symmetry with C^3, B C and E, in proportion to the distance of the threshold.

Four rules keep every order a distribution function at any p. The factors are applied one after the
other. A positive exponent X is replaced by X / (1 + X). If passages are earlier by d, the time t is
multiplied by 1 + d / (t + d), so that times stay in order. Where the layer is as thick as the
interval, the expansion means nothing, and order 1 takes over: the last order has the weight exp(-(2
m / b)^4), where m is the thickness of the layer and b the distance to the nearer threshold.
Besides, order 2 is kept at most half as far from order 3 as order 1 is. All these changes are
smaller than the error of the order.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.crossing import drift, tuning
from nonsmooth.crossing.brownian import (
    brownian_crossing,
    brownian_exit,
    brownian_exit_density,
    brownian_first_passage_density,
)
from nonsmooth.crossing.random_clock import averaged

UPPER, LOWER, EITHER = 1, -1, 0


@dataclass(frozen=True)
class Expansion:
    """The corrected formulas of a scene and an interval.

    Attributes
    ----------
    constants : LayerConstants
        They tell the highest order.
    lower, upper : float
        The thresholds of int g, lower < 0 < upper, "1".
    """

    constants: LayerConstants
    lower: float
    upper: float

    @property
    def moved_upper(self) -> float:
        """Upper threshold of Brownian motion, from where it starts."""
        return self.upper + self.constants.kappa[1] - self.constants.u

    @property
    def moved_lower(self) -> float:
        """Lower threshold of Brownian motion, from where it starts."""
        return self.lower - self.constants.kappa[0] - self.constants.u

    @property
    def says_something(self) -> bool:
        """Whether the moved start is between the moved thresholds, and the drift not too large."""
        if not self.moved_lower < 0 < self.moved_upper:
            return False
        return np.isfinite(self.tilt.diffusion) and not any(
            -self.tilt.exponent * end > tuning.DRIFT.largest
            for end in (self.moved_lower, self.moved_upper)
            if np.isfinite(end)
        )

    @cached_property
    def layer_thickness(self) -> float:
        """Thickness m of the layer; the effects of dispersion and skewness are part of it."""
        c = self.constants
        dispersion, skewness = self._memory()
        return np.sqrt(max(c.kappa) ** 2 + c.u**2 + dispersion + skewness)

    @cached_property
    def second_order_scale(self) -> float:
        """Displacement s whose square is the size of all terms of order 2; m if not known.

        Where the dipole is not known, the square of m stands for it.
        """
        c = self.constants
        if c.h is None or c.mean != 0:
            return self.layer_thickness
        start = abs(c.h - c.u**2 / 2)
        if c.dipole is None:
            return np.sqrt(self.layer_thickness**2 + start)
        return np.sqrt(max(np.abs(c.dipole)) + start + sum(self._memory()))

    @cached_property
    def tilt(self) -> drift.Tilt:
        """How the drift is taken away."""
        return drift.tilt(self.constants)

    @property
    def knudsen(self) -> float:
        """Knudsen number: the layer's thickness over the distance to the nearer threshold."""
        return self.layer_thickness / min(-self.lower, self.upper)

    @property
    def weight(self) -> float:
        """Weight of the last order where it is mixed with order 1."""
        return float(np.exp(-((tuning.ORDERS.thin * self.knudsen) ** 4)))

    def orders(self, times: np.ndarray) -> list[np.ndarray]:
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
        if self.constants.order < 3:
            return [first, last][: self.constants.order]
        second = self._mixed(2, times)
        reach = tuning.ORDERS.nearer * np.abs(last - first)
        return [first, last + np.clip(second - last, -reach, reach), last]

    def first(self, times: np.ndarray) -> np.ndarray:
        """Distribution function of order 1; see `orders`."""
        return self._order(1, times)

    def last(self, times: np.ndarray) -> np.ndarray:
        """Distribution function of the highest known order; see `orders`."""
        return self._mixed(self.constants.order, times)

    def frequency(self, times: np.ndarray) -> np.ndarray:
        """Return the inverses of the times over which the rate of passage changes, shape (k,)."""
        D = self.constants.diffusion
        late = self._either().slopes(times)[1]
        early = min(self.moved_upper, -self.moved_lower) ** 2 / (4 * D * times**2)
        return 1 / times + np.maximum(np.abs(late), early) - self.tilt.rate

    def _memory(self):
        """Return the squared displacements of the dispersion and of the skewness."""
        c = self.constants
        dispersion = 0.0 if c.dispersion is None else c.dispersion
        return abs(dispersion) / c.diffusion, (c.skewness / c.diffusion) ** 2

    def _mixed(self, order, times):
        """Evaluate an order, mixed with order 1 where the layer is thick."""
        first = self._order(1, times)
        if order == 1:
            return first
        return first + self.weight * (self._order(order, times) - first)

    def _order(self, order, times):
        """Evaluate an order alone."""
        c = self.constants
        if c.mean != 0:
            return self._drifting(times)
        D = c.diffusion
        spread = (c.dispersion / D - 5 / 4 * (c.skewness / D) ** 2) / D if order > 1 else 0.0
        total = np.zeros(times.shape)
        for passage in self._passages():
            reached = np.maximum(times + passage.lead, 0.0)
            if order > 1:
                lead = c.h - c.u**2 / 2 - passage.dipole - c.dispersion / D
                # a random clock is ahead by its spread, for which B / D makes up in the lead; the
                # factor that stands for a negative spread is not
                if spread < 0:
                    lead += D * spread
                reached = _advanced(reached, lead / D)

            def crossed(clock, passage=passage):
                return passage.crossed(self._moved(order, passage, spread, clock))

            total += averaged(crossed, reached, max(spread, 0.0))
        return np.clip(total, 0.0, 1.0)

    def _drifting(self, times):
        """Evaluate order 1 with a drift; see `drift`."""
        tilt = self.tilt
        still = replace(self.constants, mean=0.0, diffusion=tilt.diffusion)
        total = np.zeros(times.shape)
        for passage in replace(self, constants=still)._sides():
            level = passage.upper if passage.side == UPPER else passage.lower

            def passed(at, passage=passage):
                return passage.crossed(np.maximum(at + passage.lead, 0.0))

            total += tilt.passed(passed, level, times)
        return np.clip(total, 0.0, 1.0)

    def _moved(self, order, passage, spread, clock):
        """Multiply the time of a clock by what is neither a clock nor a lead."""
        if order == 1 or (order == 2 and spread >= 0):
            return clock
        c, D, skew = self.constants, self.constants.diffusion, self.constants.skewness
        at, late, (lower, upper) = passage.slopes(clock)
        exponent = min(spread, 0.0) * late
        if order == 3:
            jump = c.r - c.u * c.h + c.u**3 / 3 - skew / D * (c.h - c.u**2 / 2)
            short_waves = c.kappa3[0] * lower + c.kappa3[1] * upper
            exponent = exponent + (jump * (lower - upper) - short_waves) / (D * at)
        clock = _multiplied(clock, exponent)
        if order == 3 and passage.side != EITHER:
            # a wave that decays like exp(-w x), z = D w^2, has the exponent delay w^4 x, too; in a
            # factor of its own, times stay in order
            delay = (c.fifth - 3 * skew * c.dispersion / D) / (2 * D) + (skew / D) ** 3
            at, late, _ = passage.slopes(clock)
            clock = _multiplied(clock, delay * passage.distance * late / (D**2 * at))
        return clock

    def _either(self):
        """Passage of either threshold, with the dipole of the upper one."""
        c = self.constants
        dipole = None if c.dipole is None else c.dipole[1]
        return BrownianPassage(
            self.moved_upper, self.moved_lower, 2 * c.diffusion, EITHER, dipole, 0.0
        )

    def _passages(self):
        """Return the passages whose probabilities add up."""
        c = self.constants
        dipoles = (None, None) if c.dipole is None else c.dipole
        if c.skewness == 0 and dipoles[0] == dipoles[1]:
            return [self._either()]
        return self._sides()

    def _sides(self):
        """Return the passages of each threshold before the other."""
        c = self.constants
        dipoles = (None, None) if c.dipole is None else c.dipole
        lead = c.skewness / (2 * c.diffusion**2)
        return [
            BrownianPassage(
                self.moved_upper, self.moved_lower, 2 * c.diffusion, side, dipole, lead * distance
            )
            for side, dipole, distance in (
                (UPPER, dipoles[1], self.moved_upper),
                (LOWER, dipoles[0], self.moved_lower),
            )
            if np.isfinite(distance)
        ]


@dataclass(frozen=True)
class BrownianPassage:
    """Passage of Brownian motion through one of two levels before the other, or through either.

    Attributes
    ----------
    upper, lower : float
        The levels, from the start.
    rate : float
        Variance per unit of time.
    side : {UPPER, LOWER, EITHER}
    dipole : float or None
        S of this threshold.
    lead : float
        Time by which skewness makes the passage earlier.
    """

    upper: float
    lower: float
    rate: float
    side: int
    dipole: float | None
    lead: float

    def crossed(self, clock: np.ndarray) -> np.ndarray:
        """Probability of the passage before a time."""
        variance = np.maximum(self.rate * clock, 1e-300)
        if self.side == UPPER:
            return brownian_exit(self.upper, variance, self.lower)
        if self.side == LOWER:
            return brownian_exit(-self.lower, variance, -self.upper)
        return brownian_crossing(self.upper, variance, self.lower)

    @property
    def distance(self) -> float:
        """Way to the threshold, negative to the lower one."""
        return self.upper if self.side == UPPER else self.lower

    def slopes(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, tuple]:
        """Return times and the logarithmic derivatives of the rate of passage there.

        The times are those given, or the nearest at which the rate can be computed; the derivatives
        are in the time, and for moving the lower and the upper level outwards.
        """
        near, width = self._distance(), self.upper - self.lower
        times = np.clip(
            times,
            near**2 / (2 * self.rate * tuning.ORDERS.deepest),
            2 * width**2 / (np.pi**2 * self.rate) * tuning.ORDERS.deepest,
        )

        def log_rate(times, below=0.0, above=0.0):
            upper, lower = self.upper + above, self.lower - below
            if self.side == UPPER:
                return np.log(brownian_exit_density(upper, self.rate * times, lower))
            if self.side == LOWER:
                return np.log(brownian_exit_density(-lower, self.rate * times, -upper))
            return np.log(brownian_first_passage_density(upper, self.rate * times, lower))

        relative = tuning.ORDERS.step
        step = relative * min(self.upper, -self.lower)
        late = log_rate(times * (1 + relative)) - log_rate(times * (1 - relative))
        below = log_rate(times, below=step) - log_rate(times, below=-step)
        above = log_rate(times, above=step) - log_rate(times, above=-step)
        return times, late / (2 * relative * times), (below / (2 * step), above / (2 * step))

    def _distance(self):
        """Distance to the level, or to the nearer of both."""
        if self.side == EITHER:
            return min(self.upper, -self.lower)
        return self.upper if self.side == UPPER else -self.lower


def _multiplied(times, exponent):
    """Multiply times by an exponential; of a positive exponent X, by that of X / (1 + X)."""
    return times * np.exp(exponent / (1 + np.maximum(exponent, 0.0)))


def _advanced(times, lead):
    """Advance times by a lead, or delay them by a negative one, so that they stay in order."""
    if lead > 0:
        return times * (1 + lead / (times + lead))
    return np.maximum(times + lead, 0.0)
