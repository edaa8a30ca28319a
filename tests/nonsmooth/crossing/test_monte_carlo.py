"""Crossing probabilities by Monte Carlo: published values, symmetry, tolerances."""

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from references import FALSE_ALARM, FRICTION, W

HORIZONS = np.linspace(0, 2, 11)[1:]


@pytest.mark.parametrize(
    ("p", "value", "paths"),
    [(1, W[1], 50_000), (10, W[10], 20_000), (100, W[100], 5_000)],
)
def test_published_values_at_T_2(p, value, paths):
    """W(sqrt(p) 0.6, 2 p) known from a Laplace-transform computation, n = 100."""
    run = ns.crossing_probability(FRICTION, 0.6, HORIZONS, p=p, paths=paths, seed=3, step=0.02)
    estimate, error = run["probability"][-1], run["standard_error"][-1]
    # bias of h = 0.02: 1.2e-3 of gamma^2 times dW/dlog T < 0.45
    allowed = stats.norm.isf(FALSE_ALARM / 2) * error + 6e-4
    assert abs(float(estimate) - value) < allowed


def test_mirrored_levels_of_an_odd_scene():
    """Dry friction has no side: both one-sided probabilities are the same, within their errors."""
    runs = [
        ns.crossing_probability(FRICTION, levels, HORIZONS, p=10, method="monte_carlo", seed=seed)
        for seed, levels in enumerate([(-np.inf, 0.4), (-0.4, np.inf)])
    ]
    # tol = 1e-2: three standard errors are three quarters of it, at most those of W = 1/2
    assert all(run.attrs["paths"] <= 40_000 for run in runs)
    assert all(np.all(3 * run["standard_error"] <= 0.75e-2) for run in runs)
    difference = runs[0]["probability"] - runs[1]["probability"]
    error = np.hypot(*(run["standard_error"] for run in runs))
    assert np.max(np.abs(difference / error)) < stats.norm.isf(FALSE_ALARM / 2 / len(HORIZONS))


def test_distance_to_the_limit_falls_with_p():
    """The distance falls like p^-1/2: 0.34, 0.14, 0.045 at T = 2 and p = 1, 10, 100."""
    limit = ns.crossing_probability(FRICTION, 0.6, [2.0], method="asymptotic")["probability"][0]
    for p, distance in ((1, 0.344), (10, 0.137), (100, 0.0450)):
        run = ns.crossing_probability(FRICTION, 0.6, HORIZONS, p=p, paths=5_000, seed=4, step=0.02)
        error = stats.norm.isf(FALSE_ALARM / 2) * run["standard_error"][-1]
        assert abs(float(limit - run["probability"][-1]) - distance) < error + 1e-3


def test_tolerance_is_met():
    """|error| <= tol at every horizon; a false alarm in 100 runs."""
    exact = ns.crossing_probability(
        FRICTION, 0.6, HORIZONS, p=10, method="deterministic"
    ).probability
    for tol in (3e-2, 1e-2, 3e-3):
        run = ns.crossing_probability(FRICTION, 0.6, HORIZONS, p=10, method="monte_carlo", tol=tol)
        assert np.max(np.abs(run["probability"] - exact)) < tol


def test_tolerance_out_of_reach_is_refused_with_the_best_value():
    """1e13 paths would take for ever; the message says what can be had."""
    scene = ns.Scene("friction", "langevin")
    with pytest.raises(ToleranceError, match=r"W = .* use tol >="):
        ns.crossing_probability(scene, 0.6, HORIZONS, tol=1e-7, method="monte_carlo")


@pytest.mark.parametrize("threshold", [0.1, 0.01, 1e-3])
def test_single_thresholds_next_to_the_start(threshold):
    """Paths that have left a near threshold by the end of a step may never come back.

    W is known from the deterministic method, which takes a minute for the nearest.
    """
    levels = (-threshold, np.inf)
    run = ns.crossing_probability(FRICTION, levels, [1.0], method="monte_carlo", seed=4)
    exact = {0.1: 0.35825, 0.01: 0.69435, 1e-3: 0.81842}[threshold]
    stated = stats.norm.isf(FALSE_ALARM / 2) * run["standard_error"] + np.abs(run["step_bias"])
    assert abs(float(run["probability"][0]) - exact) < float(stated[0])


@pytest.mark.parametrize("others", [[], [(-1.0, np.inf)]])
def test_a_step_that_passes_a_threshold_has_a_large_error(others):
    """S falls like the root b^(1/6) from 0.076 at b = 1e-5, to 5e-3; a long step has 0.2.

    A farther threshold in its company has the usual error.
    """
    levels = [(-1e-12, np.inf), *others]
    run = ns.crossing_probability(
        FRICTION, levels, [1.0], method="monte_carlo", step=0.05, paths=20_000, seed=4
    )
    near, *far = run["probability_error"].values.reshape(-1)
    assert run["probability"].values.flat[0] < 0.9
    assert 0.2 < near < 0.5
    assert all(error < 0.02 for error in far)


def test_early_horizons_have_steps_of_their_own():
    """A sixteenth of the first horizon passes no threshold, although the step that is asked may."""
    run = ns.crossing_probability(
        FRICTION, 0.012, [0.1], method="monte_carlo", step=0.1, paths=20_000, seed=4
    )
    assert float(run["probability_error"][0]) < 0.006


def test_what_hardly_happens_takes_few_paths():
    """Where W is far below tol, some counts by 1/tol show it; a false alarm in 300 runs."""
    exact = ns.crossing_probability(
        FRICTION, 3.0, HORIZONS, p=10, method="deterministic"
    ).probability
    assert exact[-1] < 1e-5
    for tol, most in ((1e-3, 13_000), (1e-2, 1_200)):
        run = ns.crossing_probability(FRICTION, 3.0, HORIZONS, p=10, method="monte_carlo", tol=tol)
        assert np.max(np.abs(run["probability"] - exact)) < tol
        assert run.attrs["paths"] <= most


def test_envelope():
    """S = 1/2 is half the intensity of the noise, whose probability is solved.

    All errors of the sample, biases in them, and five of them: a false alarm in a million.
    """
    exact = ns.crossing_probability(
        ns.Scene("friction", ns.White(0.5)), [0.1, 0.2], [4.0], method="deterministic", tol=1e-4
    )
    run = ns.crossing_probability(FRICTION, [0.1, 0.2], [4.0], envelope="0.5", seed=2)
    assert run.attrs["method"] == "monte_carlo"
    gap = np.abs(run["probability"] - exact["probability"])
    assert np.all(gap <= 5 * run["probability_error"] + exact["probability_error"])


def test_envelope_that_ends():
    """Where the noise has stopped dry friction comes to rest, and hardly any path crosses."""
    run = ns.crossing_probability(
        FRICTION, 0.5, [2.0, 6.0, 12.0], envelope="max(0, 1 - t/6)", seed=2
    )
    W = run["probability"].values
    assert W[0] < W[1]
    assert W[2] - W[1] < 1e-2
