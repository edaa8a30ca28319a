"""Paths with whole and halved steps side by side."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.paths.kernels.panel import ETA, FLUSH, TOTAL_DELTA, ZETA, new_panel
from nonsmooth.paths.schemes.registry import coefficients, on_given_increments
from nonsmooth.paths.time_loop import (
    EVERYWHERE,
    march,
    march_and_sum,
    march_pair,
    march_pair_and_sum,
)

FRICTION = ns.Scene("friction")
LANES = 99  # no multiple of the lanes that are summed together
ROUNDING = LANES * np.finfo(float).eps  # of a sum, relative to that of the absolute values


def products(*rows):
    """Sum the products of 1 and the rows over the lanes, and those of their absolute values."""
    vector = np.vstack([np.ones(LANES), *rows])
    return vector @ vector.T, np.abs(vector) @ np.abs(vector).T


@pytest.mark.parametrize("noise", [ns.OrnsteinUhlenbeck(2.0, 0.5), ns.KanaiTajimi(2.0, 0.5)])
def test_halved_steps_run_on_the_same_path(noise):
    """Two half increments join to the full one: exact for the linear noises."""
    scene = ns.Scene("obstacle", noise, observable="eta")
    fine, coarse = (coefficients(scene, "strang", h, "float64") for h in (0.1, 0.2))
    panels = [new_panel(scene, 1, 0, "float64") for _ in range(2)]
    passage = np.full((2, 100), np.inf)
    march_pair(fine, on_given_increments(coarse), *panels, 100, 7, -np.inf, np.inf, 0.0, passage)
    noises = [panel.data[[ZETA, ETA], :100] for panel in panels]
    assert np.std(noises[0][1]) > 0.1
    assert np.allclose(*noises, rtol=0, atol=1e-12)


@pytest.mark.parametrize("joined", [False, True])
@pytest.mark.parametrize("steps", [5, FLUSH + 1])
def test_sums_are_those_of_the_paths(steps, joined):
    """Short intervals in one kernel and long ones of their own give the paths' products."""
    s = coefficients(FRICTION, "strang", 0.1, "float64")
    panels = [new_panel(FRICTION, 1, 0, "float64") for _ in range(2)]
    sums = np.zeros((3, 5, 5))
    march_and_sum(s, panels[0], LANES, steps, sums, joined)
    for found in sums:
        march(s, panels[1], LANES, steps, *EVERYWHERE)
        delta, martingale, variation = panels[1].total[:, :LANES]
        expected, size = products(delta, delta**2, martingale, martingale**2 - variation)
        assert np.all(np.abs(found - expected) <= ROUNDING * size)


@pytest.mark.parametrize("joined", [False, True])
@pytest.mark.parametrize("steps", [5, FLUSH + 1])
def test_sums_of_changes_are_those_of_the_pairs(steps, joined):
    """So do pairs of paths, and their passages are timed the same."""
    fine, coarse = (coefficients(FRICTION, "strang", h, "float64") for h in (0.1, 0.2))
    pair, levels, span = (fine, on_given_increments(coarse)), (-0.5, 0.5), 0.2 * steps
    panels = [new_panel(FRICTION, 1, 0, "float64") for _ in range(4)]
    passages = [np.full((2, LANES), np.inf) for _ in range(2)]
    sums = np.zeros((3, 4, 4))
    march_pair_and_sum(
        *pair, *panels[:2], LANES, steps, levels, 0.0, span, passages[0], sums, joined
    )
    for k, found in enumerate(sums):
        march_pair(*pair, *panels[2:], LANES, steps, *levels, k * span, passages[1])
        half, whole = (panel.total[TOTAL_DELTA, :LANES] for panel in panels[2:])
        expected, size = products(whole - half, whole**2 - half**2, half)
        assert np.all(np.abs(found - expected) <= ROUNDING * size + ROUNDING)
    if joined:  # one flow rounds in another way than two halves
        assert np.allclose(*passages, rtol=0, atol=1e-12)
    else:
        assert np.array_equal(*passages)
    assert np.any(np.isfinite(passages[0]))
