"""The constants of one variable and a g without symmetry."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.boundary_layer import symmetric_line
from nonsmooth.boundary_layer.asymmetric_line import layer_constants
from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.line.eigenfunctions import spectrum
from nonsmooth.line.quadrature import mean as stationary_mean
from references import FRICTION, KAPPA, MIRRORED, SKEWED, SKEWED_AND_STARTED


@pytest.fixture(scope="module")
def skewed():
    """Constants of a g without symmetry, and their errors."""
    return layer_constants(SKEWED_AND_STARTED)


def test_difference_of_the_extrapolation_lengths(skewed):
    """The flux of the two Milne problems' product gives kappa_+ - kappa_- = C/D."""
    found, _ = skewed
    lower, upper = found.kappa
    assert upper - lower == pytest.approx(found.skewness / found.diffusion, abs=1e-12)
    assert found.order == 3


def test_difference_for_short_waves(skewed):
    """The same flux at z != 0, where waves with both roots of Lambda(q) = z count.

    With c = C/D and means M, it gives
    kappa3_- - kappa3_+ = (2 E - 4 c B) / D - c M[u^2] + 11 c^3 / 6 + 2 M[u h].
    """
    found, errors = skewed
    grid = ordinates(SKEWED_AND_STARTED, 14)
    g, mean = grid.g, lambda f: grid.masses @ f
    u = grid.resolvent(0.0, EVEN, (g - mean(g))[:, None])[:, 0]
    h = grid.resolvent(0.0, EVEN, (g * u)[:, None])[:, 0]
    D, c = found.diffusion, found.skewness / found.diffusion
    expected = (2 * found.fifth - 4 * c * found.dispersion) / D - c * mean(u * u)
    expected += 11 / 6 * c**3 + 2 * mean(u * h)
    lower, upper = found.kappa3
    assert lower - upper == pytest.approx(expected, abs=1e-9 + errors.largest())


@pytest.mark.slow
def test_cumulants(skewed):
    """D, C, B and E are the first derivatives of the largest eigenvalue of A + q g at q = 0."""
    found, _ = skewed
    s = spectrum(SKEWED_AND_STARTED, 10)

    def largest(q):
        return np.linalg.eigvalsh(q * s.product - np.diag(s.rates))[-1]

    # polynomials in q: what is left out is of the order 0.3^5 of the largest
    q = 0.3 * np.cos(np.pi * (np.arange(16) + 0.5) / 16)
    fit = np.polynomial.Polynomial.fit(q, [largest(at) for at in q], 12).convert().coef
    expected = [0, 0, found.diffusion, found.skewness, found.dispersion, found.fifth]
    assert fit[:5] == pytest.approx(expected[:5], abs=1e-8)
    # errors of the eigenvalues are divided by one more 0.3
    assert fit[5] == pytest.approx(expected[5], abs=1e-8 / 0.3)


def test_limit_of_odd_g():
    """As the even part of g vanishes, the constants tend to those of the odd g."""
    odd, _ = symmetric_line.layer_constants(ns.Scene("friction", n=1, start={"y": 0.5}))
    scene = ns.Scene("friction", n=1, observable="y + 1e-6*(abs(y) - 0.3)", start={"y": 0.5})
    mean = float(stationary_mean(scene)[0])
    scene = ns.Scene(
        "friction", n=1, observable=f"y + 1e-6*(abs(y) - 0.3) - ({mean!r})", start={"y": 0.5}
    )
    found, _ = layer_constants(scene, 1e-6)
    assert found.dipole == pytest.approx(odd.dipole, abs=2e-5)
    assert found.dispersion == pytest.approx(odd.dispersion, abs=2e-5)
    assert found.h == pytest.approx(odd.h, abs=2e-5)
    assert found.kappa3 == pytest.approx(odd.kappa3, abs=2e-5)
    assert found.r == pytest.approx(odd.r, abs=2e-5)


@pytest.mark.slow
def test_mirrored_scene():
    """Its extrapolation lengths are swapped, within the errors; D is that of the quadrature."""
    for side, other in (("lower", "upper"), ("upper", "lower")):
        kappa = ns.extrapolation_length(SKEWED, side=side)
        swapped = ns.extrapolation_length(MIRRORED, side=other)
        assert abs(kappa.value - swapped.value) <= kappa.error + swapped.error + 1e-12
    found, errors = layer_constants(SKEWED)
    gamma2 = ns.asymptotic_variance(SKEWED).value
    assert abs(2 * found.diffusion - gamma2) <= 2 * errors.diffusion + 1e-10


@pytest.mark.slow
def test_odd_g_on_the_whole_grid(monkeypatch):
    """Kappa is that of the half grid on both sides."""
    monkeypatch.setattr(ns.Scene, "is_odd", lambda scene: False)
    for side in ("lower", "upper"):
        found = ns.extrapolation_length(FRICTION, side=side)
        assert abs(found.value - KAPPA) < 2e-9


def test_needs_a_centred_g():
    """A g with E g != 0 has no kappa; the message has the mean to subtract."""
    with pytest.raises(ns.NonsmoothError, match="subtract"):
        ns.extrapolation_length(ns.Scene("friction", observable="y + abs(y)/2"))
