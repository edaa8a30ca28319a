"""kappa of two variables, where the generator is not self-adjoint."""

import mpmath
import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.boundary_layer.two_variables import layer_constants


@pytest.mark.slow
def test_ornstein_uhlenbeck():
    """A spring too weak to matter: the closed form of one variable, by the solver of two."""
    found = ns.extrapolation_length(ns.Scene("elasto_plastic", potential="1e-9*x**2"))
    exact = -float(mpmath.zeta(0.5)) / np.sqrt(2)
    # the spring adds of the order of its stiffness
    assert abs(found.value - exact) <= found.error + 1e-8
    assert found.error <= 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("damping", [0.3, 1.0])
def test_solutions_of_different_boxes_and_grids_agree(damping):
    """Two tolerances lead to other boxes and grids; both results are within their errors.

    The modes of this scene are so far from orthogonal that by eigenvectors they lose all digits.
    """
    scene = ns.Scene("obstacle", damping=damping, potential="x**2/2", observable="x")
    coarse, fine = (ns.extrapolation_length(scene, tol) for tol in (1e-2, 2e-3))
    assert coarse.error <= 1e-2
    assert fine.error <= 2e-3
    assert abs(coarse.value - fine.value) <= coarse.error + fine.error


@pytest.mark.slow
def test_yielding_displacement():
    """The displacement crosses b when the plastic strain crosses b - 1, for it yields at x = 1.

    Exactly so at n = inf; at a finite n, x passes 1 by y/n, with y of order 1.
    """
    total, plastic = (
        ns.extrapolation_length(
            ns.Scene("elasto_plastic", potential="x**2/2", n=1e4, observable=g), tol=1e-2
        )
        for g in ("y", "plastic_strain_rate")
    )
    assert abs(total.value - (plastic.value - 1)) <= total.error + plastic.error + 1e-4


@pytest.mark.slow
def test_a_start_far_out():
    """At the start u is the mean of int g after a long time, also beyond the density's grids.

    The sample is off by less than 4.5 standard errors; false alarms 7e-6.
    """
    scene = ns.Scene("friction", ns.OrnsteinUhlenbeck(1.0), n=10, start={"y": 30.0})
    constants, errors = layer_constants(scene, 0.1)
    run = ns.simulate(scene, horizon=20.0, step=0.01, paths=4096, seed=3)
    allowed = errors.u + 4.5 * run["mean_error"][-1] + abs(run["mean_bias"][-1])
    assert abs(constants.u - run["mean"][-1]) < allowed
    assert allowed < 0.3


def test_bounded_observable():
    """Velocities whose integral stays bounded have gamma^2 = 0, and no extrapolation length."""
    with pytest.raises(ns.NonsmoothError, match="no extrapolation length"):
        ns.extrapolation_length(ns.Scene("obstacle", potential="x**2/2", observable="y"))
