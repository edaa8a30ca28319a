"""What all schemes share: the transport by g, and derivatives in imaginary parts."""

from dataclasses import replace

import numpy as np
import pytest

from nonsmooth.grids.elements import discontinuous
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic.marching.coefficients import CoefficientSteps
from nonsmooth.kinetic.marching.split_step import IMAGINARY, Interval, SplitStep
from nonsmooth.kinetic.marching.tensor import TensorSteps, tensor_ordinates
from nonsmooth.kinetic.ordinates_plane import boxed
from nonsmooth.kinetic.tuning import PlaneLevel
from nonsmooth.sensitivity.parameters import change
from references import COLORED_FRICTION, OBSTACLE
from support import coarse_ordinates

SPEEDS = np.array([-0.5, 0.0, 2.0])
DEGREE = 3
FRICTION, WALLS = COLORED_FRICTION.with_n(5), OBSTACLE.with_n(5)


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


def interval():
    """Make elements of degree 2 between -0.6 and 0.6, where nothing comes in."""
    axis = discontinuous(np.linspace(-0.8, 0.8, 9), 2)
    inner = slice(3, -3)
    forward, backward = (
        (axis.slope + lift @ axis.jump).toarray()[inner, inner]
        for lift in (axis.lift_left, axis.lift_right)
    )
    return Interval(forward, backward, axis.interpolation(1e-12).toarray()[0, inner], False)


def survival(scheme, grid, made):
    """After three steps, the last of which is twice as long."""
    steps = scheme(grid, made, 0.1)
    steps.transport_half()
    for _ in range(2):
        steps.mix()
        steps.transport()
    steps.doubled()
    steps.mix()
    return steps.survival()


def tensor(scene):
    """Make a tensor grid that changes with the damping in its imaginary part, and real changes."""
    level = PlaneLevel(3, (3, 9.0), (7, ()), 2, 8.0, 0.2, 0.0)
    grid = tensor_ordinates(scene, boxed(scene), level, 1.0, change(scene, "damping"))

    def at(part):
        driven, other = (
            block.real + part * (block / IMAGINARY).real for block in (grid.driven, grid.other)
        )
        return replace(grid, driven=driven, other=other)

    return TensorSteps, grid, at


def hermite(scene):
    """Make the same of a grid in Hermite polynomials."""
    grid = coarse_ordinates(scene, change(scene, "damping"))
    return CoefficientSteps, grid.changed(IMAGINARY), grid.changed


@pytest.mark.parametrize(("make", "scene"), [(tensor, FRICTION), (hermite, WALLS)])
class TestImaginaryParts:
    """Against a central difference of the order 4: with a spacing of 0.003, 1e-10 of derivatives.

    The tolerance of 1e-6 leaves room for their growth with the order, and for rounding.
    """

    def test_change_of_the_generator(self, make, scene):
        """By the damping."""
        scheme, grid, at = make(scene)
        found = survival(scheme, grid, interval())
        near, far = (
            np.subtract(*(survival(scheme, at(side * h), interval()) for side in (1, -1)))
            for h in (0.003, 0.006)
        )
        expected = (8 * near - far) / 0.036
        assert abs(expected) > 1e-5, "the comparison would see nothing"
        assert (found / IMAGINARY).real == pytest.approx(expected, rel=1e-6)
        assert found.real == pytest.approx(survival(scheme, at(0.0), interval()), abs=1e-13)

    def test_longer_intervals(self, make, scene):
        """By the logarithm of the length."""
        scheme, _, at = make(scene)
        grid, made = at(0.0), interval()
        found = survival(scheme, grid, made.stretched(1.0))

        def longer(part):
            forward, backward = made.forward / (1 + part), made.backward / (1 + part)
            return survival(scheme, grid, replace(made, forward=forward, backward=backward))

        near, far = (longer(h) - longer(-h) for h in (0.003, 0.006))
        expected = (8 * near - far) / 0.036
        assert abs(expected) > 1e-5, "the comparison would see nothing"
        assert (found / IMAGINARY).real == pytest.approx(expected, rel=1e-6)


def test_nothing_is_lost_in_real_numbers():
    """Without a change the grids stay real, and steps with them."""
    grid = coarse_ordinates(WALLS)
    assert not any(np.iscomplexobj(grid.generator[parity].data) for parity in (EVEN, ODD))
    assert CoefficientSteps(grid, interval(), 0.1).there.dtype == float
