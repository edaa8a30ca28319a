"""The corrected formulas' distribution functions, and the constants without symmetry."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

import nonsmooth as ns
from nonsmooth.boundary_layer.asymmetric_line import walls
from nonsmooth.boundary_layer.symmetric_line import expansion
from nonsmooth.crossing.brownian import brownian_exit, brownian_exit_density
from nonsmooth.crossing.expansion import Constants, Formula
from nonsmooth.crossing.random_clock import averaged
from nonsmooth.line.eigenfunctions import spectrum
from nonsmooth.line.quadrature import mean as stationary_mean


@pytest.fixture(scope="module")
def skewed():
    """Constants of a g without symmetry."""
    scene = ns.Scene("friction", observable="y + 0.3*abs(y) - 0.0958534263954079", start={"y": 0.2})
    return scene, *walls(scene)


class TestConstants:
    """Without symmetry of g."""

    def test_lengths(self, skewed):
        """The flux of the two Milne problems' product gives kappa_+ - kappa_- = C/D."""
        _, found, _ = skewed
        assert found.upper - found.lower == pytest.approx(
            found.skewness / found.diffusion, abs=1e-12
        )

    def test_cumulants(self, skewed):
        """D, C and B are the first derivatives of the largest eigenvalue of A + q g at q = 0."""
        scene, found, _ = skewed
        s = spectrum(scene, 10)

        def growth(q):
            return np.linalg.eigvalsh(q * s.product - np.diag(s.rates))[-1]

        # polynomials in q: what is left out is of the order 0.3^5 of the largest
        q = 0.3 * np.cos(np.pi * (np.arange(16) + 0.5) / 16)
        fit = np.polynomial.Polynomial.fit(q, [growth(at) for at in q], 12).convert().coef
        expected = [0, 0, found.diffusion, found.skewness, found.dispersion]
        assert fit[:5] == pytest.approx(expected, abs=1e-8)

    def test_corners(self):
        """Those of an odd g, as its half grid has them, if an even part is added that vanishes."""
        odd, _ = expansion(ns.Scene("friction", n=1, start={"y": 0.5}))
        scene = ns.Scene("friction", n=1, observable="y + 1e-6*(abs(y) - 0.3)", start={"y": 0.5})
        mean = float(stationary_mean(scene)[0])
        scene = ns.Scene(
            "friction", n=1, observable=f"y + 1e-6*(abs(y) - 0.3) - ({mean!r})", start={"y": 0.5}
        )
        found, _ = walls(scene, 1e-6)
        for side in (found.lower_corner, found.upper_corner):
            assert side == pytest.approx(odd.corner, abs=2e-5)
        assert found.dispersion == pytest.approx(odd.dispersion, abs=2e-5)
        assert found.start == pytest.approx(odd.start, abs=2e-5)


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
def test_without_symmetry_is_a_distribution(skewed, interval):
    """Between 0 and 1, and monotone in T, at any p."""
    constants = Constants(**vars(skewed[1]))
    for p in (1e-2, 1.0, 30.0, 1e3):
        formula = Formula(constants, 2, *(np.sqrt(p) * np.array(interval)))
        for value in formula.orders(p * np.geomspace(1e-3, 1e3, 300)):
            assert np.all((value >= 0) & (value <= 1))
            assert np.all(np.diff(value) >= -1e-13)  # rounding of sums of eighty terms
