"""The public function for gamma^2: which method it takes, and the mean that it subtracts."""

import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.statistics.asymptotic_variance import stationary_mean
from references import FRICTION, OBSTACLE


def test_mean_by_symmetry_quadrature_and_simulation():
    """0 for odd g; E y^2 of friction; E y^2 = 1/2 of the obstacle."""
    assert stationary_mean(OBSTACLE) == (0.0, 0.0)
    exact, error = stationary_mean(ns.Scene("friction", observable="y**2"))
    assert 0 < error < 1e-14
    assert 0 < exact < 0.5
    value, error = stationary_mean(ns.Scene("obstacle", potential="x**2/2", observable="y**2"))
    assert abs(value - 0.5) < 5 * error + 1e-3
    with pytest.raises(SceneError, match="subtract"):
        ns.crossing_probability(
            ns.Scene("obstacle", potential="x**2/2", observable="y**2"),
            0.6,
            [1.0],
            method="asymptotic",
        )


def test_the_method_follows_from_the_tolerance():
    """Three variables are sampled to a tenth; what has no solver always is."""
    scene = ns.Scene("obstacle", "langevin", potential="x**2/2", observable="x")
    assert ns.asymptotic_variance(scene, 0.1).method == "Monte Carlo"
    assert ns.asymptotic_variance(FRICTION, 0.1).method == "closed form"
    assert ns.variance(scene, [1.0], 0.05).attrs["method"] == "monte_carlo"
    assert ns.variance(FRICTION, [1.0], 0.05).attrs["method"] == "deterministic"
