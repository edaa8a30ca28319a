"""A few ordinates in place of many: against exact modes, limits, and all ordinates."""

import math

import numpy as np
import pytest
import scipy.sparse as sp

import nonsmooth as ns
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import case_modes
from nonsmooth.kinetic.bases.fields import fields
from nonsmooth.kinetic.bases.reduced_ordinates import Fields, joined, reduced, unreduced
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates, boxed, plane_ordinates
from nonsmooth.kinetic.tuning import PlaneLevel
from references import COLORED_FRICTION, FRICTION, OBSTACLE, PLASTIC_STRAIN
from slabs import scattered, slab
from support import coarse_ordinates

SCENES = {"friction": COLORED_FRICTION, "plastic": PLASTIC_STRAIN, "obstacle": OBSTACLE}


def basis(grid, thickness, accuracy=1e-8, thin=0.005, halves=slice(1)):
    """Few ordinates for rates between a thousandth of and ten times that of relaxation."""
    found = [
        field
        for z in 10.0 ** np.arange(-3, 1.1)
        for field in fields(grid, z, thickness, thin * grid.way, 0.5, 3)[halves]
    ]
    return reduced(grid, joined(found), accuracy, math.sqrt(accuracy))


def passage(ordinates, z, lower, upper):
    """Transform of the first passage out of one interval."""
    return ordinates.first_passage(z, np.array([[lower, upper]]))[0]


@pytest.fixture(scope="module")
def line():
    """Ordinates of dry friction with white noise, whose modes are exact."""
    return ordinates(FRICTION, 6, 1.0)


def of_one_variable(line):
    """Write the grid of a scene with one variable as if it had two."""
    moving = line.moving
    order = np.append(moving, np.delete(np.arange(len(line.g)), moving))
    generator, start = {}, {}
    for parity in (ODD, EVEN):
        kept = moving if parity == ODD else order  # odd functions are 0 at the origin
        matrix = -line.stiffness[parity] / line.masses[:, None]
        generator[parity] = sp.csc_array(matrix[np.ix_(kept, kept)])
        start[parity] = line.start[parity][kept]
    way = np.sqrt(line.masses @ line.g**2)
    masses = line.masses[moving]
    return PlaneOrdinates(line.g[moving], masses, np.ones(len(order)), way, generator, start)


class TestReducedOrdinates:
    """The transform on few ordinates."""

    @pytest.mark.parametrize("levels", [(-2.0, 2.0), (-1.0, 2.0), (-np.inf, 1.0), (-1.0, np.inf)])
    def test_agrees_with_the_modes_of_one_variable(self, line, levels):
        """At z none of which made the basis, real and complex, to what the basis leaves out.

        A solution lacks parts of the relative size 1e-8; the transform adds up some ten modes, and
        the change of a basis that is ten times as coarse shows what they make of it.
        """
        grid, thickness = of_one_variable(line), levels[1] - levels[0]
        fine, coarse = (basis(grid, thickness, accuracy) for accuracy in (1e-8, 1e-7))
        for z in (0.02, 0.5, 0.3 + 2.0j):
            exact = case_modes.modes(line, z).first_passage(*levels)
            found, change = (passage(made, z, *levels) for made in (fine, coarse))
            assert abs(found - exact) <= 3 * abs(found - change) + 1e-7
            assert abs(found - exact) < 1e-5

    @pytest.mark.slow
    def test_an_error_is_the_product_of_what_is_left_out(self):
        """Solutions at two z leave up to 2e-5 at others, adjoint ones 1e-4, and both far less.

        The product is 2e-9, of relative errors in norms that are larger; a hundredth of the less of
        both is asked for.
        """
        grid, end, accuracy = coarse_ordinates(COLORED_FRICTION), 1.0, 1e-7
        found = joined([fields(grid, z, 2 * end, 2e-3 * grid.way, end)[0] for z in (0.1, 1.0)])
        one = grid.ones[: len(grid.speeds), None]
        both, solutions, adjoint = (
            reduced(grid, made, accuracy, accuracy)
            for made in (found, Fields(found.solutions, one), Fields(one, found.adjoint))
        )
        every = unreduced(grid)
        for z in (0.03, 0.3, 0.2 + 0.9j):
            exact = passage(every, z, -end, end)
            left, *alone = (
                abs(passage(made, z, -end, end) - exact) for made in (both, solutions, adjoint)
            )
            assert left < min(alone) / 100

    @pytest.mark.parametrize("first", [0, 1, 2])
    def test_halves_of_a_longer_interval_make_a_basis(self, line, first):
        """Of one that is longer and one that is shorter; errors as for an interval alone."""
        shares = np.array([[-1.0, 1.0], [-0.8, 0.7], [-0.5, 0.9], [-0.5, 0.5]])
        grid, intervals, halves = of_one_variable(line), shares / 2**first, slice(first, first + 2)
        fine, coarse = (basis(grid, 2.0, accuracy, halves=halves) for accuracy in (1e-8, 1e-7))
        for z in (0.02, 0.5, 0.3 + 2.0j):
            exact = [case_modes.modes(line, z).first_passage(*levels) for levels in intervals]
            found, change = (made.first_passage(z, intervals) for made in (fine, coarse))
            assert np.all(np.abs(found - exact) <= 3 * np.abs(found - change) + 1e-7)
            assert np.all(np.abs(found - exact) < 1e-5)

    @pytest.mark.slow
    @pytest.mark.parametrize("name", SCENES)
    def test_agrees_with_all_ordinates(self, name):
        """Slabs of all ordinates give the same at a complex z, to the error of the slabs.

        They are of second order where h changes little, and of a lower one where g is small. The
        change to slabs twice as thick, over sqrt(2) - 1, bounds an error of the order 1/2 or more.
        """
        grid, z, end = coarse_ordinates(SCENES[name]), 0.1 + 0.2j, 1.0
        row, ones = scattered(grid, z, EVEN)[1], grid.ones[: len(grid.speeds)]
        doublings = math.ceil(math.log2(end / grid.way)) + 10
        found = []
        for more in (0, 1):
            reflection, transmission = slab(grid, z, end, doublings + more)
            inside = np.eye(len(ones)) - reflection
            found.append(row @ np.linalg.solve(inside, transmission @ ones))
        few = passage(basis(grid, 2 * end), z, -end, end)
        assert abs(few - found[1]) < abs(found[1] - found[0]) / (math.sqrt(2) - 1) + 2e-6

    @pytest.mark.slow
    @pytest.mark.parametrize("name", SCENES)
    def test_exits_surely(self, name):
        """(1 - h) / z increases to the mean exit time as z falls, so that exit is certain.

        Its change is z E tau^2 / 2, which is z (E tau)^2 for an exponential time, and less here.
        """
        few = basis(coarse_ordinates(SCENES[name]), 0.6)
        mean = [(1 - passage(few, z, -0.3, 0.3).real) / z for z in (1e-2, 1e-3, 1e-4)]
        assert 0 < mean[0] < mean[1] < mean[2]
        assert mean[2] == pytest.approx(mean[1], rel=1e-3 * mean[2])

    @pytest.mark.slow
    def test_fast_noise_is_white(self):
        """Ornstein-Uhlenbeck noise of the rate theta = sigma is white up to 1/theta.

        The ratio 4 of the distances is met to a third, for the next order.
        """
        level, z = 0.6 * np.sqrt(10), 0.1
        exact = case_modes.modes(ordinates(FRICTION, 9, 1.0), z).first_passage(-level, level).real
        gap = []
        for theta in (10.0, 40.0):
            scene = ns.Scene("friction", ns.OrnsteinUhlenbeck(theta, theta))
            level_of_grid = PlaneLevel(5, (5, 9.0), (11, ()), 4, 8.0, 0.03, 1e-6)
            grid = plane_ordinates(scene, boxed(scene), level_of_grid, 10.0)
            few = basis(grid, 2 * level, 1e-7, 0.02)
            gap.append(exact - passage(few, z, -level, level).real)
        assert gap[0] / gap[1] == pytest.approx(4, rel=1 / 3)

    @pytest.mark.slow
    def test_one_wall_far_away_is_none(self):
        """A wall that is never reached changes nothing but the basis."""
        grid, z = coarse_ordinates(PLASTIC_STRAIN), 1.0
        far = passage(basis(grid, 40.3), z, -40.0, 0.3)
        assert far == pytest.approx(passage(basis(grid, np.inf), z, -np.inf, 0.3), abs=2e-6)
