"""Solutions at many depths, by modes and by doubling: against slabs, each other, and in halves."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import nonsmooth as ns
from nonsmooth.crossing.first_passage.plane import SharedGrids
from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic.bases import doubled_slabs, fields
from nonsmooth.kinetic.bases.reduced_ordinates import joined, reduced
from nonsmooth.kinetic.ordinates_plane import UnstableError
from references import COLORED_FRICTION, OBSTACLE, PLASTIC_STRAIN
from slabs import scattered, slab
from support import coarse_ordinates

SOLVERS = pytest.mark.parametrize("solver", [fields, doubled_slabs], ids=["modes", "doubled"])
SCENES = {"friction": COLORED_FRICTION, "plastic": PLASTIC_STRAIN, "obstacle": OBSTACLE}


def size(grid, values):
    """Norm in which a basis is chosen, over that of constants."""
    flow = np.sqrt(grid.masses * np.abs(grid.speeds))
    return np.linalg.norm(flow * values) / np.linalg.norm(flow * grid.ones[: len(flow)])


def near_face(found):
    """Values where the flow enters and where it leaves, at the least depth."""
    return found[:, found.shape[1] // 2], found[:, 0]


def middle(found):
    """Values where the flow enters or leaves, which are the same there."""
    return found[:, found.shape[1] // 2 - 1]


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("z", [0.02, 2.0])
@SOLVERS
def test_faces_are_those_of_slabs(solver, name, z):
    """What a face sends back, as from slabs of implicit Euler steps, whose error is measured.

    The least depth is so small that h hardly differs from that at the face. Slabs are of second
    order where h changes little, and of a lower one where g is small. The change to slabs twice as
    thick, over sqrt(2) - 1, bounds an error of the order 1/2 or more.
    """
    grid, thickness = coarse_ordinates(SCENES[name]), 1.5
    ones = grid.ones[: len(grid.speeds)]
    back, given = near_face(solver.fields(grid, z, thickness, 1e-9, 1.0)[0].solutions)
    coarse, fine = (sum(slab(grid, z, thickness, count)) @ ones for count in (11, 12))
    assert size(grid, given - ones) < 1e-5
    assert size(grid, back - fine) < size(grid, fine - coarse) / (np.sqrt(2) - 1) + 1e-7


@pytest.mark.slow
@SOLVERS
def test_a_thick_slab_is_a_half_space(solver):
    """What its face sends back, but for what differs between depths of 1e-9."""
    grid = coarse_ordinates(COLORED_FRICTION)
    thick, half = (
        solver.fields(grid, 1.0, thickness, 1e-9, 1.0)[0].solutions for thickness in (160.0, np.inf)
    )
    assert size(grid, near_face(thick)[0] - near_face(half)[0]) < 1e-5


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
@SOLVERS
def test_the_adjoint_solution_tells_the_value_at_the_start(solver, name):
    """By what it is at the faces, where the flow leaves and h is 1; halfway between them.

    The last of its depths is so near to a face that it hardly differs from that there.
    """
    grid, z = coarse_ordinates(SCENES[name]), 0.3
    found = solver.fields(grid, z, 1.5, 1e-9, 1.0)[0]
    value = scattered(grid, z, EVEN)[1] @ middle(found.solutions)
    weights = grid.masses * np.abs(grid.speeds) * grid.ones[: len(grid.speeds)]
    assert weights @ found.adjoint[:, -1] == pytest.approx(value, abs=1e-5)
    assert 0.01 < value < 0.9


@SOLVERS
def test_halves_are_solved_too(solver):
    """Bit for bit: the same modes, or slabs made on the way, serve them as each alone."""
    grid = coarse_ordinates(COLORED_FRICTION)
    thicknesses = 2.0 ** np.array([9, 8, 7]) * grid.way
    alone = [solver.fields(grid, 1e-3, thickness, grid.way, 1.0)[0] for thickness in thicknesses]
    halves = solver.fields(grid, 1e-3, thicknesses[0], grid.way, 1.0, 2)
    for half, same in zip(halves, alone, strict=True):
        assert np.array_equal(half.solutions, same.solutions)
        assert np.array_equal(half.adjoint, same.adjoint)


@SOLVERS
def test_solutions_that_grow_are_seen(solver):
    """A generator that makes functions grow is no result."""
    grid = coarse_ordinates(COLORED_FRICTION)
    growing = {p: A + 40 * sp.eye_array(A.shape[0]) for p, A in grid.generator.items()}
    with pytest.raises(UnstableError, match="amplify by"):
        solver.fields(replace(grid, generator=growing), 0.1, 4.0, 0.02 * grid.way, 1.0)


@pytest.mark.parametrize("name", SCENES)
def test_both_agree_in_the_middle_but_for_rounding(name):
    """The estimate is the rounding of the strengths alone; a thousand times as much is allowed.

    What rounding makes of the fastest modes changes transforms by 2e-7 (docs/methods/kinetic.md),
    so that five times as much is. The first of the doubled slabs is so thin that its fraction is
    exact to 1e-9.
    """
    grid, z, thickness = coarse_ordinates(SCENES[name]), 0.5, 2.0
    by_modes, doubled = (
        middle(solver.fields(grid, z, thickness, 1e-4 * grid.way, 1.0)[0].solutions)
        for solver in (fields, doubled_slabs)
    )
    allowed = 1e3 * fields.rounding(grid, z, thickness) + 1e-6
    assert size(grid, by_modes - doubled) < allowed < 1e-4


@pytest.mark.slow
def test_doubling_keeps_bases_small_where_modes_are_nearly_parallel():
    """Rounding is seen on the coarsest grid, and on a finer one it makes half of a basis."""
    scene = ns.Scene("elasto_plastic", potential="x**2/2", n=2)
    grids, others = (
        SharedGrids(one, np.array([[-1.0, 1.0]]), np.array([8.0]))
        for one in (scene, COLORED_FRICTION)
    )
    assert grids.nearly_parallel
    assert not others.nearly_parallel
    coarse, fine = (grids.ordinates(level, level, 0) for level in (0, 2))
    assert fine.basis.shape[1] < 1.5 * coarse.basis.shape[1]
    depth, shifts = 0.02 * fine.grid.way, (0.4, 0.6, 0.9, 1.2)
    by_modes, doubled = (
        joined([solver.fields(fine.grid, z, 2.0, depth, 1.0)[0] for z in shifts])
        for solver in (fields, doubled_slabs)
    )
    sizes = [reduced(fine.grid, found, 1e-7, 1e-3).basis.shape[1] for found in (by_modes, doubled)]
    assert sizes[1] < 0.7 * sizes[0]
