"""Integrals of products of exponentials."""

import numpy as np
import pytest

from nonsmooth.kinetic.derivatives.exponentials import against, along


@pytest.mark.parametrize("length", [0.3, np.inf])
def test_integrals_of_exponentials(length):
    """Against Gauss quadrature, also for rates that are nearly the same."""
    rates = np.array([0.5, 0.5 + 1e-5, 2.0 + 1.0j])
    s, weights = np.polynomial.legendre.leggauss(80)
    end = min(length, 100.0)  # of which exp(-50) is left
    s, weights = end * (s + 1) / 2, end * weights / 2
    first, second = (np.exp(-np.outer(rates, at)) for at in (s, end - s))
    assert np.allclose(along(rates, length), (first * weights) @ first.T, rtol=1e-9)
    if np.isfinite(length):
        assert np.allclose(against(rates, length), (first * weights) @ second.T, rtol=1e-9)
    else:
        assert not against(rates, length).any()
