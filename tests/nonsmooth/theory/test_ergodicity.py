"""Rates of decay and bounds of Poisson solutions against closed forms and independent methods."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.integrate import cumulative_trapezoid
from scipy.linalg import eigh_tridiagonal
from scipy.optimize import minimize

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.line import quadrature
from nonsmooth.scenes.relaxation import rate_at_infinity
from nonsmooth.scenes.symbols import x, y
from nonsmooth.theory import ergodicity, lyapunov
from nonsmooth.theory.ergodicity import decay_rate, poisson_bound
from references import FRICTION


def linear(damping, stiffness):
    """Make a linear scene, an obstacle too soft to be felt, and find its slowest eigenvalue."""
    potential = f"{stiffness}*x**2/2"
    scene = ns.Scene("obstacle", n=1e-14, damping=damping, potential=potential, observable="x")
    return scene, -np.linalg.eigvals([[-damping, -stiffness], [1.0, 0.0]]).real.max()


@pytest.mark.parametrize(("damping", "stiffness"), [(3.0, 1.0), (2.02, 1.0), (1.0, 2.0)])
def test_decay_of_a_linear_scene(damping, stiffness):
    """The slowest eigenvalue of the drift, which is real, nearly double, or one of a pair."""
    scene, exact = linear(damping, stiffness)
    found = decay_rate(scene)
    assert abs(found.value - exact) <= found.error
    assert found.error < 0.03 * exact
    # V is quadratic and forgets twice as fast
    far = rate_at_infinity(scene)
    assert abs(far.value - 2 * exact) <= far.error < 1e-6


def schroedinger(damping, n):
    """Slowest rate of friction with white noise: -psi''/2 + (b^2 - b')/2 psi, psi(0) = 0.

    Finite differences with 1/n in the middle between two nodes, at two widths, extrapolated.
    """
    rates = []
    for cells in (150, 300):
        width = 1 / (n * (cells + 0.5)) if n > 1 else 0.01 * 150 / cells
        z = width * np.arange(1, round(9 / (np.sqrt(damping) * width)))
        b = damping * z + np.minimum(n * z, 1)
        slope = damping + n * (n * z < 1)
        diagonal = 1 / width**2 + (b**2 - slope) / 2
        off = np.full(len(z) - 1, -0.5 / width**2)
        rates.append(eigh_tridiagonal(diagonal, off, select="i", select_range=(0, 0))[0][0])
    return rates[1] + (rates[1] - rates[0]) / 3


@pytest.mark.parametrize(("damping", "n"), [(1.0, 1e-3), (0.5, 3.0), (1.0, 10.0)])
def test_decay_under_friction(damping, n):
    """Time stepping, spectral elements and finite differences agree; C_b + n where n is small."""
    scene = ns.Scene("friction", n=n, damping=damping)
    found, gap, third = decay_rate(scene), ns.spectral_gap(scene), schroedinger(damping, n)
    assert abs(found.value - gap.value) <= found.error < 0.02 * gap.value
    # width^4 of the extrapolation and the offset of the kink: 1e-5 at the widest
    assert third == pytest.approx(gap.value, rel=1e-4)
    if n < 0.01:
        assert gap.value == pytest.approx(damping + n, rel=1e-6)


def test_far_out_friction_is_not_felt():
    """E V(Y_t) / V(y) = exp(-2 C_b t) from afar, which is slower than the gap at C_b = 1."""
    scene = ns.Scene("friction", n=100, start={"y": 1e6})
    draw, step, place = np.random.default_rng(1), 0.005, np.full(100, 1e6)
    for _ in range(1000):  # exact but for friction, a shift by less than the step
        noise = np.sqrt(-np.expm1(-2 * step) / 2) * draw.normal(size=100)
        place = place * np.exp(-step) + noise - step * np.clip(100 * place, -1, 1)
    forgotten = np.mean((place / 1e6) ** 2)
    # friction and noise change y by less than 2, which is 2 e^5 / 1e6 of it
    assert forgotten == pytest.approx(np.exp(-10), rel=4 * np.e**5 / 1e6)
    assert rate_at_infinity(scene).value == pytest.approx(2.0, abs=1e-6)
    assert ns.spectral_gap(scene).value > 2.5  # which a start from afar does not change


@pytest.mark.parametrize(("damping", "n"), [(1.0, 3.0), (1.0, 100.0), (0.2, 30.0), (4.0, 30.0)])
def test_poisson_bound_under_friction(damping, n):
    """The bound is that by quadrature of u' = 2/m int_y^inf z m dz, itself good to some 1e-9."""
    scene = ns.Scene("friction", n=n, damping=damping)
    z = np.append(0.0, np.geomspace(1e-5, 12 / np.sqrt(damping), 40_001))
    nodes, weights = leggauss(5)
    half = np.diff(z)[:, None] / 2
    points = z[:-1, None] + half * (nodes + 1)
    pieces = (half * points * quadrature.density(scene, points)[0]) @ weights
    slope = 2 * np.cumsum(pieces[::-1])[::-1] / quadrature.density(scene, z[:-1])[0]
    z = z[:-1]
    u = cumulative_trapezoid(slope, z, initial=0)
    exact = np.max(u / (lyapunov.evaluate(scene, {y: z}, "value")[0] + 1))
    found = poisson_bound(scene)
    assert abs(found.constant - exact) <= found.error < 0.01 * exact
    assert found.edge < exact - found.error


@pytest.mark.parametrize(("damping", "stiffness"), [(3.0, 1.0), (0.7, 1.5)])
def test_poisson_bound_of_a_linear_scene(damping, stiffness):
    """The solution of -A u = x is u = (y + C_b x) / k."""
    scene, _ = linear(damping, stiffness)

    def negative(z):
        V, _ = lyapunov.evaluate(scene, {y: z[:1], x: z[1:]}, "value")
        return -abs(z[0] + damping * z[1]) / stiffness / (V[0] + 1)

    options = {"xatol": 1e-9, "fatol": 1e-15}
    starts = np.random.default_rng(1).normal(size=(6, 2))
    exact = max(-minimize(negative, z, method="Nelder-Mead", options=options).fun for z in starts)
    found = poisson_bound(scene)
    assert abs(found.constant - exact) <= found.error < 1e-6 * exact


def test_what_has_no_rate_is_refused():
    """More variables, the non-smooth limit, an oscillation slower than its decay, a long step."""
    for scene in (
        ns.Scene("elasto_plastic", "langevin", potential="x**2/2"),
        ns.Scene("friction", n=np.inf),
    ):
        for measure in (decay_rate, poisson_bound):
            with pytest.raises(SceneError, match="choose another scene"):
                measure(scene)
    with pytest.raises(ToleranceError, match="nearly coincide"):
        decay_rate(linear(2.0, 1.05)[0])
    with pytest.raises(ToleranceError, match="take a longer step"):
        decay_rate(FRICTION, 1e-4)


def test_the_narrow_valley_of_stiff_walls():
    """V is large but for |z| < 1e-4; the ratio is that of a grid of two levels more."""
    scene = ns.Scene("obstacle", n=1000, potential="x**2/2", observable="x")
    found = poisson_bound(scene)
    finer, _ = ergodicity.largest_ratio(scene, 4, 1.0)
    assert abs(found.constant - finer) <= found.error < 1e-3 * finer
