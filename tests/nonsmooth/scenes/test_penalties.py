"""Moreau-Yosida regularisation: the penalties are the infimal convolutions they claim to be."""

import numpy as np
import pytest
import sympy

from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import ABSOLUTE_VALUE, BARRIER, n

z = sympy.Symbol("z", real=True)


@pytest.mark.parametrize("stiffness", [2, 10, 100])
@pytest.mark.parametrize(
    ("penalty", "convex", "domain"),
    [(ABSOLUTE_VALUE, np.abs, 4.0), (BARRIER, lambda u: 0 * u, 1.0)],
)
def test_potential_is_the_infimal_convolution(penalty, convex, domain, stiffness):
    """phi_n(z) = inf_u n/2 (z - u)^2 + phi(u), by minimising over a fine grid of u."""
    u = np.linspace(-domain, domain, 400_001)
    points = np.linspace(-3, 3, 13)
    infimum = [np.min(stiffness / 2 * (point - u) ** 2 + convex(u)) for point in points]
    value = vectorised(penalty.potential(z).subs(n, stiffness), (z,))(points)
    # the grid misses the minimiser by at most du/2, which costs n/2 (du/2)^2 + |phi'| du/2
    spacing = u[1] - u[0]
    assert np.allclose(value, infimum, atol=stiffness * spacing**2 + spacing, rtol=0)


@pytest.mark.parametrize("penalty", [ABSOLUTE_VALUE, BARRIER])
def test_force_is_the_derivative(penalty):
    """Central differences of phi_n give phi_n' away from the kinks, to second order."""
    points = np.array([-2.3, -1.1, -0.7, -0.004, 0.003, 0.4, 1.7])
    potential = vectorised(penalty.potential(z).subs(n, 100), (z,))
    force = vectorised(penalty.force(z).subs(n, 100), (z,))
    h = 1e-5
    slope = (potential(points + h) - potential(points - h)) / (2 * h)
    # phi_n is piecewise quadratic: central differences are exact up to rounding eps |phi| / h
    assert np.allclose(force(points), slope, atol=1e-8)


@pytest.mark.parametrize("penalty", [ABSOLUTE_VALUE, BARRIER])
@pytest.mark.parametrize("stiffness", [0.5, 7.0, float("inf")])
def test_numbers_agree_with_the_formula(penalty, stiffness):
    """(knot, inner, outer), which the kernels use, reproduce the typeset force."""
    knot, inner, outer = penalty.at(stiffness)
    if stiffness == float("inf"):
        assert (knot, inner, outer) in [(0.0, np.inf, 0.0), (1.0, 0.0, np.inf)]
        return
    points = np.linspace(-4, 4, 41)
    force = vectorised(penalty.force(z).subs(n, stiffness), (z,))(points)
    beyond = np.sign(points) * (inner * knot + outer * (np.abs(points) - knot))
    assert np.allclose(force, np.where(np.abs(points) <= knot, inner * points, beyond))
