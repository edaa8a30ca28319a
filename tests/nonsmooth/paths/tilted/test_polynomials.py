"""Monomials of the state: values, cut-offs and slopes."""

import numpy as np

import nonsmooth as ns
from nonsmooth.paths.tilted.polynomials import polynomials

SCENE = ns.Scene("obstacle", noise="langevin", potential="x**2/2", observable="x")
STATE = np.array([[0.3, -0.8], [1.1, 0.2], [-0.4, 0.9]])


def test_values_are_products_of_powers():
    """Within the reach a monomial is the product of powers of the variables over their reach."""
    basis = polynomials(SCENE, 3, STATE, 2.0)
    assert len(basis.exponents) == 20  # binomial(3 + 3, 3)
    z = STATE / basis.reach[:, None]
    wanted = [np.prod(z ** np.array(powers)[:, None], axis=0) for powers in basis.exponents]
    assert np.allclose(basis.values(STATE), wanted, rtol=1e-14)


def test_beyond_the_reach_values_do_not_grow():
    """Each variable is cut off at its reach."""
    basis = polynomials(SCENE, 3, STATE, 1.0)
    assert np.array_equal(basis.values(100 * STATE), basis.values(1e6 * STATE))


def test_slopes_are_derivatives_by_the_driven_variable():
    """The noise enters eta, the first variable: central differences, exact to h^2 f'''/6."""
    basis = polynomials(SCENE, 3, STATE, 2.0)
    lower, factor = basis.slopes
    h = 1e-4
    shift = np.array([[h], [0], [0]])
    numeric = (basis.values(STATE + shift) - basis.values(STATE - shift)) / (2 * h)
    # the third derivative of (z/reach)^3 is at most 6 / reach^3; rounding is 1e-16 / h
    assert np.allclose(basis.values(STATE)[lower] * factor[:, None], numeric, atol=1e-7)
