"""Confidence intervals of counted fractions cover at their level."""

import numpy as np
import pytest
from scipy import stats

from nonsmooth.crossing.proportions import limits_less_bias, proportion


@pytest.mark.parametrize(("probability", "trials"), [(0.16, 1_000), (0.5, 400), (1e-4, 100_000)])
def test_interval_covers_at_its_level(probability, trials):
    """The interval covers with 95 % within two, down to 1e-4, by the binomial law itself."""
    k = np.arange(trials + 1) if trials < 2_000 else np.arange(200)
    _, lower, upper = proportion(k, trials)
    covered = (lower <= probability) & (probability <= upper)
    coverage = np.sum(stats.binom.pmf(k, trials, probability)[covered])
    assert abs(coverage - 0.95) < 0.02


@pytest.mark.parametrize("away", [0.0, 0.7, 2.0, 5.0, -1.5, -4.0])
def test_limits_less_a_bias_cover_at_their_level(away):
    """The bias is a multiple of the standard error and known to half of it; 10^5 samples.

    The coverage is known to 0.0007 and within two per cent; it rises by one where chance decides
    whether the bias makes the interval wider. The fraction itself is inside, always.
    """
    rng, paths, truth = np.random.default_rng(1), 2000, 0.3
    spread = np.sqrt(truth * (1 - truth) / paths)
    crossed = rng.binomial(paths, truth + away * spread, 100_000)
    bias = away * spread + spread / 2 * rng.standard_normal(len(crossed))
    lower, upper = limits_less_bias(crossed, paths, bias, np.full(len(crossed), spread / 2))
    assert np.all((lower <= crossed / paths) & (crossed / paths <= upper))
    assert abs(np.mean((lower <= truth) & (truth <= upper)) - 0.95) < 0.02


def test_limits_without_a_bias_are_those_of_the_fraction():
    """To the last bit, also where nothing or everything is counted."""
    crossed = np.array([0, 3, 25, 50])
    _, lower, upper = proportion(crossed, 50)
    assert np.allclose(limits_less_bias(crossed, 50, 0 * lower, 0 * lower), (lower, upper))


def test_interval_at_the_ends():
    """The limits 0 and 1 are included where nothing or everything is counted."""
    _, lower, upper = proportion([0, 50], 50)
    assert lower[0] == 0
    assert upper[1] == 1
    assert 0.02 < upper[0] < 0.08
