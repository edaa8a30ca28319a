"""What the corrected formulas are made of: random clock, densities, distribution functions."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from nonsmooth.boundary_layer.asymmetric_line import layer_constants
from nonsmooth.crossing.brownian import brownian_exit, brownian_exit_density
from nonsmooth.crossing.expansion import Expansion
from nonsmooth.crossing.random_clock import averaged
from references import SKEWED_AND_STARTED


class TestRandomClock:
    """The maximum of t + sqrt(2 b) W(t)."""

    @pytest.mark.parametrize("spread", [0.01, 1.0, 30.0])
    def test_mean(self, spread):
        """Against the inverse Gaussian law of the times at which it reaches a level."""

        def slope(level, t):
            """Of exp(-1/level), times the law of the time, of mean level and variance 2 b level."""
            law = stats.invgauss(2 * spread / level, scale=level**2 / (2 * spread))
            return np.exp(-1 / level) / level**2 * law.cdf(t)

        for t in (0.3, 2.0):
            expected = quad(slope, 0, 300, args=(t,), points=[0.1, 1, 10], limit=200)[0]
            found = averaged(lambda s: np.exp(-1 / s), np.array([t]), spread)
            assert found[0] == pytest.approx(expected, abs=3e-7)

    def test_no_spread(self):
        """The clock is the time, and nothing has passed before 0."""
        found = averaged(lambda s: s**2, np.array([-1.0, 0.0, 3.0]), 0.0)
        assert found.tolist() == [0.0, 0.0, 9.0]


@pytest.mark.parametrize(("b", "lower"), [(0.5, -0.7), (2.0, -0.1), (0.5, -np.inf)])
def test_exit_density(b, lower):
    """The density is the slope of the probability, on either side of T = L^2."""
    T = np.array([0.2, 1.0, 1.4, 4.5, 6.0])
    step = 1e-5 * T
    slope = (brownian_exit(b, T + step, lower) - brownian_exit(b, T - step, lower)) / (2 * step)
    assert brownian_exit_density(b, T, lower) == pytest.approx(slope, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("interval", [(-0.3, 0.6), (-np.inf, 0.6), (-0.6, np.inf)])
def test_without_symmetry_is_a_distribution(interval):
    """Between 0 and 1, and monotone in T, at any p."""
    constants, _ = layer_constants(SKEWED_AND_STARTED)
    for p in (1e-2, 1.0, 30.0, 1e3):
        formula = Expansion(constants, *(np.sqrt(p) * np.array(interval)))
        for value in formula.orders(p * np.geomspace(1e-3, 1e3, 300)):
            assert np.all((value >= 0) & (value <= 1))
            assert np.all(np.diff(value) >= -1e-13)  # rounding of sums of eighty terms
