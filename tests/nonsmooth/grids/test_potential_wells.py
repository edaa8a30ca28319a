"""Scenes that mix slowly: right as long as they are solved at all, and refused beyond."""

from dataclasses import replace

import numpy as np
import pytest

import nonsmooth as ns
from exact_gamma2 import langevin_gamma2
from nonsmooth.errors import ToleranceError
from nonsmooth.grids import potential_wells, tuning
from nonsmooth.statistics import tuning as statistics_tuning
from references import FRICTION


@pytest.mark.parametrize("barrier", [0.5, 2.0, pytest.param(8.0, marks=pytest.mark.slow)])
def test_the_forcing_may_mix_slowly(barrier):
    """Friction under an eta with two wells: what resists has the gamma^2 of the forcing.

    It is 2e4 for a barrier of 8 kT; kT = 1/2.
    """
    depth = np.sqrt(2 * barrier)
    noise = ns.Langevin(f"eta**4/4 - {depth}*eta**2/2")
    scene = ns.Scene("friction", noise, n=20, observable="y + max(min(20*y, 1), -1)")
    found = ns.asymptotic_variance(scene, tol=1e-4)
    value, error = langevin_gamma2(noise)
    assert abs(found.value - value) <= found.error + error
    assert found.error <= 1e-4 * found.value


def test_rate_of_jumps_between_two_wells():
    """gamma^2 of the displacement is Kramers', which neglects terms of the order kT / barrier."""
    barrier, damping, temperature = 4.0, 3.0, 0.5
    noise = ns.White(np.sqrt(2 * damping * temperature))
    potential = f"{barrier}*(x**2 - 1)**2"
    # an obstacle too soft to be felt
    scene = ns.Scene("obstacle", noise, 1e-9, damping, potential, "x")
    found = ns.asymptotic_variance(scene, tol=1e-3)
    well, top = np.sqrt(8 * barrier), np.sqrt(4 * barrier)
    escape = (np.hypot(damping / 2, top) - damping / 2) / top * well / (2 * np.pi)
    escape *= np.exp(-barrier / temperature)
    # the sign of x flips at twice the rate of escape: gamma^2 = 2 / (2 escape)
    assert found.value == pytest.approx(1 / escape, rel=temperature / barrier)


def test_a_rate_that_is_out_of_reach_is_refused(monkeypatch):
    """A barrier of 30 kT, one transition in 1e12, is refused; the message says so."""
    monkeypatch.setattr(tuning, "TENSOR_GRIDS", replace(tuning.TENSOR_GRIDS, largest={2: 10_000}))
    scene = ns.Scene("obstacle", potential="x**2/2 + 15*exp(-4*x**2)", observable="x")
    with pytest.raises(ToleranceError, match=r"mixes slowly, g stays correlated for some \de\+"):
        ns.asymptotic_variance(scene, tol=1e-3)


def test_paths_that_never_leave_their_well_are_refused(monkeypatch):
    """From x = -1 the variance within one well settles, and at 16 kT all stay there."""
    few = replace(statistics_tuning.SAMPLED_GAMMA2, doublings=2)
    monkeypatch.setattr(statistics_tuning, "SAMPLED_GAMMA2", few)
    scene = ns.Scene(
        "obstacle", potential="x**2/2 + 8*exp(-4*x**2)", observable="x", start={"x": -1.0}
    )
    with pytest.raises(ToleranceError, match=r"2 wells .* mixes slowly"):
        ns.asymptotic_variance(scene, tol=0.1, method="monte_carlo")


def test_wells_and_what_is_none():
    """Each well has a start; a ripple below 2 kT or a slope one way makes no well."""
    double = ns.Langevin("eta**4/4 - 2*eta**2")
    assert potential_wells.starts(FRICTION) == [{}]
    found = potential_wells.starts(ns.Scene("friction", double, potential="x**2/2", observable="x"))
    assert [point["eta"] for point in found] == pytest.approx([-2, 2], abs=0.01)
    assert [point["x"] for point in found] == pytest.approx([0, 0], abs=0.01)
    rippled = ns.Scene("obstacle", potential="x**2/2 + 0.05*cos(3*x)", observable="x")
    assert len(potential_wells.starts(rippled)) == 1
    pressed = ns.Scene("obstacle", n=np.inf, potential="x**2/2 - 2*x", observable="x")
    assert potential_wells.starts(pressed) == [{"x": 1.0}]
    between = ns.Scene("obstacle", n=np.inf, potential="x**2/2 + 8*exp(-x**2)", observable="x")
    assert potential_wells.starts(between) == [{"x": -1.0}, {"x": 1.0}]
