"""gamma_n^2 in closed form against published values, brute quadrature and its limits."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from nonsmooth.line.dry_friction import friction_variance
from references import GAMMA2, GAMMA2_LIMIT


@pytest.mark.parametrize(("n", "value"), [(100, GAMMA2), (np.inf, GAMMA2_LIMIT)])
def test_published_values(n, value):
    """The published values, of fifteen digits, are met to rounding."""
    assert friction_variance(n)[0] == pytest.approx(value, abs=2e-15)


@pytest.mark.parametrize(("n", "damping"), [(0.5, 1.0), (3, 0.3), (100, 2.5), (np.inf, 0.7)])
def test_against_nested_quadrature(n, damping):
    """The same integral with nothing simplified: a quadrature inside a quadrature."""
    knot = 0.0 if np.isinf(n) else 1 / n

    def density(y):
        a = abs(y)
        return np.exp(-damping * a**2 - (n * a**2 if a < knot else 2 * a - knot))

    end = 7 / np.sqrt(damping) + knot

    def slope(y):
        pieces = [y, knot, end] if y < knot else [y, end]
        mass = sum(
            quad(lambda s: s * density(s), p, q, epsrel=1e-12, epsabs=0)[0]
            for p, q in pairwise(pieces)
        )
        return 2 * mass / density(y)

    pieces = [0.0, knot, end] if knot else [0.0, end]
    square, mass = (
        sum(quad(f, p, q, epsrel=1e-9)[0] for p, q in pairwise(pieces))
        for f in (lambda y: slope(y) ** 2 * density(y), density)
    )
    assert friction_variance(n, damping)[0] == pytest.approx(square / mass, rel=1e-8)


def test_no_friction_is_ornstein_uhlenbeck():
    """As n -> 0 the friction vanishes and gamma^2 -> 1/C_b^2, with an error of order n."""
    for n in (1e-3, 1e-4):
        assert abs(friction_variance(n, 2.0)[0] - 0.25) < n


def test_limit_of_stiff_friction():
    """gamma_n^2 - gamma_inf^2 = c n^-2 + O(n^-3) with c near 0.173."""
    limit = friction_variance(np.inf)[0]
    n = np.array([20.0, 40.0, 80.0, 160.0])
    difference = np.array([friction_variance(k)[0] - limit for k in n])
    rate = np.log2(difference[:-1] / difference[1:])
    assert np.all(np.abs(rate - 2) < 2.5 / n[:-1])
    assert difference[-1] * n[-1] ** 2 == pytest.approx(0.173, abs=1.5 / n[-1])


def test_error_covers_rounding():
    """The stated error stays below 1e-12 for every n and covers the jump between neighbours."""
    for n in np.geomspace(1e-2, 1e6, 30):
        value, error = friction_variance(n)
        neighbour, _ = friction_variance(n * (1 + 1e-15))
        assert error < 1e-12
        assert abs(value - neighbour) <= error
