"""Formulas with poles, that are not real or that nobody can resolve are told from all others."""

import re
import time

import pytest

import nonsmooth as ns
from nonsmooth.scenes.formulas import parse
from nonsmooth.scenes.regularity import fault
from nonsmooth.scenes.symbols import STATE_VARIABLES


@pytest.mark.parametrize(
    ("formula", "place"),
    [
        ("1/y", "y = 0"),
        ("1/(y - 0.123456)", "y = 0.123"),
        ("1/(y - 0.123456)**2", "y = 0.123"),
        ("1/(y**2 - 2)", "y = -?1.41"),
        ("1/(y - 50.1)", "y = 50.1"),
        ("1/sqrt(abs(y))", "y = 0"),
        ("abs(y - 0.25)**(-0.6)", "y = 0.25"),
        ("sin(y)/cos(y)", "y = -?1.57"),
        ("1/(1 + cos(y))", "y = -?3.14"),
        ("y + 1e-6/(y - 0.5)", "y = 0.5"),
        ("1/(x - y)", "x = 0"),
        ("1/(x**2 + y**2)", "x = 0"),
        ("1/(y + x + eta + zeta)", "eta = 0"),
    ],
)
def test_poles_are_found(formula, place):
    """Wherever a denominator vanishes so fast that the square has no integral."""
    assert re.match(f"has a pole at {place}", fault(parse(formula, STATE_VARIABLES)))


@pytest.mark.parametrize(
    "formula",
    [
        "y",
        "log(abs(y))",
        "x + log(abs(y))",
        "abs(y)**(-0.4)",
        "1/(1 + y**2)",
        "y**3/(1 + y**2)",
        "sin(y)/y",
        "log(1 + y**2)",
        "abs(abs(y - 0.3) - 1e-9)",
        "tanh(1e4*(y - 0.2))",
        "sign(sin(50*y))",
        "sin(500*y)",
        "exp(exp(y))",
        "(1 - exp(-(y - 0.8)/0.01))**2",
        "max(0, y - 10)",
        "1e6 + y",
        "x*y*eta*zeta",
    ],
)
def test_others_are_left_alone(formula):
    """Kinks, jumps, steep slopes, growth and poles that can be integrated are no faults."""
    assert fault(parse(formula, STATE_VARIABLES)) is None


@pytest.mark.parametrize("formula", ["sqrt(y)", "log(y)", "sqrt(x*y - 1)"])
def test_complex_values_are_found(formula):
    """Roots and logarithms of negative numbers."""
    assert "is not a real number" in fault(parse(formula, STATE_VARIABLES))


@pytest.mark.parametrize("formula", ["sin(1e9*y)", "x + cos(1e6*y)", "sin(1/y)"])
def test_endless_oscillations_are_found(formula):
    """Whatever the frequency, although it is looked at in a few thousand points."""
    assert "up and down" in fault(parse(formula, STATE_VARIABLES))


@pytest.mark.parametrize("formula", ["exp(-((y - 0.3)/0.02)**2)", "exp(-((y - 3)/0.1)**2)"])
def test_narrow_peaks_are_of_a_moderate_size(formula):
    """Although they are tiny at the places that are looked at first."""
    ns.Scene("friction", observable=formula)


def test_tiny_formulas_are_refused():
    """A formula that is tiny everywhere would be lost in single precision."""
    with pytest.raises(ns.NonsmoothError, match="is of the size 5e-20 at states"):
        ns.Scene("friction", observable="1e-20*y")


def test_only_what_can_be_reached_counts():
    """At n = inf the displacement does not come to a pole behind the wall; at finite n it does."""
    ns.Scene("obstacle", n=float("inf"), observable="1/(x - 2)")
    with pytest.raises(ns.NonsmoothError, match="pole at x = 2"):
        ns.Scene("obstacle", n=100, observable="1/(x - 2)")


def test_it_is_quick():
    """A formula of four variables takes less than a second of a processor."""
    began = time.process_time()
    with pytest.raises(ns.NonsmoothError, match="pole"):
        ns.Scene("obstacle", "hamiltonian", observable="1/(x + 0.3*y - eta*zeta)")
    assert time.process_time() - began < 1
