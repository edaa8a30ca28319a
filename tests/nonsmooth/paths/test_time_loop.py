"""Paths with whole and halved steps side by side."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.paths.kernels.panel import ETA, ZETA, new_panel
from nonsmooth.paths.schemes.registry import coefficients, on_given_increments
from nonsmooth.paths.time_loop import march_pair


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
