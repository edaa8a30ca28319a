"""The Milne problem of two variables and its adjoint, on one grid."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.boundary_layer import half_space
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.tensor_grid import direct_solver, fitted

OBSTACLE = ns.Scene("obstacle", potential="x**2/2", n=5, observable="x")
YIELDING = ns.Scene("elasto_plastic", potential="x**2/2", n=5, observable="plastic_strain_rate")


def grid_of(scene):
    """Make a grid that is coarse, so that what holds here holds on every grid."""
    return fitted(scene, 6.0, 0)


@pytest.mark.parametrize("scene", [OBSTACLE, YIELDING], ids=["obstacle", "elasto_plastic"])
class TestConservation:
    """E[g q q*] is the same at every distance from the threshold, and 0 there."""

    def test_same_length(self, scene):
        """Far away it is D (kappa - kappa*), on every grid."""
        _, solutions = half_space.solved(scene, grid_of(scene))
        layer, adjoint = solutions
        assert layer.kappa == pytest.approx(adjoint.kappa, rel=1e-7)

    def test_modes_carry_no_flux(self, scene):
        """E[g d] is 0, and with it what the layer does to the diffusion."""
        grid = grid_of(scene)
        axes, solver = direct_solver(scene, grid)
        g = solver.fold(evaluate(scene.numerical_observable(), axes))
        masses, solutions = half_space.solved(scene, grid)
        layer, adjoint = solutions
        size = np.abs(masses * g).sum()
        assert np.abs((masses * g) @ layer.odd @ layer.start) < 1e-9 * size
        assert np.abs(g @ adjoint.odd @ adjoint.start) < 1e-9 * size

    def test_nothing_leaves_at_the_threshold(self, scene):
        """The solution is 0 at x = 0 where g > 0, and so is that of the adjoint, reflected."""
        grid = grid_of(scene)
        axes, solver = direct_solver(scene, grid)
        g = solver.fold(evaluate(scene.numerical_observable(), axes))
        masses, (layer, adjoint) = half_space.solved(scene, grid)
        for one, constant in ((layer, np.ones(len(g))), (adjoint, masses)):
            inner = one.kappa * constant + one.even @ one.strengths
            # values on half of the grid: those of the other half are reflected
            at_threshold = inner + np.sign(g) * (one.odd @ one.start - one.u)
            moving = np.abs(g) > 1e-9
            assert np.max(np.abs(at_threshold[moving])) < 1e-7 * np.max(np.abs(one.u))


@pytest.mark.slow
def test_a_reversible_motion_is_its_own_adjoint():
    """With obstacles and white noise the reversed motion differs by the sign of y alone.

    The means of both layers are the same, up to what the grid breaks of the symmetry: it is less
    on a finer one.
    """
    broken = []
    for level in (0, 1):
        masses, (layer, adjoint) = half_space.solved(OBSTACLE, fitted(OBSTACLE, 6.0, level))
        mean, other = masses @ layer.even @ layer.start, adjoint.even.sum(axis=0) @ adjoint.start
        broken.append(abs(mean - other) / abs(mean))
    assert broken[0] < 0.05
    assert broken[1] < broken[0] / 2
