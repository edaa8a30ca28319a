"""Shifted noise: exact weights whatever the shift is."""

from dataclasses import replace

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.paths.kernels.panel import FLUSH, new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tilted import poisson
from nonsmooth.paths.tilted.loop import (
    REACHED,
    SUMS,
    TOTAL_LOG_WEIGHT,
    march_tilted,
    march_tilted_pair,
)
from nonsmooth.paths.tilted.tilt import Aim
from nonsmooth.paths.time_loop import march
from references import FRICTION

SCENES = [
    FRICTION,
    ns.Scene("elasto_plastic", noise="hamiltonian", potential="x**2/2", n=np.inf),
    ns.Scene("obstacle", noise="langevin", potential="x**2/2"),
]
STEPS, STEP = 64, 0.05
NEVER = (-1e6, 1e6)


def tilt_of(scene, levels, seed=1):
    """Return a guide with random coefficients, which leads paths anywhere."""
    guide = poisson.fitted(scene, STEP, seed)
    rng = np.random.default_rng(seed)
    # so that each polynomial gives shifts of a size that the noise could make up for
    scale = guide.gamma ** np.array([[1], [1], [2], [3], [1]]) / 8
    wrong = scale * rng.normal(size=guide.coefficients.shape)
    wrong[0] = guide.coefficients[0]
    return replace(guide, coefficients=wrong).towards(Aim(1, levels, STEPS * STEP))


@pytest.mark.parametrize("steps", [1, 7])
@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.model)
def test_weights_have_the_mean_one(scene, steps):
    """E L = 1 for any shift, kept for any time; one run in 150,000 is 4.5 standard errors off."""
    levels = (-1.0, 1.0)
    tilt = tilt_of(scene, levels)._replace(kept=steps * STEP)
    s, weights = registry.coefficients(scene, "strang", STEP), []
    for block in range(8):
        panel = new_panel(scene, 2, block)
        march_tilted(s, panel, tilt, BLOCK, STEPS, 0.0, levels, 0, np.zeros(0))
        weights.append(np.exp(panel.total[TOTAL_LOG_WEIGHT, :BLOCK]))
    weights = np.concatenate(weights)
    assert weights.std() > 0.05  # the shift does something
    assert abs(weights.mean() - 1) < 4.5 * weights.std() / np.sqrt(weights.size)


def test_without_coefficients_paths_are_plain():
    """If nothing is shifted, int g of every path is that of the plain loop to the bit."""
    guide = poisson.fitted(FRICTION, STEP, 1)
    still = replace(guide, coefficients=np.zeros_like(guide.coefficients))
    tilt = still.towards(Aim(1, NEVER, STEPS * STEP))
    s = registry.coefficients(FRICTION, "strang", STEP)
    plain, tilted = new_panel(FRICTION, 3, 0), new_panel(FRICTION, 3, 0)
    march(s, plain, BLOCK, STEPS, *NEVER)
    assert march_tilted(s, tilted, tilt, BLOCK, STEPS, 0.0, NEVER, 0, np.zeros(SUMS)) == BLOCK
    assert np.array_equal(plain.total[0], tilted.total[0])
    assert not tilted.total[TOTAL_LOG_WEIGHT].any()


def test_dropped_paths_are_those_that_have_reached_a_level():
    """The sums of a run that drops paths are those of one that keeps them, to the last digits."""
    levels = (-1.2, 1.5)
    steps = 3 * FLUSH  # paths are dropped twice on the way
    # shifts that are kept belong to the paths that stay
    tilt = tilt_of(FRICTION, levels)._replace(kept=100 * STEP, end=(steps + 1) * STEP)
    s = registry.coefficients(FRICTION, "strang", STEP)
    kept = new_panel(FRICTION, 4, 0)
    march_tilted(s, kept, tilt, BLOCK, steps, 0.0, levels, 0, np.zeros(0))
    weights = np.exp(kept.total[TOTAL_LOG_WEIGHT, :BLOCK])
    for counted, there in (
        (1, kept.data[REACHED, :BLOCK] == 1),
        (0, kept.data[REACHED, :BLOCK] != 0),
    ):
        sums = np.zeros(SUMS)
        left = march_tilted(
            s, new_panel(FRICTION, 4, 0), tilt, BLOCK, steps, 0.0, levels, counted, sums
        )
        assert left == np.sum(kept.data[REACHED, :BLOCK] == 0)
        # additions in another order: a thousand roundings
        wanted = [there.sum(), weights[there].sum(), np.sum(weights[there] ** 2)]
        assert np.allclose(sums, wanted, rtol=1e-12)


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.model)
def test_pairs_share_their_noise(scene):
    """With the step and its half on the same shifted noise nearly all paths end alike."""
    levels = (-0.3, 0.3)
    tilt = tilt_of(scene, levels)
    fine = registry.coefficients(scene, "strang", STEP / 2)
    coarse = registry.on_given_increments(registry.coefficients(scene, "strang", STEP))
    panels = new_panel(scene, 5, 0), new_panel(scene, 5, 0)
    march_tilted_pair(fine, coarse, panels, tilt, BLOCK, STEPS, 0.0, levels)
    first, second = (panel.data[REACHED, :BLOCK] for panel in panels)
    assert 50 < np.sum(first != 0) < 1000
    # independent paths would differ in a tenth or more
    assert np.mean(first != second) < 0.06
    weights = np.exp(panels[0].total[TOTAL_LOG_WEIGHT, :BLOCK])
    assert abs(weights.mean() - 1) < 4.5 * weights.std() / np.sqrt(BLOCK)
