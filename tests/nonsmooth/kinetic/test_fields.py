"""Solutions at many depths: against slabs, in half spaces and in halves."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from nonsmooth.kinetic.doubled_slabs import fields
from nonsmooth.kinetic.ordinates_plane import UnstableError
from references import COLORED_FRICTION, OBSTACLE, PLASTIC_STRAIN
from slabs import slab
from support import coarse_ordinates

SCENES = {"friction": COLORED_FRICTION, "plastic": PLASTIC_STRAIN, "obstacle": OBSTACLE}


def size(grid, values):
    """Norm in which a basis is chosen, over that of constants."""
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    return np.linalg.norm(flow * values) / np.linalg.norm(flow * grid.ones[: len(flow)])


def near_face(found):
    """Values where the flow enters and where it leaves, at the least depth."""
    return found[:, found.shape[1] // 2], found[:, 0]


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("z", [0.02, 2.0])
def test_faces_are_those_of_slabs(name, z):
    """What a face sends back, as from slabs of implicit Euler steps, whose error is measured.

    The least depth is so small that h hardly differs from that at the face. Slabs are of second
    order where h changes little, and of a lower one where g is small. The change to slabs twice as
    thick, over sqrt(2) - 1, bounds an error of the order 1/2 or more.
    """
    grid, thickness = coarse_ordinates(SCENES[name]), 1.5
    ones = grid.ones[: len(grid.speeds)]
    back, given = near_face(fields(grid, z, thickness, 1e-9)[0])
    coarse, fine = (sum(slab(grid, z, thickness, count)) @ ones for count in (11, 12))
    assert size(grid, given - ones) < 1e-5
    assert size(grid, back - fine) < size(grid, fine - coarse) / (np.sqrt(2) - 1) + 1e-7


@pytest.mark.slow
def test_a_thick_slab_is_a_half_space():
    """What its face sends back, but for what differs between depths of 1e-9."""
    grid = coarse_ordinates(COLORED_FRICTION)
    thick, half = (fields(grid, 1.0, thickness, 1e-9)[0] for thickness in (160.0, np.inf))
    assert size(grid, near_face(thick)[0] - near_face(half)[0]) < 1e-5


def test_halves_are_solved_too():
    """Bit for bit: slabs made on the way serve them as each alone."""
    grid = coarse_ordinates(COLORED_FRICTION)
    thicknesses = 2.0 ** np.array([9, 8, 7]) * grid.way
    alone = [fields(grid, 1e-3, thickness, grid.way)[0] for thickness in thicknesses]
    halves = fields(grid, 1e-3, thicknesses[0], grid.way, 2)
    for both in zip(halves, alone, strict=True):
        assert np.array_equal(*both)


def test_solutions_that_grow_are_seen():
    """A generator that makes functions grow is no result."""
    grid = coarse_ordinates(COLORED_FRICTION)
    growing = {p: A + 40 * sp.eye_array(A.shape[0]) for p, A in grid.generator.items()}
    with pytest.raises(UnstableError, match="amplify by"):
        fields(replace(grid, generator=growing), 0.1, 4.0, 0.02 * grid.way)
