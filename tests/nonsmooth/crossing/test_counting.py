"""Counted crossings: the same however they run, the bias of the step."""

import numpy as np
import pytest
from scipy import special, stats

import nonsmooth as ns
from nonsmooth.crossing.counting import first_passage_counts, first_passage_shift
from nonsmooth.crossing.proportions import proportion
from nonsmooth.errors import SceneError
from nonsmooth.paths.ensembles import coupled
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.moments import step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.thresholds import bounds
from references import FALSE_ALARM, FRICTION, GAMMA2, KAPPA

HORIZONS = np.linspace(0, 2, 11)[1:]


def test_number_of_threads_and_shards_changes_no_count():
    """The counts of one run of two blocks are the sum of those of one block each."""
    arguments = (FRICTION, 0.6, HORIZONS, 1.0)
    whole = first_passage_counts(*arguments, Sampling(0.05, 2 * BLOCK, 5, threads=2))
    parts = [
        first_passage_counts(*arguments, Sampling(0.05, BLOCK, 5, first, threads=1))
        for first in (0, BLOCK)
    ]
    assert np.array_equal(whole, sum(parts))


def test_thresholds_out_of_reach_and_within_every_reach():
    """No path integrates to 50 in two units of time; every path to a tiny threshold."""
    none = first_passage_counts(FRICTION, 50.0, HORIZONS, 1.0, Sampling(0.05, 500, 1))
    every = first_passage_counts(FRICTION, 1e-9, HORIZONS, 1.0, Sampling(0.05, 500, 1))
    assert none.sum() == 0
    assert every.sum() == every[0] == 500


def crossed(threshold, scene=FRICTION, p=10.0, paths=5_000):
    """Numbers of paths that have crossed by the horizons, of the same paths for all thresholds."""
    return np.cumsum(first_passage_counts(scene, threshold, HORIZONS, p, Sampling(0.05, paths, 8)))


def test_levels_of_both_sides():
    """A number stands for two opposite levels, and a path leaves by one of two levels or both."""
    assert np.array_equal(crossed((-0.6, 0.6)), crossed(0.6))
    for lower, upper in ((-0.6, 0.6), (-0.9, 0.4)):
        both, below, above = (
            crossed(levels) for levels in ((lower, upper), (lower, np.inf), (-np.inf, upper))
        )
        assert np.all(np.maximum(below, above) <= both)
        assert np.all(both <= below + above)
        assert both[-1] < below[-1] + above[-1]  # some paths reach both levels


@pytest.mark.parametrize("threshold", [0.3, (-0.5, 0.2), (-np.inf, 0.2), (-0.2, np.inf)])
@pytest.mark.parametrize("scene", [FRICTION, ns.Scene("elasto_plastic", "langevin")])
def test_counts_are_those_of_stored_paths(threshold, scene):
    """The counts are, bit for bit, those of the extremes of int g on stored paths."""
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


def test_one_level_by_the_reflection_principle():
    """P(max >= b) = erfc(b / (gamma sqrt(2 T))) with b + kappa/sqrt(p) for b, error O(1/p)."""
    p, paths, gamma = 100.0, 40_000, np.sqrt(GAMMA2)
    sampling = Sampling(0.02, paths, 9)
    counts = first_passage_counts(FRICTION, (-np.inf, 0.6), HORIZONS, p, sampling)
    estimate, _, _ = proportion(counts.sum(), paths)
    expected = special.erfc((0.6 + KAPPA / np.sqrt(p)) / gamma / np.sqrt(2 * HORIZONS[-1]))
    error = np.sqrt(expected * (1 - expected) / paths)
    # 1e-3 is the error with two levels; of the step as above
    assert abs(estimate - expected) < stats.norm.isf(FALSE_ALARM / 2) * error + 1e-3 + 6e-4


@pytest.mark.parametrize("levels", [(-1.0, 1.0), (-1.5, 0.7)])
def test_passage_times_of_two_levels(levels):
    """The earlier of those of each level, bit for bit, for both steps."""
    passages = [
        coupled(FRICTION, [2.0, 10.0], Sampling(0.1, 1_500, 10), pair)[1]
        for pair in (levels, (levels[0], np.inf), (-np.inf, levels[1]))
    ]
    assert np.array_equal(passages[0], np.minimum(*passages[1:]))
    assert np.isfinite(passages).any(axis=2).all()
    assert np.isinf(passages).any(axis=2).all()


def test_halving_shifts_the_passage_times_by_the_bias_of_the_variance():
    """Mean log time shifts by minus the relative bias of gamma^2 (h = 0.2: -0.023)."""
    count, total, square = first_passage_shift(FRICTION, 0.6, 20.0, 10.0, Sampling(0.2, 20_000, 6))
    mean = total / count
    error = np.sqrt((square / count - mean**2) / count)
    assert count > 19_900
    # the variance's halving at the same step, from independent samples
    change, _ = coupled(FRICTION, [20.0], Sampling(0.2, 50_000, 7))
    bias, spread = step_bias(change, np.inf)
    v = float(ns.variance(FRICTION, [20.0])["v"][0])
    relative, relative_error = bias[0] / v, spread[0] / v
    # finite p: passage times are those of a Brownian motion up to p^-1/2 = 0.32
    allowed = stats.norm.isf(FALSE_ALARM / 2) * np.hypot(error, relative_error)
    assert abs(mean + relative) < allowed + 0.32 * abs(relative)


def test_divergence_is_an_error():
    """A path that becomes nan must not count as one that never crosses."""
    scene = ns.Scene("friction", potential="-x**4", observable="y", start={"x": 5.0})
    with pytest.raises(SceneError, match="diverged"):
        first_passage_counts(scene, 1e30, HORIZONS, 10.0, Sampling(0.1, 10, 1))
