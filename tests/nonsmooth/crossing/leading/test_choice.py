"""The choice between counting paths and leading them."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.crossing import probability
from nonsmooth.crossing.leading.choice import leading_is_quicker
from nonsmooth.errors import ToleranceError

SCENE = ns.Scene("friction", noise="hamiltonian")
TOLERANCES = np.geomspace(1e-1, 1e-9, 9)


def chosen(b, tol, horizons=(2.0,)):
    """Ask for one threshold at p = 10."""
    return leading_is_quicker(SCENE, np.array([[-b, b]]), np.array(horizons), 10.0, tol)


@pytest.mark.parametrize("b", [0.3, 0.9, 1.5])
def test_a_looser_tolerance_never_needs_led_paths_where_a_tighter_one_does_not(b):
    """Once paths are led they are led for all tighter tolerances."""
    found = [chosen(b, tol) for tol in TOLERANCES]
    assert found == sorted(found)


def test_rare_crossings_are_led_and_frequent_ones_counted():
    """W is about 0.4 and 1e-6; to 1e-3 and to 1e-7."""
    assert not chosen(0.3, 1e-3)
    assert chosen(1.5, 1e-7)


def test_loose_tolerances_are_counted_at_once():
    """Ten million steps take no time, and no pilot is run."""
    assert not chosen(1.5, 1e-2)


def test_integrals_that_stay_bounded_are_counted():
    """With g = y between obstacles int g does not spread."""
    scene = ns.Scene("obstacle", potential="x**2/2", observable="y")
    assert not leading_is_quicker(scene, np.array([[-1.0, 1.0]]), np.array([1.0]), 1.0, 1e-9)


def test_led_paths_win_at_moderate_probabilities():
    """W is about 0.06 at p = 100, to 1e-3: a million paths are counted, or 10^5 led."""
    scene = ns.Scene("obstacle", "langevin", potential="x**2/2", observable="x")
    levels = np.array([[-2.5, 2.5]])
    assert leading_is_quicker(scene, levels, np.array([2.0]), 100.0, 1e-3)


def test_paths_are_counted_where_leading_is_refused(monkeypatch):
    """The choice is a prediction, and counting meets any tolerance that takes minutes."""

    def refused(scene, thresholds, horizons, p, seed, threads, tol=1e-2):
        raise ToleranceError("few paths carry the weight")

    monkeypatch.setattr(probability, "leading_is_quicker", lambda *request: True)
    monkeypatch.setitem(probability.METHODS, "importance_sampling", refused)
    found = ns.crossing_probability(SCENE, 0.3, [2.0], p=10.0, tol=0.05)
    assert found.attrs["method"] == "monte_carlo"
    assert found["probability_error"] < 0.05


def test_fits_that_would_take_too_long_are_not_tried():
    """Paths of a hardly damped structure take long to relax; they are counted."""
    scene = ns.Scene("friction", "hamiltonian", damping=1e-4)
    levels = np.array([[-1.5, 1.5]])
    assert not leading_is_quicker(scene, levels, np.array([2.0]), 10.0, 1e-7)
