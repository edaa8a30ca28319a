"""Uniform refinement of a grid: the stated error holds."""

import pytest

import nonsmooth as ns


@pytest.mark.parametrize("n", [3.0, 300.0])
@pytest.mark.parametrize("tol", [3e-2, 1e-3, 1e-5])
def test_uniform_refinement_is_honest(n, tol):
    """gamma^2[U' + C_b y] = 1, the forcing balance, within the error, which is within tol."""
    scene = ns.Scene("elasto_plastic", n=n, potential="x**4/4 + x**2/2", observable="x**3 + x + y")
    found = ns.asymptotic_variance(scene, tol)
    assert abs(found.value - 1) <= found.error <= tol * found.value
