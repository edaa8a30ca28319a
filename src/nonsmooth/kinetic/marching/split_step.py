"""Strang's splitting of q_t = A q + g q_x, for functions q(x, Z) of a place x and a state Z.

q is the probability that x + int g stays inside of an interval: q = 0 where the flow of g leaves.
For odd g and drift, q of an interval at (x, Z) is q of its mirror image at (-x, -Z). So the state
needs pairs of nodes, Z and -Z, and an interval that is its own mirror image only its nodes x > 0.

A change of A or of the interval may be put into the imaginary part, times `IMAGINARY`. Then q
follows in complex numbers, and its imaginary part is the derivative times `IMAGINARY`: what is of
second order is far below rounding. See Squire and Trapp, SIAM Review 40 (1998), 110.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

import numpy as np

from nonsmooth.linear_algebra import dense

IMAGINARY = 1e-30j
_DIGITS = 12  # to which two speeds are the same


@dataclass(frozen=True)
class Interval:
    """Nodes of an interval in x, and derivatives on them.

    Attributes
    ----------
    forward, backward : numpy.ndarray, shape (m, m)
        Upwinded derivatives, for g > 0 and g < 0: values at a face are taken from where g points.
    row : numpy.ndarray, shape (m,)
        Interpolates at x = 0, if `symmetric` from the nodes x > 0.
    symmetric : bool
        Whether the interval is its own mirror image.
    """

    forward: np.ndarray
    backward: np.ndarray
    row: np.ndarray
    symmetric: bool

    @property
    def kept(self) -> np.ndarray:
        """The part of `row` for the nodes on which q is kept."""
        return self.row[len(self.row) // 2 :] if self.symmetric else self.row

    def stretched(self, part: float) -> "Interval":
        """Stretch it about x = 0 by a part, times `IMAGINARY`."""
        longer = 1 + part * IMAGINARY
        return replace(self, forward=self.forward / longer, backward=self.backward / longer)

    def flow(self, way: float) -> np.ndarray:
        """Matrix, to be applied from the right, of the transport by a way of either sign."""
        return dense.exponential(way * (self.forward if way > 0 else self.backward)).T


class SplitStep(ABC):
    """Steps of half a transport, exp(A t), and half a transport; their length can be doubled.

    A scheme for exp(A t) is a class with `mix` and `doubled`, which change and know `there` and
    `opposite`. q = 1 at first. Halves of neighbouring steps are one transport: see `survival`.

    Parameters
    ----------
    interval : Interval
    speeds : numpy.ndarray, shape (k,)
        g at one node of each pair.
    start : numpy.ndarray, shape (2, k)
        Weights of `there` and `opposite` in the interpolation at the start of the state.
    there, opposite : numpy.ndarray, shape (k, m)
        Where q is kept, at the nodes and at their mirror images.
    step : float

    Attributes
    ----------
    there, opposite : numpy.ndarray
    interval : Interval
    step : float
        Length of a step.
    rate : float
        At which what `mix` splits acts; its steps should be shorter than the inverse.
    """

    rate = 0.0

    def __init__(
        self,
        interval: Interval,
        speeds: np.ndarray,
        start: np.ndarray,
        there: np.ndarray,
        opposite: np.ndarray,
        step: float,
    ):
        self.step, self.there, self.opposite = step, there, opposite
        self.interval, self._start = interval, start
        scale = np.max(np.abs(speeds))
        distinct, which = np.unique(np.round(speeds / scale, _DIGITS), return_inverse=True)
        moving = np.flatnonzero(distinct)
        self._seen = np.flatnonzero(np.any(start != 0, axis=0))
        self._rows, self._seen_rows = (
            [np.flatnonzero(part == k) for k in moving] for part in (which, which[self._seen])
        )
        self._half = [self._flows(step / 2 * scale * distinct[k]) for k in moving]
        self._whole = [_squared(flows) for flows in self._half]

    @abstractmethod
    def mix(self) -> None:
        """Apply exp(A t) for a step."""

    def doubled(self) -> None:
        """Make the step twice as long."""
        self.step *= 2
        self._half, self._whole = self._whole, [_squared(flows) for flows in self._whole]

    def transport(self) -> None:
        """Move by g for a step: half a step after `mix` and half a step before the next one."""
        self._transport(self.there, self.opposite, self._rows, self._whole)

    def transport_half(self) -> None:
        """Move by g for half a step, at first and around a change of the step."""
        self._transport(self.there, self.opposite, self._rows, self._half)

    def survival(self) -> complex:
        """Return q at x = 0 and the start of the state, after half a transport."""
        seen = self.there[self._seen], self.opposite[self._seen]
        self._transport(*seen, self._seen_rows, self._half)
        return sum(
            weights @ (values @ self.interval.kept)
            for weights, values in zip(self._start[:, self._seen], seen, strict=True)
        )

    def _flows(self, way):
        """For the nodes; unless the interval is symmetric, also for their mirror images."""
        flow = self.interval.flow
        return [flow(way)] if self.interval.symmetric else [flow(way), flow(-way)]

    def _transport(self, there, opposite, rows, flows):
        """Move values in place; on a symmetric interval, those opposite are those at x < 0."""
        half = there.shape[1]
        for at, flow in zip(rows, flows, strict=True):
            if self.interval.symmetric:
                values = np.hstack([opposite[at][:, ::-1], there[at]]) @ flow[0]
                opposite[at], there[at] = values[:, :half][:, ::-1], values[:, half:]
            else:
                there[at], opposite[at] = there[at] @ flow[0], opposite[at] @ flow[1]


def _squared(matrices):
    return [matrix @ matrix for matrix in matrices]
