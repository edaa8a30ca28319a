"""Moments of the integral of g from samples: their errors and the bias of the step."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.paths.ensembles import coupled, gram
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.moments import moments, step_bias
from nonsmooth.paths.sampling import Sampling
from references import FALSE_ALARM, FRICTION


@pytest.mark.parametrize("control", [False, True])
@pytest.mark.parametrize("n", [2, 100, 1e6, np.inf])
def test_monte_carlo_agrees_with_spectral_elements(n, control):
    """V within z standard errors plus the step's bias, jointly over the times."""
    scene, tau = ns.Scene("friction", n=n), np.array([0.1, 1.0, 5.0])
    sample = moments(gram(scene, tau, Sampling(0.02, 40_000, 2), control))
    exact = ns.variance(scene, tau, tol=1e-6)["v"].values
    z = stats.norm.isf(FALSE_ALARM / 2 / len(tau))
    # bias at h = 0.02, T = 10 known by exact quadrature: 1.6e-4 of v/T, its order 1.5 in h
    bias = 3e-4 * tau
    assert np.all(np.abs(sample["variance"] - exact) < z * sample["variance_error"] + bias)
    assert np.all(np.abs(sample["mean"]) < z * sample["mean_error"])


def test_bias_of_the_step_is_the_one_known_by_quadrature():
    """1.43e-3 at h = 0.1 and 1.65e-4 at h = 0.02 for T = 10, n = 100.

    By quadrature of the kernels' transition (test_schemes). The change by halving is
    (1 - 2^-1.5) of it; its order lies between those of kink and bulk.
    """
    z = stats.norm.isf(FALSE_ALARM / 2)
    for h, bias in ((0.1, 1.43e-3), (0.02, 1.65e-4)):
        change, _ = coupled(FRICTION, [10.0], Sampling(h, 200_000, 1))
        found, error = step_bias(change, 1.5)
        # the order varies between 1.3 and 1.7 locally: a fifth of 1 - 2^-1.5
        assert abs(found[0] / 10 - bias) < z * error[0] / 10 + 0.2 * bias


def test_bias_of_a_variance_is_not_that_of_the_mean_square():
    """Adding a constant to g changes neither the variance nor its bias."""
    biases = []
    for g in ("y", "y + 3"):
        scene = ns.Scene("friction", observable=g)
        change, _ = coupled(scene, [5.0], Sampling(0.1, 50_000, (1, "same")))
        biases.append(step_bias(change, 1.5))
    (first, error), (second, spread) = biases
    assert abs(first - second)[0] < stats.norm.isf(FALSE_ALARM / 2) * np.hypot(error, spread)[0]
    assert spread[0] < 2 * error[0]  # E[D] = 15 would make it tens of times larger


def test_precision_changes_less_than_the_errors():
    """Both precisions run on the same noise; the variance agrees to 1/200 of its error."""
    sampling = Sampling(0.05, 5_000, 2, precision="float64")
    found = moments(gram(FRICTION, [1.0, 10.0], sampling))
    other = moments(gram(FRICTION, [1.0, 10.0], replace(sampling, precision="float32")))
    difference = np.abs(found["variance"] - other["variance"])
    assert np.any(difference > 0)
    assert np.all(difference <= 5e-3 * other["variance_error"])


def test_a_spread_lost_in_the_mean_is_refused():
    """Sums of fourth powers hold sixteen digits."""
    sums = gram(ns.Scene("friction", observable="y + 1e6"), [10.0], Sampling(0.1, BLOCK, 1))
    with pytest.raises(SceneError, match="subtract the mean"):
        moments(sums)


@pytest.mark.parametrize("n", [100.0, np.inf])
def test_friction_force_balances_the_forcing(n):
    """gamma^2 of C_b y + force is 1 with white noise: E D^2 grows like t for C_b small."""
    scene = ns.Scene("friction", n=n, damping=0.01, observable="friction_force")
    estimate = ns.asymptotic_variance(scene, tol=1e-6)
    # int force = W - Y - C_b int y, and the spectrum of C_b y at 0 is C_b^2 gamma^2(y)
    assert abs(np.sqrt(estimate.value) - 1) < 2 * 0.01 * np.sqrt(
        ns.asymptotic_variance(ns.Scene("friction", n=n, damping=0.01), tol=1e-6).value
    )
    sample = moments(gram(scene, [20.0, 60.0], Sampling(0.05, 20_000, 3)))
    slope = np.diff(sample["variance"])[0] / 40
    allowed = stats.norm.isf(FALSE_ALARM / 2) * np.hypot(*sample["variance_error"]) / 40
    assert abs(slope - estimate.value) < allowed + 0.01


def test_bias_of_a_variance_beside_a_large_mean():
    """A step that shifts the mean, here by 10, has no bias in the variance."""
    half = 1000 + np.random.default_rng(1).standard_normal(500)
    vector = np.stack([np.ones(500), np.full(500, 10.0), (half + 10) ** 2 - half**2, half])
    bias, error = step_bias((vector @ vector.T)[None], 1.0)
    assert abs(bias[0]) < 1e-8  # rounding of squares of 1e6
    assert error[0] < 1e-3


def test_paths_that_start_alike_have_an_error_all_the_same():
    """The friction force is -1 until y = 0, on all paths; the variance may be that of a few."""
    scene = ns.Scene("friction", "hamiltonian", observable="friction_force", start={"y": -1.0})
    found = moments(gram(scene, [0.1, 2.0], Sampling(0.05, 1000, 1)))
    assert found["mean"][0] == pytest.approx(-0.1, rel=1e-5)  # in single precision
    assert found["variance"][0] < 1e-12
    # D is -0.1 there, and about -2 or less at the time from which its size is taken
    assert 0.1**2 < 1000 * found["variance_error"][0] < 2.0**2
    assert 0.1 < 1000 * found["mean_error"][0] < 2.0
