"""Spectral elements: exact cases, exponential convergence, published eigenvalues."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.line import eigenfunctions
from references import FRICTION, LAMBDA_LIMIT

TAU = np.array([0.02, 0.3, 1.0, 10.0, 100.0])


def ornstein_uhlenbeck_variance(rate, tau):
    """Variance of the integral of dY = -rate Y dt + dW from a fixed start."""
    decay = -np.expm1(-rate * tau) / rate
    decay2 = -np.expm1(-2 * rate * tau) / (2 * rate)
    return (tau - 2 * decay + decay2) / rate**2


@pytest.mark.parametrize("rate", [0.05, 1.0, 20.0])
@pytest.mark.parametrize("start", [0.0, 0.8])
def test_exact_for_ornstein_uhlenbeck(rate, start):
    """Without a kink the state is an Ornstein-Uhlenbeck process: mean and variance are known."""
    scene = ns.Scene("elasto_plastic", damping=rate, start={"y": start})
    assert scene.state == ("y",)
    solution = ns.variance(scene, TAU, tol=1e-6)
    # cancellation of tau - 2 decay + decay2 in the formula: (eps tau) / rate^2
    exact = ornstein_uhlenbeck_variance(rate, TAU)
    noise = 4e-16 * TAU / rate**2
    assert np.all(np.abs(solution["v"] - exact) <= solution["v_error"] + noise)
    mean = start * -np.expm1(-rate * TAU) / rate
    assert np.all(np.abs(solution["w"] - mean) <= solution["w_error"] + 1e-12 * abs(mean))
    assert ns.asymptotic_variance(scene).value == pytest.approx(1 / rate**2, rel=1e-9)


def test_eigenvalues_of_dry_friction():
    """At n = inf the first eigenvalue is the published one, and the second is 1 larger."""
    rates = eigenfunctions.spectrum(ns.Scene("friction", n=np.inf), 12).rates
    assert rates[0] == 0
    assert rates[1] == pytest.approx(LAMBDA_LIMIT, abs=1e-5)
    assert rates[2] == pytest.approx(rates[1] + 1, abs=1e-9)


PUBLISHED = {
    2: 0.17446659,
    5: 0.14327210,
    10: 0.13843447,
    50: 0.13683517,
    100: 0.13678404,
    1000: 0.13676709,
}


@pytest.mark.parametrize("n", PUBLISHED)
def test_published_growth(n):
    """v(0, 100)/100 to the eight digits known from an independent computation."""
    v = ns.variance(ns.Scene("friction", n=n), [100.0], tol=4e-11)["v"][0] / 100
    assert float(v) == pytest.approx(PUBLISHED[n], abs=5.1e-9)


@pytest.mark.parametrize("n", [1, 30, 1e3, np.inf])
def test_convergence_is_exponential_in_the_degree(n):
    """Each two degrees gain at least a factor 5 until rounding, reached by degree 12."""
    scene = ns.Scene("friction", n=n)
    exact = eigenfunctions.moments(scene, TAU, 20)[1] / TAU
    error = [
        np.max(np.abs(eigenfunctions.moments(scene, TAU, degree)[1] / TAU - exact))
        for degree in (2, 4, 6, 12)
    ]
    rounding = 4 * eigenfunctions.rounding(scene, 20)
    assert error[1] < error[0] / 5 + rounding
    assert error[2] < error[1] / 5 + rounding
    assert error[3] < rounding


@pytest.mark.parametrize("n", [0.01, 0.1, 0.7, 2, 100, 1e4, np.inf])
@pytest.mark.parametrize("damping", [0.2, 1.0, 5.0])
def test_poisson_solution_against_closed_form(n, damping):
    """gamma^2 from the eigenpairs equals the closed form."""
    scene = ns.Scene("friction", n=n, damping=damping)
    closed = ns.asymptotic_variance(scene)
    assert closed.method == "closed form"
    # converged at this degree, so that rounding is all that is left
    assert eigenfunctions.asymptotic_variance(scene, 14) == pytest.approx(
        closed.value, rel=eigenfunctions.rounding(scene, 14), abs=closed.error
    )


def test_forcing_balance():
    """gamma^2 of the whole restoring force C_b y + a_n'(y) is the forcing's spectrum at 0: 1."""
    n = 8
    force = f"y + max(-1, min(1, {n}*y))"
    scene = ns.Scene("friction", n=n, observable=force)
    estimate = ns.asymptotic_variance(scene, tol=1e-8)
    assert abs(estimate.value - 1) <= estimate.error + 1e-11


def test_limit_of_v_is_linear_exponentially_fast():
    """v(0, tau) - gamma^2 tau tends to a constant like exp(-lambda_1 tau), not v/tau."""
    scene = ns.Scene("friction", n=100)
    gamma2 = ns.asymptotic_variance(scene).value
    rate = eigenfunctions.spectrum(scene, 12).rates[1]
    tau = np.array([2.0, 3.0, 4.0, 40.0])
    remainder = ns.variance(scene, tau)["v"].values - gamma2 * tau
    gaps = np.abs(remainder[:3] - remainder[3])
    # the leading mode is tau exp(-lambda_1 tau) or exp(-lambda_1 tau): the ratio per unit time
    # lies between exp(-lambda_1) and 1.5 times that
    ratio = gaps[1:] / gaps[:-1]
    assert np.all(ratio < 1.6 * np.exp(-rate))
    assert remainder[3] / 100 == pytest.approx(-9.124e-4, abs=1e-6)


def test_unreachable_tolerance_is_refused_with_the_best_value():
    """The message has the error that was reached."""
    with pytest.raises(ToleranceError, match="loosen tol"):
        ns.variance(FRICTION, [1.0], tol=1e-18)


def test_other_states_are_refused():
    """More than two variables have no solver, and the message says what to do."""
    with pytest.raises(SceneError, match="method='monte_carlo'"):
        ns.variance(ns.Scene("obstacle", "langevin"), [1.0], method="deterministic")
