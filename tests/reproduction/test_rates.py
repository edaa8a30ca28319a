"""The limit n -> infinity: slopes of made-up data, rates that are known."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.paths.sampling import Sampling
from reproduction.rates import gamma2_difference, largest_distances, slope
from reproduction.time_scales import contact_time

N = np.array([10.0, 30.0, 100.0, 300.0, 1000.0])


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
