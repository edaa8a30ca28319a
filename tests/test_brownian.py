"""W_star against high precision, and as a probability."""

import mpmath
import numpy as np
import pytest

import nonsmooth as ns


def exact(b, T):
    """W_star to fifty digits by the image series, which converges for every T."""
    with mpmath.workdps(50):
        total = mpmath.nsum(
            lambda k: 2 * (-1) ** int(k) * mpmath.erfc((2 * k + 1) * b / mpmath.sqrt(2 * T)),
            [0, 400],
        )
        return float(total)


@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.49, 0.5, 0.51, 1.0, 3.0])
@pytest.mark.parametrize("b", [0.3, 1.0, 7.0])
def test_against_high_precision(b, ratio):
    """Both series to sixteen digits on both sides of the switch, tail included."""
    T = ratio * b**2
    assert float(ns.brownian_crossing(b, T)) == pytest.approx(exact(b, T), rel=2e-14)


def test_small_horizons_keep_relative_accuracy():
    """Where the paper's series has lost every digit, the dual has all of them."""
    value = float(ns.brownian_crossing(1.0, 0.01))
    assert value == pytest.approx(exact(1.0, 0.01), rel=1e-12)
    assert 0 < value < 1e-20


def test_is_a_probability():
    """0 at T = 0, increasing in T, decreasing in b, 1 in the end."""
    T = np.linspace(0, 50, 2001)
    values = ns.brownian_crossing(1.3, T)
    assert values[0] == 0
    assert np.all(np.diff(values) >= 0)
    assert values[-1] == pytest.approx(1, abs=1e-14)
    assert np.all(np.diff(ns.brownian_crossing(np.linspace(0.2, 3, 50), 2.0)) <= 0)


def test_known_value():
    """The limit of figure 2b at T = 2."""
    gamma = np.sqrt(0.137696412899501)
    assert float(ns.brownian_crossing(0.6 / gamma, 2.0)) == pytest.approx(0.5045888, abs=5e-8)
