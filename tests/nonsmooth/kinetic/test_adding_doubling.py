"""Slabs made by doubling: what they reflect and transmit, and the solutions inside of them."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
import scipy.sparse as sp

from nonsmooth.kinetic.adding_doubling import fields, slabs
from nonsmooth.kinetic.ordinates_plane import UnstableError
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
        *_, made = islice(slabs(grid, z, 1 / 256), 9)
        ones = grid.ones[: len(grid.speeds)]
        lost = ones - (made.reflection + made.transmission) @ ones
        assert np.max(np.abs(lost)) < 1e3 * z + 1e-9


@pytest.mark.slow
def test_fields_in_a_thick_slab_are_those_of_a_half_space():
    """What its face sends back, but for what is taken to be opaque: 1e-4 of the values."""
    grid = coarse_ordinates(COLORED_FRICTION)
    thin = 0.02 * grid.way
    thick, half = (fields(grid, 1.0, size, thin)[0] for size in (2**13 * thin, np.inf))
    assert thick[:, 1] == pytest.approx(half[:, 1], abs=2e-4)


def test_halves_are_solved_too():
    """Bit for bit: the slabs of a half are among those of the whole."""
    grid = coarse_ordinates(COLORED_FRICTION)
    thin = 0.5 * grid.way
    thicknesses = 2.0 ** np.array([9, 8, 7]) * thin
    alone = [fields(grid, 1e-3, thickness, thin)[0] for thickness in thicknesses]
    halves = fields(grid, 1e-3, thicknesses[0], thin, 2)
    assert all(np.array_equal(*pair) for pair in zip(halves, alone, strict=True))


def test_slabs_that_amplify_are_seen():
    """A generator that makes functions grow is no result."""
    grid = coarse_ordinates(COLORED_FRICTION)
    growing = {p: A + 40 * sp.eye_array(A.shape[0]) for p, A in grid.generator.items()}
    with pytest.raises(UnstableError, match="amplify by"):
        fields(replace(grid, generator=growing), 0.1, 4.0, 0.02 * grid.way)
