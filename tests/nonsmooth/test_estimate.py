"""Estimates: what cannot be negative is not, and refusals tell small values from 0."""

import numpy as np
import pytest

from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import not_negative, require


def test_negative_values_become_zero():
    """The error is at least the distance that the value was below 0; others stay as they are."""
    value, error = not_negative([-2.0, -1.0, 0.0, 3.0], [1.0, 4.0, 0.5, 0.5])
    assert np.array_equal(value, [0.0, 0.0, 0.0, 3.0])
    assert np.array_equal(error, [2.0, 4.0, 0.5, 0.5])


@pytest.mark.parametrize(
    ("value", "message"),
    [(0.3, r"gamma\^2 = 0\.3 .*; loosen tol$"), (-1e-9, r"gamma\^2 = 0 .* if int_0\^t g stays")],
)
def test_values_that_may_be_zero_say_so(value, message):
    """Those above their error do not."""
    with pytest.raises(ToleranceError, match=message):
        require(False, value, 0.1, 1e-3)
