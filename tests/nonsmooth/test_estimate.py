"""Estimates: what cannot be negative is not, and refusals tell small values from 0."""

import numpy as np
import pytest

from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import Estimate, not_negative, require


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


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (0.0441961, 1.3e-6, "0.0441961 +- 1.3e-06"),
        (1234.567, 20.0, "1235 +- 2.0e+01"),
        (0.137696412899501, 1.7e-17, "0.137696412899501 +- 1.7e-17"),
        (0.0, 0.0, "0 +- 0.0e+00"),
        (1e-9, 2.0, "1e-09 +- 2.0e+00"),
        (-0.25, float("inf"), "-0.25 +- inf"),
    ],
)
def test_an_estimate_shows_the_digits_that_it_has(value, error, shown):
    """As a text, and in notebooks, where the method's name is no markup."""
    estimate = Estimate(value, error, "a<b", 0.01)
    assert str(estimate) == f"{shown} (a<b, 0.01 s)"
    assert "a&lt;b" in estimate._repr_html_()
    assert shown.split()[0] in estimate._repr_html_()
