"""The public function for crossing probabilities: its limit, its choice of a method, refusals."""

import numpy as np
import pytest
from scipy import special

import nonsmooth as ns
from nonsmooth.errors import SceneError
from references import FRICTION, GAMMA2, W_STAR

HORIZONS = np.linspace(0, 2, 11)[1:]


def test_asymptotic_method_is_the_limit():
    """W_star with gamma^2 in closed form; its error is that of gamma^2."""
    run = ns.crossing_probability(FRICTION, 0.6, [2.0], method="asymptotic")
    assert float(run["probability"][0]) == pytest.approx(W_STAR, abs=5e-8)
    assert float(run["probability_error"][0]) < 1e-13
    one_sided = ns.crossing_probability(FRICTION, (-np.inf, 0.6), [2.0], method="asymptotic")
    exact = special.erfc(0.6 / np.sqrt(2 * 2.0 * GAMMA2))
    assert float(one_sided["probability"][0]) == pytest.approx(exact, abs=1e-13)


def test_corrected_formula_is_taken_where_its_error_is_small():
    """At large p it is taken, but not for a g above V, nor for a tol below its error."""
    problem = {"threshold": 0.6, "horizons": HORIZONS, "p": 1000.0}
    run = ns.crossing_probability(FRICTION, **problem, tol=1e-4)
    exact = ns.crossing_probability(FRICTION, **problem, method="deterministic")
    assert run.attrs["method"] == "corrected"
    assert np.max(np.abs(run["probability"] - exact["probability"])) < 1e-4
    assert ns.crossing_probability(FRICTION, **problem, tol=2e-8).attrs["method"] == "deterministic"
    beyond = ns.Scene("friction", n=100, observable="y**3")
    run = ns.crossing_probability(beyond, 0.6, [2.0], p=1000.0, tol=1e-4)
    assert run.attrs["method"] != "corrected"


@pytest.mark.parametrize(
    ("arguments", "cure"),
    [
        ({"threshold": 0.0}, "threshold > 0"),
        ({"threshold": (0.1, 0.6)}, "lower < 0 < upper"),
        ({"p": -1.0}, "p is -1.0; give a positive"),
        ({"method": "montecarlo"}, "monte_carlo"),
        ({"method": "asymptotic"}, "no parameter 'paths'"),
        ({"step": -0.1}, "step is -0.1; give a positive"),
        ({"paths": 0}, "paths is 0; give a positive whole"),
        ({"paths": 1.5}, "whole number"),
        ({"horizons": []}, "a list of them"),
        ({"horizons": [0.0, 1.0]}, "numbers that increase"),
        ({"horizons": [1.0, 0.5]}, "numbers that increase"),
        ({"tol": 0.0}, "tol is 0.0; give a positive"),
    ],
)
def test_bad_requests_are_refused(arguments, cure):
    """The error is one line with the cure."""
    defaults = {"threshold": 0.6, "horizons": HORIZONS, "p": 1.0, "paths": 100}
    with pytest.raises(SceneError, match=cure):
        ns.crossing_probability(FRICTION, **(defaults | arguments))


def test_formula_refuses_an_observable_that_is_not_centred():
    """(equivalent) needs E g = 0; the message has the mean."""
    scene = ns.Scene("friction", observable="y**2")
    with pytest.raises(SceneError, match=r"E g = 0.*subtract"):
        ns.crossing_probability(scene, 0.6, [1.0], method="asymptotic")


@pytest.mark.parametrize(
    ("scene", "given", "method"),
    [
        (FRICTION, {}, "deterministic"),
        (FRICTION, {"tol": 1e-5}, "deterministic"),
        (FRICTION, {"tol": 1e-2}, "monte_carlo"),  # 1 ms against a second
        (FRICTION, {"paths": 10}, "monte_carlo"),
        (FRICTION, {"order": 1}, "corrected"),
        (ns.Scene("friction", "hamiltonian"), {"tol": 0.1}, "monte_carlo"),
    ],
)
def test_method_follows_from_what_is_given(scene, given, method):
    """A tolerance, a number of paths or an order decides; the result names the method."""
    assert ns.crossing_probability(scene, 0.6, [1.0], **given).attrs["method"] == method
