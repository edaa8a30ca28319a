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
        self._seen = np.flatnonzero(np.any(start != 0, axis=0))
        # speeds that have the same number of nodes are moved together
        many = np.where(distinct != 0, np.bincount(which), 0)
        groups = [np.flatnonzero(many == count) for count in np.unique(many[many > 0])]
        self._rows = [np.array([np.flatnonzero(which == k) for k in group]) for group in groups]
        self._half = [self._flows(step / 2 * scale * distinct[group]) for group in groups]
        self._whole = [flows @ flows for flows in self._half]
        self._weights = self._weights_of_survival()

    @abstractmethod
    def mix(self) -> None:
        """Apply exp(A t) for a step."""

    def doubled(self) -> None:
        """Make the step twice as long."""
        self.step *= 2
        self._half, self._whole = self._whole, [flows @ flows for flows in self._whole]
        self._weights = self._weights_of_survival()

    def transport(self) -> None:
        """Move by g for a step: half a step after `mix` and half a step before the next one."""
        self._transport(self.there, self.opposite, self._whole)

    @property
    def operations(self) -> float:
        """Additions and multiplications of a step."""
        groups = zip(self._rows, self._whole, strict=True)
        return 2.0 * sum(flows.size * at.shape[-1] for at, flows in groups)

    def transport_half(self) -> None:
        """Move by g for half a step, at first and around a change of the step."""
        self._transport(self.there, self.opposite, self._half)

    def survival(self) -> complex:
        """Return q at x = 0 and the start of the state, after half a transport."""
        return sum(
            np.sum(weights * values[self._seen])
            for weights, values in zip(self._weights, (self.there, self.opposite), strict=True)
        )

    def _weights_of_survival(self):
        """Weights of the values before half a transport in what the start sees after it.

        The transport of the weights is the transposed one.
        """
        weights = self._start[:, :, None] * self.interval.kept
        weights = weights.astype(np.result_type(weights, *self._half))
        self._transport(*weights, [np.swapaxes(flows, -1, -2) for flows in self._half])
        return weights[:, self._seen]

    def _flows(self, ways):
        """For the nodes; unless the interval is symmetric, also for their mirror images."""
        sides = (1,) if self.interval.symmetric else (1, -1)
        return np.array([[self.interval.flow(side * way) for way in ways] for side in sides])

    def _transport(self, there, opposite, groups):
        """Move values in place; on a symmetric interval, those opposite are those at x < 0."""
        half = there.shape[1]
        for at, flows in zip(self._rows, groups, strict=True):
            if self.interval.symmetric:
                values = np.concatenate([opposite[at][..., ::-1], there[at]], axis=-1) @ flows[0]
                opposite[at], there[at] = values[..., half - 1 :: -1], values[..., half:]
            else:
                there[at], opposite[at] = there[at] @ flows[0], opposite[at] @ flows[1]
