"""The limit n -> infinity: slopes of made-up data, rates that are known."""

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.paths.sampling import Sampling
from reproduction.rates import gamma2_difference, largest_distances, power_of_n, slope
from reproduction.time_scales import contact_time

N = np.array([10.0, 30.0, 100.0, 300.0, 1000.0])
RATIO = 4.0
GEOMETRIC = 4.0 * RATIO ** np.arange(5)


def test_slope_of_an_exact_power():
    """Exact data, and one point that is all error and left out."""
    assert slope(N, 3 * N**-1.5, 1e-3 * N**-1.5)[0] == pytest.approx(-1.5, abs=1e-12)
    value, error = 3 * N**-1.5, 1e-3 * N**-1.5
    value[2], error[2] = 1.0, 0.6
    assert slope(N, value, error)[0] == pytest.approx(-1.5, abs=1e-12)


def test_interval_covers():
    """95 % intervals of noisy data: at least 90 % cover in 400 fits (false alarm below 1e-4)."""
    generator = np.random.default_rng(2)
    hits = 0
    for _ in range(400):
        relative = 0.05 * np.ones(5)
        value = N**-1.0 * (1 + relative * generator.standard_normal(5))
        found, half = slope(N, value, relative * N**-1.0)
        hits += abs(found + 1) <= half
    assert hits >= 360


def test_too_few_differences():
    """Differences within their errors give no slope; the message asks for more paths."""
    with pytest.raises(ToleranceError, match="take more paths"):
        slope(N, np.ones(5), [1.0, 1.0, 1.0, 0.1, 0.1])


def test_gamma2_of_dry_friction_is_of_second_order():
    """gamma_n^2 - gamma^2 ~ 0.173 n^-2."""
    value, error = gamma2_difference(ns.Scene("friction", n=1000))
    assert value * 1e6 == pytest.approx(0.1726, abs=1e-3)
    assert error < 1e-5 * value


def test_time_scales():
    """They are those of a Brownian velocity, a relaxation and a contact."""
    scales = [
        contact_time(ns.Scene(model, noise, n=100, potential="x**2/2"))
        for model, noise in (
            ("friction", "white"),
            ("friction", "langevin"),
            ("elasto_plastic", "white"),
            ("obstacle", "white"),
        )
    ]
    assert np.allclose(scales, [1e-4, 1e-2, 1e-2, 1e-1])


def test_distance_of_dry_friction_on_paths():
    """Five times n: the distance falls by 5^-1.2 at least, and threads change nothing."""
    near, far, again = (
        largest_distances(
            ns.Scene("friction", n=n), "y", 1.0, Sampling(0.5 / n**2, 300, 1, threads=threads)
        )
        for n, threads in ((4, 1), (20, 2), (4, 2))
    )
    assert far.mean() < near.mean() * 5**-1.2
    assert np.array_equal(near, again)


def test_errors_hold_whatever_the_next_order():
    """Powers from 0.4 to 2.2, a next order in n^(-0.6) to 1/n, errors of either sign.

    Of a next order n^(-c) the exponent keeps 1/(4^c - 1) of what the next smaller n changes, at
    most 0.77, which leaves room for its square.
    """
    generator, answered = np.random.default_rng(3), 0
    for _ in range(2000):
        power, more = generator.uniform(0.4, 2.2), generator.uniform(0.6, 1.0)
        relative = 1 + generator.uniform(-1, 1) * GEOMETRIC**-more
        error = 1e-5 * generator.uniform(-1, 1, len(GEOMETRIC))
        value = 0.3 + 0.2 * GEOMETRIC**-power * relative + error
        try:
            exponent, limit = power_of_n(RATIO, value, np.full(len(GEOMETRIC), 1e-5))
        except ToleranceError:
            continue
        answered += 1
        assert abs(exponent[0] + power) <= exponent[1]
        assert abs(limit[0] - 0.3) <= limit[1]
    assert answered > 1000


def test_brownian_probabilities_of_dry_friction():
    """gamma_n^2 is a closed form with the power -2, and so has W_star(b / gamma_n, T)."""

    def probability(n):
        return ns.brownian_crossing(0.6 / math.sqrt(friction_variance(n, 1.0)[0]), 2.0)

    exponent, limit = power_of_n(
        RATIO, [probability(n) for n in GEOMETRIC], np.full(len(GEOMETRIC), 1e-13)
    )
    assert abs(exponent[0] + 2) < exponent[1] < 0.02
    assert abs(limit[0] - probability(math.inf)) < limit[1] < 1e-7


@pytest.mark.parametrize(
    ("value", "error", "message"),
    [
        ([0.4, 0.31, 0.305, 0.3049], 1e-4, "less than its error"),
        ([0.4, 0.31, 0.32, 0.319], 1e-6, "different directions"),
        ([0.1, 0.2, 0.29, 0.38], 1e-6, "there might be no limit"),
    ],
)
def test_what_shows_no_power_is_refused(value, error, message):
    """Differences within their errors, of both signs, or that do not fall."""
    with pytest.raises(ToleranceError, match=message):
        power_of_n(RATIO, value, np.full(4, error))
