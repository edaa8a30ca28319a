"""The choice between counting paths and leading them."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.crossing.leading.choice import leading_is_quicker

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
