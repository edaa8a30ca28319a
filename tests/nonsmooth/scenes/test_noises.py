"""The noises have their known laws."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import sympy
from scipy import integrate, linalg, stats

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.grids import potential_wells
from nonsmooth.paths.schemes import strang
from nonsmooth.scenes.noises import Noise
from nonsmooth.scenes.symbols import eta, zeta

FALSE_ALARM = 1e-4


def samples(noise, horizon, step, paths, seed):
    """Return final values of the noise's variables from the origin."""
    scene = ns.Scene("obstacle", noise, observable="eta")
    run = ns.simulate(
        scene, horizon, step=step, paths=paths, seed=seed, times=[horizon], keep="paths"
    )
    return {name: run[name].values[:, -1] for name in scene.state}


def gaussian_step(noise, step):
    """Transition matrix and covariance of one step of a linear noise."""
    scene = ns.Scene("obstacle", noise, observable="eta")
    coefficients = strang.coefficients(scene, step, "float64")
    size = len(noise.drift)
    transition = np.reshape(coefficients.transition, (2, 2)) + np.diag([1.0, size - 1.0])
    a, b, c = coefficients.factor
    factor = np.array([[a, 0], [b, c]])
    return transition, factor @ factor.T


def test_ornstein_uhlenbeck_step_is_exact():
    """Transition exp(-theta h), variance sigma^2 (1 - exp(-2 theta h)) / (2 theta)."""
    theta, sigma, h = 1.7, 0.6, 0.3
    transition, covariance = gaussian_step(ns.OrnsteinUhlenbeck(theta, sigma), h)
    assert transition[0, 0] == pytest.approx(np.exp(-theta * h), rel=1e-13)
    exact = sigma**2 * -np.expm1(-2 * theta * h) / (2 * theta)
    assert covariance[0, 0] == pytest.approx(exact, rel=1e-13)


@pytest.mark.parametrize("h", [1e-3, 0.1, 2.0])
def test_kanai_tajimi_step_keeps_its_stationary_law(h):
    """The stationary covariance solves the Lyapunov equation; one step maps it to itself."""
    k, damping, sigma = 2.5, 0.4, 1.3
    transition, covariance = gaussian_step(ns.KanaiTajimi(k, damping, sigma), h)
    matrix = np.array([[-damping, -k], [1.0, 0.0]])  # (zeta, eta)
    stationary = linalg.solve_continuous_lyapunov(matrix, -np.diag([sigma**2, 0.0]))
    assert stationary[1, 1] == pytest.approx(sigma**2 / (2 * damping * k))
    after = transition @ stationary @ transition.T + covariance
    assert np.allclose(after, stationary, rtol=1e-11, atol=1e-13)


def test_kanai_tajimi_spectrum():
    """The autocovariance of eta integrates to the spectrum sigma^2 / |k - w^2 + i damping w|^2.

    This is the mended formula: eta has numerator 1, and the damping enters as its square.
    """
    k, damping, sigma = 2.5, 0.8, 1.3
    h, count = 0.01, 4000
    transition, _ = gaussian_step(ns.KanaiTajimi(k, damping, sigma), h)
    matrix = np.array([[-damping, -k], [1.0, 0.0]])
    stationary = linalg.solve_continuous_lyapunov(matrix, -np.diag([sigma**2, 0.0]))
    covariance, autocovariance = stationary.copy(), []
    for _ in range(count + 1):
        autocovariance.append(covariance[1, 1])
        covariance = transition @ covariance
    lag = h * np.arange(count + 1)
    for w in (0.0, 0.7, np.sqrt(k), 3.0):
        spectrum = 2 * integrate.simpson(np.array(autocovariance) * np.cos(w * lag), x=lag)
        exact = sigma**2 / ((k - w**2) ** 2 + damping**2 * w**2)
        # Simpson: h^4 (w^2 + k)^2 / 180 times the integral; the tail is exp(-damping 40 / 2)
        assert spectrum == pytest.approx(exact, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize(
    ("noise", "density"),
    [
        (ns.OrnsteinUhlenbeck(1.5, 0.8), lambda e: np.exp(-1.5 * e**2 / 0.8**2)),
        (
            ns.Langevin("eta**4/4 + eta**2/2"),
            lambda e: np.exp(-2 * (e**4 / 4 + e**2 / 2)),
        ),
        (
            ns.Hamiltonian("zeta**2/2 + eta**4/4 + eta**2/2", "1"),
            lambda e: np.exp(-2 * (e**4 / 4 + e**2 / 2)),
        ),
    ],
    ids=["quadratic v", "quartic v", "quartic H"],
)
def test_stationary_law_of_eta(noise, density):
    """Kolmogorov-Smirnov against exp(-2 v / sigma^2), the Gibbs density, after relaxation."""
    eta = samples(noise, horizon=12.0, step=0.05, paths=20_000, seed=4)["eta"]
    grid = np.linspace(-6, 6, 4001)
    cumulative = integrate.cumulative_simpson(density(grid), x=grid, initial=0)
    law = stats.kstest(eta, lambda e: np.interp(e, grid, cumulative / cumulative[-1]))
    # relaxation leaves exp(-12/2); the step's bias is of order h^2 = 2.5e-3 of the variance, a
    # quarter of the distance that 20000 samples resolve at this rate
    assert law.pvalue > FALSE_ALARM


def test_kanai_tajimi_velocity_is_gaussian():
    """Zeta has variance sigma^2 / (2 damping), independent of the stiffness."""
    zeta = samples(ns.KanaiTajimi(3.0, 1.0, 0.9), 20.0, 0.1, 20_000, 3)["zeta"]
    law = stats.kstest(zeta, stats.norm(scale=0.9 / np.sqrt(2)).cdf)
    assert law.pvalue > FALSE_ALARM


@dataclass(frozen=True)
class Filtered:
    """Ornstein-Uhlenbeck noise that is filtered once more: a kind that the library lacks."""

    sigma: float = 1.0
    kind: ClassVar[str] = "filtered"
    title: ClassVar[str] = "filtered noise"
    driven: ClassVar[sympy.Symbol] = zeta
    forcing: ClassVar[sympy.Expr] = eta

    @property
    def drift(self):
        """Both relax with the rate 1."""
        return {zeta: -zeta, eta: zeta - eta}


def test_a_noise_of_another_kind_is_simulated():
    """It is simulated by the Euler-Maruyama scheme, with the stationary covariance.

    Grids refuse it.
    """
    scene = ns.Scene("friction", Filtered(), observable="eta")
    assert isinstance(scene.noise, Noise)
    assert scene.state == ("zeta", "eta")
    found = samples(Filtered(), 15.0, 0.01, 20_000, 5)
    matrix = np.array([[-1.0, 0.0], [1.0, -1.0]])
    exact = linalg.solve_continuous_lyapunov(matrix, -np.diag([1.0, 0.0]))
    covariance = np.cov(found["zeta"], found["eta"])
    # five standard errors and the bias of the step, of order 1
    assert np.allclose(covariance, exact, atol=5 / np.sqrt(20_000) + 0.01)
    with pytest.raises(SceneError, match="monte_carlo"):
        ns.asymptotic_variance(ns.Scene("friction", Filtered()), method="deterministic")
    with pytest.raises(SceneError, match="sigma is nan"):
        ns.Scene("friction", Filtered(float("nan")))


@pytest.mark.slow
def test_functions_of_a_noise_of_another_kind():
    """The filters leave the white noise's intensity, 1, to slow motions; E eta^2 is 1/4.

    Errors hold 4.5 fold; false alarms 7e-6 each.
    """
    scene = ns.Scene("friction", Filtered(), observable="eta")
    for found, exact in (
        (ns.asymptotic_variance(scene), 1.0),
        (ns.mean(scene.with_observable("eta**2")), 0.25),
    ):
        assert abs(found.value - exact) <= 4.5 * found.error


@pytest.mark.slow
def test_paths_answer_for_a_noise_of_another_kind():
    """Solvers know another noise of the same law, eta'' + 2 eta' + eta = dW/dt.

    Errors hold 4.5 fold; false alarms 7e-6 each.
    """
    same = ns.KanaiTajimi(stiffness=1.0, damping=2.0)
    scene, solved = (ns.Scene("friction", noise, n=10) for noise in (Filtered(), same))
    for found, exact in (
        (ns.asymptotic_variance(scene, 0.1), ns.asymptotic_variance(solved, 1e-3)),
        (
            ns.mean(scene.with_observable("y**2"), 1e-3),
            ns.mean(solved.with_observable("y**2"), 1e-4),
        ),
    ):
        assert found.method == "Monte Carlo"
        assert exact.method != "Monte Carlo"
        assert abs(found.value - exact.value) <= 4.5 * found.error + exact.error
    moments = ns.variance(ns.Scene("friction", Filtered(), n=100), [1.0], 0.1)
    assert moments.attrs["method"] == "monte_carlo"
    held = ns.Scene("obstacle", Filtered(), n=10, potential="x**2/2", observable="x")
    length = ns.extrapolation_length(held)
    assert 0 < length.error < length.value
    with pytest.raises(SceneError, match="give points"):
        ns.invariant_density(held)


def test_wells_under_a_noise_of_another_kind():
    """All wells of U hold paths for long under a noise whose temperature is not known."""
    double = ns.Scene("obstacle", Filtered(), potential="5*(x**2 - 0.25)**2", observable="x")
    found = potential_wells.starts(double)
    assert [point["x"] for point in found] == pytest.approx([-0.5, 0.5], abs=0.01)
    assert potential_wells.starts(ns.Scene("friction", Filtered())) == [{}]


def test_noises_of_a_name_are_made_once():
    """Making one takes ten times as long as all else that a scene does."""
    one, other = (ns.Scene(model, "kanai_tajimi") for model in ("friction", "elasto_plastic"))
    assert one.noise is other.noise
