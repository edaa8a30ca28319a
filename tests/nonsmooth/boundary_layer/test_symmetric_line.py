"""The constants of one variable and odd g, against closed forms and published values."""

import mpmath
import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.boundary_layer.symmetric_line import layer_constants
from references import FRICTION, GAMMA2, KAPPA


@pytest.mark.slow
def test_kappa_of_ornstein_uhlenbeck():
    """Without friction kappa = -zeta(1/2) sigma / (sqrt(2) C_b^(3/2)) (Marshall & Watson)."""
    for damping in (0.1, 0.3, 1.0, 5.0):
        scene = ns.Scene("elasto_plastic", potential="0", damping=damping)
        found = ns.extrapolation_length(scene)
        exact = -float(mpmath.zeta(0.5)) / np.sqrt(2) / damping**1.5
        assert abs(found.value - exact) <= found.error + 1e-9
        assert found.error <= 1e-8


@pytest.mark.slow
def test_kappa3_of_ornstein_uhlenbeck():
    """Waves see the phase -sum atan(k / mu), with mu^2 = 2 C_b^3 j - k^2 (Marshall & Watson).

    Its cubic term has kappa_3 = -zeta(3/2) sigma^3 / (12 sqrt(2) C_b^(9/2)); there is no
    dispersion.
    """
    for damping in (0.3, 1.0, 5.0):
        scene = ns.Scene("elasto_plastic", potential="0", damping=damping)
        found, errors = layer_constants(scene)
        exact = -float(mpmath.zeta(1.5)) / 12 / np.sqrt(2) / damping**4.5
        assert abs(found.kappa3[1] - exact) <= 2 * errors.kappa3[1] + 1e-9 * abs(exact)
        assert abs(found.dispersion) <= 2 * errors.dispersion + 1e-12 / damping**6


def test_independent_prototype():
    """The constants of dry friction are those of another code, to nine digits or more.

    They are from a prototype that shares no code; the manual has them in
    docs/methods/boundary_layer.md.
    """
    found, errors = layer_constants(FRICTION)
    for name, value in (
        ("diffusion", GAMMA2 / 2),
        ("kappa", KAPPA),
        ("dispersion", 0.00369027612),
        ("dipole", -0.0360711815),
        ("h", -0.0188637460),
    ):
        assert np.all(np.abs(np.subtract(getattr(found, name), value)) < 2e-9), name
        assert np.all(np.array(getattr(errors, name)) < 1e-8), name
    assert found.order == errors.order == 3


@pytest.mark.parametrize("n", [1.0, 1e4, 1e6, np.inf])
def test_diffusion_is_half_gamma2(n):
    """2 D is the gamma^2 of the quadrature within the stated error."""
    found, errors = layer_constants(FRICTION.with_n(n))
    gamma2 = ns.asymptotic_variance(FRICTION.with_n(n)).value
    assert abs(2 * found.diffusion - gamma2) <= 2 * errors.diffusion + 1e-10


def test_refuses_what_it_cannot():
    """Colored noise is refused: it has a second state variable."""
    with pytest.raises(ns.NonsmoothError, match="white noise"):
        layer_constants(ns.Scene("friction", "langevin"))
