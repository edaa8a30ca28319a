"""The random clock of the corrected formulas."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from nonsmooth.crossing.random_clock import averaged


class TestRandomClock:
    """Averages over the maximum of s + sqrt(2 b) W(s) for s up to t."""

    @pytest.mark.parametrize("spread", [0.01, 1.0, 30.0])
    def test_mean(self, spread):
        """The mean is that by the inverse Gaussian law of the times at which a level is reached."""

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

    @pytest.mark.parametrize("time", [7.6e11, 1e14])
    def test_small_spread_over_long_times(self, time):
        """The clock strays by less than the time is rounded: its mean is the function there.

        The curvature of the function would add the spread over the time, and the nodes 3e-7.
        """
        found = averaged(lambda s: s / (s + time), np.array([time]), 1e-12)
        assert found[0] == pytest.approx(0.5, abs=3e-7)
