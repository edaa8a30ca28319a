"""First passage for two state variables by doubling slabs."""

import numpy as np
import pytest
import scipy.sparse as sp

import nonsmooth as ns
from nonsmooth.crossing.first_passage import plane, tuning
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import case_modes
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates, boxed, plane_ordinates
from references import COLORED_FRICTION, FRICTION, OBSTACLE, PLASTIC_STRAIN
from support import coarse_ordinates

SCENES = {
    "friction": (COLORED_FRICTION, 0.3),
    "plastic": (PLASTIC_STRAIN, 0.3),
    "obstacle": (OBSTACLE, 0.8),
}


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
    return PlaneOrdinates(line.g[moving], np.ones(len(order)), way, 0, generator, start)


class TestSlab:
    """Doubling against what is known of slabs."""

    @pytest.mark.parametrize("z", [0.02, 0.5, 0.3 + 2.0j])
    @pytest.mark.parametrize("levels", [(-2.0, 2.0), (-1.0, 2.0), (-np.inf, 1.0), (-1.0, np.inf)])
    def test_agrees_with_the_modes_of_one_variable(self, z, levels):
        """On the grid of one variable, whose modes are exact, the stated error holds.

        Slabs of half the thickness show the error. It is of an order of at least 0.6, since speeds
        go down to 0, and so at most twice the difference.
        """
        line = ordinates(FRICTION, 6, 1.0)
        exact = case_modes.first_passage(line, z, *levels)
        grid = of_one_variable(line)
        coarse, fine = (plane.first_passage(grid, z, *levels, resolution=r) for r in (1, 2))
        assert abs(fine - exact) <= 2 * abs(fine - coarse) + 1e-9
        assert abs(fine - exact) < tuning.PLANE.default_tolerance / 5

    @pytest.mark.slow
    @pytest.mark.parametrize("name", SCENES)
    def test_exits_surely(self, name):
        """(1 - h) / z increases to the mean exit time as z falls, so that exit is certain."""
        scene, level = SCENES[name]
        grid = coarse_ordinates(scene)
        mean = [
            (1 - plane.first_passage(grid, z, -level, level, 1)) / z for z in (1e-2, 1e-4, 1e-6)
        ]
        assert 0 < mean[0] < mean[1] < mean[2]
        assert mean[2] == pytest.approx(mean[1], rel=1e-4 * mean[2] + 1e-3)

    @pytest.mark.slow
    def test_fast_noise_is_white(self):
        """Ornstein-Uhlenbeck noise of the rate theta = sigma is white up to 1/theta.

        The ratio 4 of the distances is met to a third, for the next order.
        """
        level, z = 0.6 * np.sqrt(10), 0.1
        white = ordinates(FRICTION, 9, 1.0)
        exact = case_modes.first_passage(white, z, -level, level).real
        gap = []
        for theta in (10.0, 40.0):
            scene = ns.Scene("friction", ns.OrnsteinUhlenbeck(theta, theta))
            grid = plane_ordinates(scene, boxed(scene), 1, 10.0)
            gap.append(exact - plane.first_passage(grid, z, -level, level, 1))
        assert gap[0] / gap[1] == pytest.approx(4, rel=1 / 3)

    def test_one_wall_far_away_is_none(self):
        """A wall that is never reached changes nothing."""
        grid, z = coarse_ordinates(PLASTIC_STRAIN), 1.0
        far = plane.first_passage(grid, z, -40.0, 0.3, 0)
        assert far == pytest.approx(plane.first_passage(grid, z, -np.inf, 0.3, 0), abs=1e-6)


@pytest.mark.slow
class TestCrossing:
    """The inverted transform against what does not use it."""

    @pytest.mark.parametrize(
        ("name", "paths", "p"),
        [
            ("friction", 4000, 3),
            ("plastic", 2000, 3),
            ("obstacle", 20000, 3),
            ("obstacle", 2000, 300),  # so long that it is not marched
        ],
    )
    def test_agrees_with_monte_carlo(self, name, paths, p):
        """Both agree within 4.5 standard errors and the step's bias; false alarms 3e-5 in all."""
        scene, level = SCENES[name]
        horizons = [2.0]
        found = ns.crossing_probability(scene, level, horizons, p, method="deterministic", tol=2e-3)
        assert np.all(found.probability_error < 2e-3)
        sample = ns.crossing_probability(scene, level, horizons, p, step=0.02, paths=paths, seed=7)
        allowed = 4.5 * sample.standard_error + np.abs(sample.step_bias)
        allowed += 4.5 * sample.step_bias_error + found.probability_error
        assert np.all(np.abs(found.probability - sample.probability) < allowed)
