"""Threshold crossing: published values, exact intervals, the limit, the step's bias."""

import numpy as np
import pytest
from scipy import special, stats

import nonsmooth as ns
from nonsmooth.crossing.counting import first_passage_counts, first_passage_shift, proportion
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.paths.ensembles import coupled
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.moments import step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.thresholds import bounds

SCENE = ns.Scene("friction", n=100)
HORIZONS = np.linspace(0, 2, 11)[1:]
FALSE_ALARM = 1e-5


@pytest.mark.parametrize(
    ("p", "value", "paths"),
    [(1, 0.1606775, 50_000), (10, 0.3674251, 20_000), (100, 0.4595991, 5_000)],
)
def test_published_values_at_T_2(p, value, paths):
    """W(sqrt(p) 0.6, 2 p) known from a Laplace-transform computation, n = 100."""
    run = ns.crossing_probability(SCENE, 0.6, HORIZONS, p=p, paths=paths, seed=3, step=0.02)
    estimate, error = run["probability"][-1], run["probability_error"][-1]
    # bias of h = 0.02: 1.2e-3 of the growth rate times dW/dlog T < 0.45
    allowed = stats.norm.isf(FALSE_ALARM / 2) * error + 6e-4
    assert abs(float(estimate) - value) < allowed


def test_number_of_threads_and_shards_changes_no_count():
    """One run of two blocks is the sum of two runs of one block."""
    arguments = (SCENE, 0.6, HORIZONS, 1.0)
    whole = first_passage_counts(*arguments, Sampling(0.05, 2 * BLOCK, 5, threads=2))
    parts = [
        first_passage_counts(*arguments, Sampling(0.05, BLOCK, 5, first, threads=1))
        for first in (0, BLOCK)
    ]
    assert np.array_equal(whole, sum(parts))


def test_thresholds_out_of_reach_and_within_every_reach():
    """No path integrates to 50 in two units of time; every path to a tiny threshold."""
    none = first_passage_counts(SCENE, 50.0, HORIZONS, 1.0, Sampling(0.05, 500, 1))
    every = first_passage_counts(SCENE, 1e-9, HORIZONS, 1.0, Sampling(0.05, 500, 1))
    assert none.sum() == 0
    assert every.sum() == every[0] == 500


def crossed(threshold, scene=SCENE, p=10.0, paths=5_000):
    """Numbers of paths that have crossed by the horizons, of the same paths for all thresholds."""
    return np.cumsum(first_passage_counts(scene, threshold, HORIZONS, p, Sampling(0.05, paths, 8)))


def test_levels_of_both_sides():
    """A number is a pair of opposite levels; every path that leaves leaves by one of them."""
    assert np.array_equal(crossed((-0.6, 0.6)), crossed(0.6))
    for lower, upper in ((-0.6, 0.6), (-0.9, 0.4)):
        both, below, above = (
            crossed(levels) for levels in ((lower, upper), (lower, np.inf), (-np.inf, upper))
        )
        assert np.all(np.maximum(below, above) <= both)
        assert np.all(both <= below + above)
        assert both[-1] < below[-1] + above[-1]  # some paths reach both levels


@pytest.mark.parametrize("threshold", [0.3, (-0.5, 0.2), (-np.inf, 0.2), (-0.2, np.inf)])
@pytest.mark.parametrize("scene", [SCENE, ns.Scene("elasto_plastic", "langevin")])
def test_counts_are_those_of_stored_paths(threshold, scene):
    """Bit for bit: the extremes of int g over all steps against the levels."""
    # one step from time to time; up to the first, of 16 steps, int g is far from all levels
    times, paths, step = np.geomspace(0.1, 4, 70), 1_500, 0.25
    kept = ns.simulate(scene, 4.0, step=step, paths=paths, seed=6, times=times, keep="paths")
    lower, upper = bounds(threshold)
    outside = (kept["delta"] <= lower) | (kept["delta"] >= upper)
    reached = np.logical_or.accumulate(outside.values, axis=1).sum(axis=0)
    sampling = Sampling(step, paths, 6, precision="float64")
    counts = first_passage_counts(scene, threshold, times, 1.0, sampling)
    assert np.array_equal(np.cumsum(counts), reached[1:])
    assert 0.1 * paths < reached[-1] < paths


def test_mirrored_levels_of_an_odd_scene():
    """Dry friction has no side: both one-sided probabilities are the same, within their errors."""
    runs = [
        ns.crossing_probability(SCENE, levels, HORIZONS, p=10, method="monte_carlo", seed=seed)
        for seed, levels in enumerate([(-np.inf, 0.4), (-0.4, np.inf)])
    ]
    # tol = 1e-2: three standard errors are three quarters of it, at most those of W = 1/2
    assert all(run.attrs["paths"] <= 40_000 for run in runs)
    assert all(np.all(3 * run["probability_error"] <= 0.75e-2) for run in runs)
    difference = runs[0]["probability"] - runs[1]["probability"]
    error = np.hypot(*(run["probability_error"] for run in runs))
    assert np.max(np.abs(difference / error)) < stats.norm.isf(FALSE_ALARM / 2 / len(HORIZONS))


def test_one_level_by_the_reflection_principle():
    """P(max >= b) = erfc(b / (gamma sqrt(2 T))) with b + kappa/sqrt(p) for b, error O(1/p)."""
    p, paths, gamma = 100.0, 40_000, np.sqrt(0.137696412899501)
    sampling = Sampling(0.02, paths, 9)
    counts = first_passage_counts(SCENE, (-np.inf, 0.6), HORIZONS, p, sampling)
    estimate, _, _ = proportion(counts.sum(), paths)
    expected = special.erfc((0.6 + 0.2911259630 / np.sqrt(p)) / gamma / np.sqrt(2 * HORIZONS[-1]))
    error = np.sqrt(expected * (1 - expected) / paths)
    # 1e-3 is the error with two levels; of the step as above
    assert abs(estimate - expected) < stats.norm.isf(FALSE_ALARM / 2) * error + 1e-3 + 6e-4


@pytest.mark.parametrize("levels", [(-1.0, 1.0), (-1.5, 0.7)])
def test_passage_times_of_two_levels(levels):
    """The earlier of those of each level, bit for bit, for both steps."""
    passages = [
        coupled(SCENE, [2.0, 10.0], Sampling(0.1, 1_500, 10), pair)[1]
        for pair in (levels, (levels[0], np.inf), (-np.inf, levels[1]))
    ]
    assert np.array_equal(passages[0], np.minimum(*passages[1:]))
    assert np.isfinite(passages).any(axis=2).all()
    assert np.isinf(passages).any(axis=2).all()


@pytest.mark.parametrize(("probability", "trials"), [(0.16, 1_000), (0.5, 400), (1e-4, 100_000)])
def test_interval_covers_at_its_level(probability, trials):
    """Exact coverage by summation over the binomial law: 95 % within two, down to 1e-4."""
    k = np.arange(trials + 1) if trials < 2_000 else np.arange(200)
    _, lower, upper = proportion(k, trials)
    covered = (lower <= probability) & (probability <= upper)
    coverage = np.sum(stats.binom.pmf(k, trials, probability)[covered])
    assert abs(coverage - 0.95) < 0.02


def test_interval_at_the_ends():
    """Nothing or everything counted: the limits 0 and 1 are included."""
    _, lower, upper = proportion([0, 50], 50)
    assert lower[0] == 0
    assert upper[1] == 1
    assert 0.02 < upper[0] < 0.08


def test_asymptotic_method_is_the_limit():
    """W_star with gamma^2 in closed form; its error is that of gamma^2."""
    run = ns.crossing_probability(SCENE, 0.6, [2.0], method="asymptotic")
    assert float(run["probability"][0]) == pytest.approx(0.5045888, abs=5e-8)
    assert float(run["probability_error"][0]) < 1e-13
    one_sided = ns.crossing_probability(SCENE, (-np.inf, 0.6), [2.0], method="asymptotic")
    exact = special.erfc(0.6 / np.sqrt(2 * 2.0 * 0.137696412899501))
    assert float(one_sided["probability"][0]) == pytest.approx(exact, abs=1e-13)


def test_distance_to_the_limit_falls_with_p():
    """From 0.34 over 0.14 to 0.045 at T = 2, p = 1, 10, 100 (order p^-1/2)."""
    limit = ns.crossing_probability(SCENE, 0.6, [2.0], method="asymptotic")["probability"][0]
    for p, distance in ((1, 0.344), (10, 0.137), (100, 0.0450)):
        run = ns.crossing_probability(SCENE, 0.6, HORIZONS, p=p, paths=5_000, seed=4, step=0.02)
        error = stats.norm.isf(FALSE_ALARM / 2) * run["probability_error"][-1]
        assert abs(float(limit - run["probability"][-1]) - distance) < error + 1e-3


def test_halving_shifts_the_passage_times_by_the_bias_of_the_variance():
    """Mean log time shifts by minus the relative bias of the growth rate (h = 0.2: -0.023)."""
    count, total, square = first_passage_shift(SCENE, 0.6, 20.0, 10.0, Sampling(0.2, 20_000, 6))
    mean = total / count
    error = np.sqrt((square / count - mean**2) / count)
    assert count > 19_900
    # the variance's halving at the same step, from independent samples
    change, _ = coupled(SCENE, [20.0], Sampling(0.2, 50_000, 7))
    bias, spread = step_bias(change, np.inf)
    v = float(ns.variance(SCENE, [20.0])["v"][0])
    relative, relative_error = bias[0] / v, spread[0] / v
    # finite p: passage times are those of a Brownian motion up to p^-1/2 = 0.32
    allowed = stats.norm.isf(FALSE_ALARM / 2) * np.hypot(error, relative_error)
    assert abs(mean + relative) < allowed + 0.32 * abs(relative)


def test_tolerance_is_met():
    """|error| <= tol at every horizon; a false alarm in 100 runs."""
    exact = ns.crossing_probability(SCENE, 0.6, HORIZONS, p=10, method="deterministic").probability
    for tol in (3e-2, 1e-2, 3e-3):
        run = ns.crossing_probability(SCENE, 0.6, HORIZONS, p=10, method="monte_carlo", tol=tol)
        assert np.max(np.abs(run["probability"] - exact)) < tol


def test_tolerance_out_of_reach_is_refused_with_the_best_value():
    """1e13 paths would take for ever; the message says what can be had."""
    scene = ns.Scene("friction", "langevin")
    with pytest.raises(ToleranceError, match=r"W = .* use tol >="):
        ns.crossing_probability(scene, 0.6, HORIZONS, tol=1e-7, method="monte_carlo")


def test_what_hardly_happens_takes_few_paths():
    """Where W is far below tol, some counts by 1/tol show it; a false alarm in 300 runs."""
    exact = ns.crossing_probability(SCENE, 3.0, HORIZONS, p=10, method="deterministic").probability
    assert exact[-1] < 1e-5
    for tol, most in ((1e-3, 13_000), (1e-2, 1_200)):
        run = ns.crossing_probability(SCENE, 3.0, HORIZONS, p=10, method="monte_carlo", tol=tol)
        assert np.max(np.abs(run["probability"] - exact)) < tol
        assert run.attrs["paths"] <= most


def test_corrected_formula_is_taken_where_its_error_is_small():
    """At large p, but not where g is above the Lyapunov function or tol below the error."""
    problem = {"threshold": 0.6, "horizons": HORIZONS, "p": 1000.0}
    run = ns.crossing_probability(SCENE, **problem, tol=1e-4)
    exact = ns.crossing_probability(SCENE, **problem, method="deterministic")
    assert run.attrs["method"] == "corrected"
    assert np.max(np.abs(run["probability"] - exact["probability"])) < 1e-4
    assert ns.crossing_probability(SCENE, **problem, tol=2e-8).attrs["method"] == "deterministic"
    beyond = ns.Scene("friction", n=100, observable="y**3")
    run = ns.crossing_probability(beyond, 0.6, [2.0], p=1000.0, tol=1e-4)
    assert run.attrs["method"] != "corrected"


def test_divergence_is_an_error():
    """A path that becomes nan must not count as one that never crosses."""
    scene = ns.Scene("friction", potential="-x**4", observable="y", start={"x": 5.0})
    with pytest.raises(SceneError, match="diverged"):
        first_passage_counts(scene, 5e307, HORIZONS, 10.0, Sampling(0.1, 10, 1))


@pytest.mark.parametrize(
    ("arguments", "cure"),
    [
        ({"threshold": 0.0}, "threshold > 0"),
        ({"threshold": (0.1, 0.6)}, "lower < 0 < upper"),
        ({"p": -1.0}, "p > 0"),
        ({"method": "montecarlo"}, "monte_carlo"),
        ({"method": "asymptotic"}, "no parameter 'paths'"),
        ({"step": -0.1}, "step > 0"),
        ({"paths": 0}, "paths > 0"),
        ({"paths": 1e2}, "whole number"),
        ({"horizons": []}, "sort them"),
        ({"horizons": [0.0, 1.0]}, "sort them"),
        ({"horizons": [1.0, 0.5]}, "sort them"),
        ({"tol": 0.0}, "tol > 0"),
    ],
)
def test_bad_requests_are_refused(arguments, cure):
    """One line with the cure."""
    defaults = {"threshold": 0.6, "horizons": HORIZONS, "p": 1.0, "paths": 100}
    with pytest.raises(SceneError, match=cure):
        ns.crossing_probability(SCENE, **(defaults | arguments))


def test_formula_refuses_an_observable_that_is_not_centred():
    """(equivalent) needs E g = 0; the message has the mean."""
    scene = ns.Scene("friction", observable="y**2")
    with pytest.raises(SceneError, match=r"E g = 0.*subtract"):
        ns.crossing_probability(scene, 0.6, [1.0], method="asymptotic")
