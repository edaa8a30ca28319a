"""Alternating directions against exp(A t) as a whole."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

import nonsmooth as ns
from nonsmooth.grids.elements import discontinuous
from nonsmooth.grids.generator import assemble
from nonsmooth.kinetic.marching.split_step import Interval
from nonsmooth.kinetic.marching.tensor import TensorSteps, tensor_ordinates
from nonsmooth.kinetic.ordinates_plane import axes, boxed
from nonsmooth.kinetic.tuning import PlaneLevel
from references import COLORED_FRICTION, PLASTIC_STRAIN

LEVEL = PlaneLevel(3, (3, 9.0), (7, ()), 2, 8.0, 0.2, 0.0)


def interval(edges, symmetric=False):
    """Elements of degree 2; where the flow leaves, nothing comes in."""
    step = edges[1] - edges[0]
    axis = discontinuous(np.concatenate([[edges[0] - step], edges, [edges[-1] + step]]), 2)
    inner = slice(3, -3)
    forward, backward = (
        (axis.slope + lift @ axis.jump).toarray()[inner, inner]
        for lift in (axis.lift_left, axis.lift_right)
    )
    row = axis.interpolation(1e-12).toarray()[0, inner]
    return Interval(forward, backward, row, symmetric)


@pytest.mark.parametrize("scene", [COLORED_FRICTION, PLASTIC_STRAIN], ids=["friction", "plastic"])
def test_tends_to_the_whole_exponential(scene):
    """The error of a fixed time falls fourfold when the step is halved: order 2 (2.8 to 5.7)."""
    ends = boxed(scene)
    grid, made = tensor_ordinates(scene, ends, LEVEL, 1.0), axes(scene, ends, LEVEL, 1.0)
    place, shape = list(made).index(scene.noise.driven), [len(a.nodes) for a in made.values()]
    values = np.random.default_rng(1).normal(size=(*grid.speeds.shape, 3))
    in_order = np.moveaxis(values, 1, place).reshape(-1, 3)
    exact = scipy.linalg.expm(0.05 * assemble(scene, made).toarray()) @ in_order
    exact = np.moveaxis(exact.reshape(*shape, 3), place, 1)
    weights, errors = np.abs(grid.start)[..., None] + 1e-3, []
    for count in (32, 64):
        steps = TensorSteps(grid, interval(np.array([-1.0, 1.0])), 0.05 / count)
        steps.there[:], steps.opposite[:] = (
            half.reshape(len(steps.there), 3) for half in _halves(values)
        )
        for _ in range(count):
            steps.mix()
        errors.append(
            sum(
                np.sum(np.abs(part - half) * weight)
                for part, half, weight in zip(
                    (steps.there, steps.opposite), _halves(exact), _halves(weights), strict=True
                )
            )
        )
    assert 2.8 < errors[0] / errors[1] < 5.7


def _halves(values):
    """Split into one node of each pair and its mirror image."""
    flat = values.reshape(-1, values.shape[-1])
    return flat[len(flat) // 2 :], flat[: len(flat) // 2][::-1]


@pytest.mark.parametrize("scene", [COLORED_FRICTION, PLASTIC_STRAIN], ids=["friction", "plastic"])
def test_half_of_a_symmetric_interval_is_enough(scene):
    """The same survival probabilities, but for rounding, with and without the symmetry."""
    grid = tensor_ordinates(scene, boxed(scene), LEVEL, 1.0)
    edges = np.linspace(-0.2, 0.2, 9)
    found = []
    for symmetric in (False, True):
        steps = TensorSteps(grid, interval(edges, symmetric), 0.05)
        steps.transport_half()
        found.append([])
        for _ in range(40):
            steps.mix()
            found[-1].append(steps.survival())
            steps.transport()
    assert found[0] == pytest.approx(found[1], abs=1e-12)
    assert 0 < found[0][-1] < 0.99


def test_a_doubled_step_is_a_step_of_twice_the_length():
    """Flows and exponentials are squared."""
    grid = tensor_ordinates(COLORED_FRICTION, boxed(COLORED_FRICTION), LEVEL, 1.0)
    place = interval(np.linspace(-0.5, 0.5, 5))
    long, short = TensorSteps(grid, place, 0.02), TensorSteps(grid, place, 0.01)
    short.doubled()
    assert short.step == long.step
    for steps in (long, short):
        steps.transport_half()
        steps.mix()
        steps.transport()
        steps.mix()
    assert short.survival() == pytest.approx(long.survival(), abs=1e-12)


def test_the_rate_is_that_of_the_noise_or_of_the_spring():
    """An Ornstein-Uhlenbeck noise relaxes at its own rate; a spring of stiffness 4 has rate 2."""
    fast = ns.Scene("friction", ns.OrnsteinUhlenbeck(3.0, 1.0), n=50, damping=0.2)
    stiff = replace(PLASTIC_STRAIN, damping=0.1, potential="2*x**2")
    for scene, rate in ((fast, 3.0), (stiff, 2.0)):
        assert tensor_ordinates(scene, boxed(scene), LEVEL, 1.0).rate == pytest.approx(rate)
