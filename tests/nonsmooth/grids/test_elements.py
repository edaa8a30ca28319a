"""Elements of one variable: their interpolation and their weights."""

import numpy as np
import pytest

from nonsmooth.grids import elements


@pytest.mark.parametrize("make", [elements.continuous, elements.discontinuous])
def test_interpolation_is_exact_on_polynomials(make):
    """A cubic on elements of degree 3, at points within, on edges and outside."""
    axis = make(np.array([-1.0, 0.3, 2.0]), 3)
    points = np.array([-1.0, -0.4, 0.3, 1.9, 2.0])
    cubic = axis.nodes**3 - axis.nodes
    assert axis.interpolation(points) @ cubic == pytest.approx(points**3 - points, abs=1e-13)
    assert axis.interpolation([2.5]) @ cubic == 0
    assert axis.weights @ cubic == pytest.approx((2.0**4 - 1) / 4 - (2.0**2 - 1) / 2)
