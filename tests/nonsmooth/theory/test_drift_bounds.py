"""Bounds of the drift of the Lyapunov functions."""

import numpy as np
import pytest

from nonsmooth.scenes.symbols import x, y
from nonsmooth.theory import drift_bounds


def test_bound_has_its_supremum():
    """The supremum is K plus slope^2/(4 quadratic) of each variable, and is attained."""
    bound = drift_bounds.Bound(3.0, {y: 2.0, x: 0.5}, {y: 4.0, x: 1.0})
    at = {y: np.array([1.0]), x: np.array([-1.0])}
    assert bound.evaluate(at)[0][0] == pytest.approx(bound.supremum) == pytest.approx(5.5)
