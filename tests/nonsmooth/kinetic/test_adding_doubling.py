"""Slabs made by doubling: what they reflect and transmit."""

import numpy as np
import pytest

from nonsmooth.kinetic.adding_doubling import slab
from references import COLORED_FRICTION, OBSTACLE, PLASTIC_STRAIN
from support import coarse_ordinates


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene", [COLORED_FRICTION, PLASTIC_STRAIN, OBSTACLE], ids=["friction", "plastic", "obstacle"]
)
def test_is_passive_and_conserves(scene):
    """Constants are lost at the rate z only: 1 - (R + S) 1 is of the order z."""
    grid = coarse_ordinates(scene)
    for z in (1e-6, 1e-8):
        made = slab(grid, z, 1.0, 8)
        ones = grid.ones[: len(grid.speeds)]
        lost = ones - (made.reflection + made.transmission) @ ones
        assert np.max(np.abs(lost)) < 1e3 * z + 1e-9
