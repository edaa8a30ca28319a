"""The public function for gamma^2: its method, the mean that it subtracts, and gamma^2 = 0."""

import re

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
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


@pytest.mark.parametrize("model", ["friction", "elasto_plastic", "obstacle"])
@pytest.mark.parametrize("method", [None, "deterministic", "monte_carlo"])
def test_a_constant_has_no_variance(model, method):
    """Exactly, whatever the formula is before it is simplified."""
    scene = ns.Scene(model, observable="2 + y - y")
    found = ns.asymptotic_variance(scene, method=method)
    assert (found.value, found.error) == (0.0, 0.0)
    moments = ns.variance(scene, [0.1, 3.0], method=method)
    assert not any(np.any(moments[name]) for name in ("w", "w_error", "v", "v_error"))


COBOUNDARIES = [
    ("obstacle", "{a}*y", "x**2/2"),
    ("obstacle", "{a}*x*y", "x**2/2 + 0.3*cos(3*x)"),
    ("obstacle", "y/(1 + {a}*x**2)", "x**2/2"),
    ("friction", "{a}*y", "{a}*x**2/2"),
]


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(("model", "g", "U"), COBOUNDARIES)
def test_derivatives_of_bounded_functions_are_refused(seed, model, g, U):
    """int_0^t g stays bounded, so that gamma^2 = 0; the best value is that within its error."""
    rng = np.random.default_rng(seed)
    a, n, damping = rng.uniform(0.5, 2), 10 ** rng.uniform(0, 3), rng.uniform(0.5, 2)
    g, U = (formula.format(a=round(a, 3)) for formula in (g, U))
    scene = ns.Scene(model, n=n, damping=damping, potential=U, observable=g)
    with pytest.raises(ToleranceError, match="stays bounded") as refused:
        ns.asymptotic_variance(scene, 1e-2, "deterministic")
    value, error = map(
        float, re.findall(r"gamma.2 = (\S+) has an error of ([^,]+),", str(refused.value))[0]
    )
    assert 0 <= value <= error < 1e-3
