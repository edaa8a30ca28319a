"""v(0, tau): within its error or refused, also of extreme scenes and at extreme times."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import AssumptionWarning, SceneError, ToleranceError
from nonsmooth.line import eigenfunctions
from references import FRICTION


def test_sampled_variance_meets_its_tolerance():
    """The variance is within tol of that of the eigenfunctions; a false alarm in 100 runs."""
    times = np.array([1.0, 10.0])
    exact = ns.variance(FRICTION, times)["v"]
    found = ns.variance(FRICTION, times, 3e-3, "monte_carlo")
    assert np.all(np.abs(found["v"] - exact) <= 3e-3 * times)
    assert np.all(found["v_error"] <= 3e-3 * times)
    with pytest.raises(ToleranceError, match=r"v\(tau\)/tau = .* use tol >="):
        ns.variance(FRICTION, times, 1e-9, "monte_carlo")


@pytest.mark.parametrize("g", ["y", "y + 0.4*abs(y)", "tanh(2*y)"])
def test_a_loose_tolerance_takes_coarser_elements(monkeypatch, g):
    """Asking for less takes no higher degree, and the error holds."""
    degrees = []
    solve = eigenfunctions.moments_with_rounding

    def counted(scene, times, degree):
        degrees.append(degree)
        return solve(scene, times, degree)

    monkeypatch.setattr(eigenfunctions, "moments_with_rounding", counted)
    scene, times = ns.Scene("friction", n=100, observable=g), np.geomspace(0.1, 100, 9)
    exact = ns.variance(scene, times, 1e-8)
    largest = [degrees[-1]]
    for tol in (1e-4, 1e-2):
        found = ns.variance(scene, times, tol)
        largest.append(degrees[-1])
        assert np.all(np.abs(found["v"] - exact["v"]) <= found["v_error"] + exact["v_error"])
        assert np.all(found["v_error"] <= tol * times)
    assert largest[0] > largest[1] >= largest[2]


def test_rare_yielding_is_not_taken_for_rest():
    """The variance is right though few of the first paths yield; false alarms 1e-3."""
    ground = ns.KanaiTajimi(2.0, 0.8)
    scene = ns.Scene("elasto_plastic", ground, 287.9, 0.9043, "x**2", "plastic_strain_rate")
    found = ns.variance(scene, [0.535, 1.07, 2.14, 4.28], 1.6e-6).isel(time=-1)
    sample = ns.simulate(scene, 4.28, step=0.05, paths=200_000, times=[4.28], seed=5).isel(time=0)
    allowed = 3.3 * np.hypot(sample["variance_error"], found["v_error"])
    allowed += np.abs(sample["variance_bias"]) + sample["variance_bias_error"]
    assert np.abs(found["v"] - sample["variance"]) < allowed


def test_early_times_where_all_modes_cancel():
    """Within the layer |y| < 1/n the velocity is an Ornstein-Uhlenbeck process of rate n + C_b.

    By the last time it has left the layer, nine standard deviations away, with probability 1e-20.
    """
    times = np.array([1e-9, 1e-8, 1e-7, 1e-6, 1e-5 / 9])
    found = ns.variance(ns.Scene("friction", n=100), times)
    z = 101 * times
    # E Delta^2 = int int Cov = tau^3/3 (1 - 3 z/4 + ...), to 1e-9 relative for z < 1.2e-4
    exact = times**3 / 3 * (1 - 3 / 4 * z + 7 / 20 * z**2)
    assert np.all(np.abs(found["v"] - exact) <= found["v_error"] + 1e-9 * exact)


@pytest.mark.parametrize(
    ("damping", "sigma"), [(1.0, 1.0), (1e-3, 1.0), (1e3, 1.0), (1.0, 1e-3), (1.0, 1e3)]
)
def test_early_and_late_times_of_extreme_scenes(damping, sigma):
    """With its kink far away friction is an Ornstein-Uhlenbeck process, of which v is known."""
    scene = ns.Scene("friction", ns.White(sigma), n=1e-6, damping=damping)
    z = np.array([1e-12, 1e-9, 1e-6, 1e-4, 0.1, 1.0, 100.0])
    rate = damping + 1e-6
    found = ns.variance(scene, z / rate, tol=1e-8 * (sigma / rate) ** 2)
    exact = z - 2 * -np.expm1(-z) + -np.expm1(-2 * z) / 2
    early = z < 1e-3  # where the terms above cancel; the rest of the series is below 1e-8 of it
    exact[early] = (z**3 / 3 - z**4 / 4 + 7 * z**5 / 60)[early]
    exact *= sigma**2 / rate**3
    assert np.all(np.abs(found["v"] - exact) <= found["v_error"] + 1e-11 * exact)
    assert np.all(found["v"] >= 0)


@pytest.mark.slow
@pytest.mark.parametrize(("n", "damping"), [(1.0, 1e-3), (np.inf, 1.0)])
def test_strong_noise_rounds_more(n, damping):
    """Elements next to the kink are short against the velocity; v grows by gamma^2 per time."""
    scene = ns.Scene("friction", ns.White(1e3), n=n, damping=damping)
    gamma2 = ns.asymptotic_variance(scene, 1e-9)
    time = 60 / ns.spectral_gap(scene).value
    found = ns.variance(scene, [time, 2 * time], tol=gamma2.value)
    slope = float(found["v"][1] - found["v"][0]) / time
    assert abs(slope - gamma2.value) <= float(found["v_error"].sum()) / time + gamma2.error


@pytest.mark.parametrize(
    "scene",
    [
        ns.Scene("friction", ns.White(0.3)),
        ns.Scene("elasto_plastic", ns.White(0.2), potential="x**2/2"),
        ns.Scene("friction", "hamiltonian", damping=3.0),
    ],
    ids=["one variable", "two variables", "Monte Carlo"],
)
def test_unless_a_tolerance_is_given_it_follows_the_size(scene):
    """Weak noise has small variances, of which an absolute error would leave nothing."""
    found = ns.variance(scene, [1.0, 10.0])
    rate, error = (found[name] / found["time"] for name in ("v", "v_error"))
    assert float(rate.max()) < 0.01
    assert float(error.max()) <= 0.05 * float(rate.max())


@pytest.mark.parametrize("method", [None, "monte_carlo"])
def test_an_infinite_variance_is_refused(method):
    """E exp(2 a y^2) is infinite from a = 1/2 on, where m decays like exp(-y^2)."""
    with (
        pytest.raises(SceneError, match="not square-integrable"),
        pytest.warns(AssumptionWarning),
    ):
        ns.variance(ns.Scene("friction", observable="exp(0.55*y**2)"), [1.0], method=method)


def test_a_variance_is_answered_as_long_as_it_is_finite():
    """For a < 1/4 there is an answer, though the paper's theorem does not cover the scene."""
    with pytest.warns(AssumptionWarning):
        scene = ns.Scene("friction", observable="exp(0.2*y**2)")
    late = ns.variance(scene, [400.0])
    gamma2 = ns.asymptotic_variance(scene).value
    assert late["v"].item() / 400 == pytest.approx(gamma2, rel=0.01)  # the rest is O(1/tau)
