"""The public function for gamma^2: its method, and gamma^2 = 0."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.statistics.gamma2_on_grids import gamma2
from references import FRICTION


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
def test_derivatives_of_bounded_functions_have_no_variance(seed, model, g, U):
    """int_0^t g stays bounded: gamma^2 = 0 by its formula, and on grids within the error."""
    rng = np.random.default_rng(seed)
    a, n, damping = rng.uniform(0.5, 2), 10 ** rng.uniform(0, 3), rng.uniform(0.5, 2)
    g, U = (formula.format(a=round(a, 3)) for formula in (g, U))
    scene = ns.Scene(model, n=n, damping=damping, potential=U, observable=g)
    for method in (None, "deterministic", "monte_carlo"):
        found = ns.asymptotic_variance(scene, method=method)
        assert (found.value, found.error, found.method) == (0.0, 0.0, "g is a derivative in x")
    with pytest.raises(ToleranceError, match="stays bounded") as refused:
        gamma2(scene, 1e-2)
    value, error = refused.value.result
    assert max(value, 0.0) <= error < 1e-3
