"""Distances between laws, their bounds, and the theorem on the scene whose gamma is known."""

import numpy as np
import pytest
from scipy import stats

from nonsmooth.crossing.counting import first_passage_counts
from nonsmooth.paths.sampling import Sampling
from references import FALSE_ALARM, FRICTION, GAMMA2, KAPPA
from reproduction.limit_theorem import (
    allowed_distance,
    distance_to_limit,
    error_bound,
    kolmogorov_distance,
    maximum_law,
    normal_law,
    sampling_bound,
    scaled_integrals,
)


def test_distance_of_points_by_hand():
    """One point at the median: 1/2; two at the quartiles: 1/4; all beyond every value: 1."""
    assert kolmogorov_distance([0.0], normal_law) == 0.5
    assert kolmogorov_distance(stats.norm.ppf([0.75, 0.25]), normal_law) == pytest.approx(0.25)
    assert kolmogorov_distance([50.0, 60.0], normal_law) == pytest.approx(1.0)


def test_distance_is_scipys():
    """On random samples with ties, seed fixed."""
    rng = np.random.default_rng(1)
    for count in (3, 50, 1000):
        sample = np.round(rng.normal(0.3, 1.2, count), 2)
        expected = stats.kstest(sample, stats.norm.cdf).statistic
        assert kolmogorov_distance(sample, normal_law) == pytest.approx(expected, abs=1e-14)


def test_law_of_the_maximum_is_that_of_a_random_walk():
    """4000 steps, absorbed at +-63: exact by the eigenvectors of the transition matrix."""
    steps, level = 4000, 63  # about one standard deviation
    k = np.arange(1, 2 * level, 2)
    angle = k * np.pi / (2 * level)
    survival = np.sum(np.sin(k * np.pi / 2) * np.cos(angle) ** steps / np.tan(angle / 2)) / level
    # a level of the lattice is never jumped over, so that the error is O(1/steps)
    assert survival == pytest.approx(float(maximum_law(level / np.sqrt(steps))), abs=1e-3)


@pytest.mark.parametrize("count", [20, 1000])
def test_sampling_bound_holds_at_its_level(count):
    """Exact tail of the two-sided Kolmogorov statistic: below the level, and not far below."""
    for level in (0.05, 1e-3):
        tail = stats.kstwo.sf(sampling_bound(count, level), count)
        assert 0.5 * level < tail <= level


def test_sensitivity_is_the_change_with_gamma():
    """For normal quantiles, d D / d log gamma = max x phi(x) = phi(1)."""
    level = (np.arange(100_000) + 0.5) / 100_000
    distance, sensitivity = distance_to_limit(stats.norm.ppf(level), normal_law, 1.0, 2e-3)
    assert distance < 1e-5
    assert sensitivity == pytest.approx(1e-3 * stats.norm.pdf(1), rel=0.02)


def test_error_bound_has_both_parts():
    """Without an error of gamma^2 it is the sampling bound at half the probability."""
    plain, wider = error_bound(500, [0.0, 0.01], 0.05)
    assert plain == sampling_bound(500, 0.025)
    assert wider - plain == pytest.approx(0.01 * stats.norm.isf(0.0125))


@pytest.mark.parametrize("second", [-1.0, 0.0, 0.5])
def test_two_terms_are_allowed_and_no_more(second):
    """D = p^-1/2 (1 + second p^-1/2) + third: allowed for third = 0, up to the errors."""
    p = np.array([4.0, 25.0, 400.0])
    distance = p**-0.5 + second / p
    error = np.full(3, 1e-3)
    allowed = allowed_distance(p, distance, error)
    assert distance[-1] <= allowed
    if second <= 0:  # the line: 1.25 and 0.25 are its weights
        slope = (1 / 5 - 1 / 20) / (1 / 2 - 1 / 5)
        largest = 1e-3 * (1 + ((1 + slope) * 5 + slope * 2) / 20)
        assert allowed - distance[-1] == pytest.approx(largest)
    constant = allowed_distance(p, np.full(3, 0.1), error)
    assert constant < 0.1


def test_scaled_integrals_are_those_of_the_crossings():
    """As many maxima above sqrt(p) b as first passages counted; |Xi_p(1)| is at most the max."""
    p, b, step, paths = (2.0, 8.0), 0.6, 0.05, 1500
    final, maximum = scaled_integrals(FRICTION, p, [step, step], Sampling(step, paths, 5))
    assert final.shape == maximum.shape == (2, paths)
    assert np.all(np.abs(final) <= maximum * (1 + 1e-6))
    counts = first_passage_counts(FRICTION, b, [1.0], 2.0, Sampling(step, paths, 5))
    assert np.sum(maximum[0] >= b) == counts[0]
    assert np.all(maximum[1] * np.sqrt(8) >= maximum[0] * np.sqrt(2))


def test_theorem_on_dry_friction():
    """Normal up to O(1/p), the maximum as far off as is known, and a wrong gamma is seen."""
    paths = 20_000
    sampling = Sampling(0.05, paths, 2)
    samples = scaled_integrals(FRICTION, [100.0], [sampling.step], sampling)
    final, maximum = samples[:, 0] / np.sqrt(GAMMA2)
    bound = sampling_bound(paths, FALSE_ALARM)
    # v(100)/100 = 0.1368 for 0.1377: the spread is 0.3 % too small, the distance phi(1) times it
    assert kolmogorov_distance(final, normal_law) < bound + 0.0033 * stats.norm.pdf(1) + 2e-3
    # the threshold is effectively higher by kappa/sqrt(p)
    shift = KAPPA / np.sqrt(100 * GAMMA2)
    grid = np.linspace(0.01, 6, 4001)
    expected = np.max(maximum_law(grid + shift) - maximum_law(grid))
    assert abs(kolmogorov_distance(maximum, maximum_law) - expected) < bound + 5e-3
    corrected = kolmogorov_distance(maximum, lambda m: maximum_law(m + shift))
    assert corrected < bound + 5e-3
    assert kolmogorov_distance(1.2 * final, normal_law) > bound + 0.02
