"""The bias of the time step at large p."""

import numpy as np

from nonsmooth.crossing.counting import bias_of_counts, first_passage_counts
from nonsmooth.paths.absorption.passages import coupled_passages
from nonsmooth.paths.sampling import Sampling
from references import FRICTION
from reproduction.sweep import crossing_bias

HORIZONS = np.array([0.5, 1.0, 1.5, 2.0])


def measured(p, sampling):
    """Bias of W at b = 0.6, as halving the step shows it, and its standard error."""
    levels = np.sqrt(p) * np.array([-0.6, 0.6])
    passage = coupled_passages(FRICTION, p * HORIZONS, sampling, levels)
    return bias_of_counts(p * HORIZONS, passage, order=1.5)  # a kink takes half an order


def test_it_is_measured_up_to_a_p():
    """It is what halving the step changes, on the same paths."""
    sampling = Sampling(0.1, 2000, 3)
    found = crossing_bias(FRICTION, 0.6, HORIZONS, 5.0, np.zeros(4), 10.0, sampling)
    np.testing.assert_array_equal(found, measured(5.0, sampling))


def test_beyond_it_follows_from_that_of_gamma2():
    """At p = 80 it can still be measured; five standard errors are a false alarm of 6e-7."""
    p, step, paths = 80.0, 0.4, 50_000
    counts = first_passage_counts(FRICTION, 0.6, HORIZONS, p, Sampling(step, paths, 4))
    probability = np.cumsum(counts) / paths
    found, error = crossing_bias(
        FRICTION, 0.6, HORIZONS, p, probability, 10.0, Sampling(step, paths, 5)
    )
    direct, spread = measured(p, Sampling(step, paths, 6))
    assert np.all(np.abs(found - direct) <= 5 * np.hypot(error, spread))
    assert np.all(error < np.abs(direct).max())


def test_what_gamma2_does_not_explain_falls_with_p():
    """error^2 = a^2 + c^2/p with the same a and c at all p, and at every T the same c."""
    sampling, slope = Sampling(0.1, 5_000, 3), np.array([0.1, 0.3, 0.4, 0.5])
    errors = [
        crossing_bias(FRICTION, 0.6, HORIZONS, p, slope, 10.0, sampling)[1] ** 2
        for p in (20.0, 40.0, 80.0)
    ]
    first, second = errors[0] - errors[1], errors[1] - errors[2]
    np.testing.assert_allclose(first, first[0], rtol=1e-9)
    np.testing.assert_allclose(first, 2 * second, rtol=1e-9)
