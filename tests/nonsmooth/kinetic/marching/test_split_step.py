"""What all schemes share: the transport by g."""

import numpy as np
import pytest

from nonsmooth.grids.elements import discontinuous
from nonsmooth.kinetic.marching.split_step import Interval, SplitStep

SPEEDS = np.array([-0.5, 0.0, 2.0])
DEGREE = 3


class Still(SplitStep):
    """A state that does not change."""

    def mix(self):
        """Nothing."""


def steps(step, function, start):
    """On the whole axis: elements so wide that no wall is near."""
    axis = discontinuous(np.array([-40.0, -20.0, -1.0, 0.0, 1.0, 20.0, 40.0]), DEGREE)
    forward, backward = (
        (axis.slope + lift @ axis.jump).toarray() for lift in (axis.lift_left, axis.lift_right)
    )
    interval = Interval(forward, backward, axis.interpolation(0.0).toarray()[0], False)
    there = np.tile(function(axis.nodes), (len(SPEEDS), 1))
    return Still(interval, SPEEDS, np.array(start, float), there, there.copy(), step)


@pytest.mark.parametrize("k", range(len(SPEEDS)))
@pytest.mark.parametrize("side", [1, -1])
def test_polynomials_move_exactly(k, side):
    """After half a step, q(0, Z) is q at g(Z) step / 2; at -Z, at minus that."""
    start = np.zeros((2, len(SPEEDS)))
    start[0 if side == 1 else 1, k] = 1.0
    made = steps(0.2, lambda x: 1 + x - 0.3 * x**3, start)
    at = side * SPEEDS[k] * 0.1
    assert made.survival() == pytest.approx(1 + at - 0.3 * at**3, abs=1e-9)


def test_two_halves_are_a_whole():
    """The flows are those of one equation."""
    one, two = (steps(0.2, np.cos, np.ones((2, len(SPEEDS)))) for _ in range(2))
    one.transport()
    two.transport_half()
    two.transport_half()
    assert one.there == pytest.approx(two.there, abs=1e-12)
    assert one.opposite == pytest.approx(two.opposite, abs=1e-12)
