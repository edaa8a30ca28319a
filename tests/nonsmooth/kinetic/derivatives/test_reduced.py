"""Derivatives for two variables are those of the discrete equations, and of the scenes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from nonsmooth.central_differences import central
from nonsmooth.grids.generator import Change
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic.bases.fields import fields
from nonsmooth.kinetic.bases.reduced_ordinates import joined, reduced, unreduced
from nonsmooth.kinetic.derivatives.reduced import differentiated
from nonsmooth.sensitivity.parameters import PARAMETERS, change, value_of
from references import COLORED_FRICTION, OBSTACLE, PLASTIC_STRAIN
from support import coarse_ordinates

SCENES = {
    "friction": COLORED_FRICTION.with_n(5),
    "plastic": PLASTIC_STRAIN.with_n(5),
    "obstacle": OBSTACLE.with_n(5),
}
INTERVALS = [(-0.8, 0.8), (-0.6, 1.1), (-np.inf, 0.7), (-0.7, np.inf)]
PLACES = [0.1, 0.2 + 0.5j]
UNMOVED = 0.0, 0.0


def basis(grid, others=(), accuracy=1e-8):
    """Few ordinates, from solutions at some z on this grid and on others with the same nodes."""
    found = [
        field
        for z in (0.05, 0.3, 2.0)
        for one in (grid, *others)
        for field in fields(one, z, 1.7, 0.01 * one.way, 0.85)
    ]
    return reduced(grid, joined(found), accuracy, math.sqrt(accuracy))


def transform(ordinates, z, levels):
    """E exp(-z tau) for one interval."""
    return ordinates.first_passage(z, np.array([levels]))[0]


def difference(function, spacing):
    """Central difference and its error."""
    below, above = (
        np.array([[function(side * k * spacing)] for k in (1, 2, 3)]) for side in (-1, 1)
    )
    value, error = central(below, above, np.zeros((3, 1)), spacing)
    return value[0], error[0]


@pytest.fixture(scope="module", params=SCENES)
def ordinates(request):
    """Make few ordinates of a grid that knows how its generator changes with the damping."""
    scene = SCENES[request.param]
    return basis(coarse_ordinates(scene, change(scene, "damping")))


@pytest.mark.parametrize("z", PLACES)
@pytest.mark.parametrize("levels", INTERVALS, ids=str)
class TestDifferentiated:
    """Against differences of transforms on the same nodes and in the same basis.

    A relative deviation of 1e-5 leaves room for the rounding of modes, some 1e-11 over the spacing
    and what the slowest modes lose in addition.
    """

    def test_change_of_the_generator(self, ordinates, levels, z):
        """A part of the derivative is added to the generator."""

        def at(part):
            return transform(replace(ordinates, grid=ordinates.grid.changed(part)), z, levels)

        expected, error = difference(at, 0.01)
        assert error < 1e-5 * abs(expected)
        found = differentiated(ordinates, z, levels, UNMOVED)
        assert abs(found - expected) < 1e-5 * abs(expected)

    def test_levels(self, ordinates, levels, z):
        """Each of the finite levels is moved outwards."""
        still = replace(ordinates, grid=replace(ordinates.grid, change=None))
        for moved in ((1.0, 0.0), (0.0, 1.0)):
            if np.isinf(levels[moved.index(1.0)]):
                continue

            def at(way, moved=moved):
                return transform(still, z, (levels[0] - way * moved[0], levels[1] + way * moved[1]))

            expected, error = difference(at, 0.01)
            assert error < 1e-5 * abs(expected)
            found = differentiated(still, z, levels, moved)
            assert abs(found - expected) < 1e-5 * abs(expected)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "parameter"),
    [
        *(("friction", parameter) for parameter in PARAMETERS),
        ("plastic", "damping"),  # with n the rate of plastic strain changes, too
        ("plastic", "sigma"),
        *(("obstacle", parameter) for parameter in PARAMETERS),
    ],
)
def test_changes_of_the_scene(name, parameter):
    """The generator changes as that of the scene does, on grids of each scene of their own.

    Both are wrong by what the coarse grids are wrong, up to 5 % of the derivative; a wrong factor
    or sign would make far more. Transforms on grids of different boxes differ by some 3e-6 besides,
    which is 1e-4 over 0.06.
    """
    scene, z, levels = SCENES[name], 0.2 + 0.5j, (-0.6, 1.1)
    value = value_of(scene, parameter)

    def at(part):
        scene_there = scene.with_parameter(parameter, value * (1 + part))
        return transform(unreduced(coarse_ordinates(scene_there)), z, levels)

    grid = coarse_ordinates(scene, change(scene, parameter))
    found = differentiated(basis(grid, [grid.changed(0.1 * value)]), z, levels, UNMOVED)
    expected = (at(0.03) - at(-0.03)) / 0.06  # but for a part of the order 1e-3
    assert abs(value * found - expected) <= 0.06 * abs(expected) + 1e-4


@pytest.mark.parametrize("name", SCENES)
def test_time_that_runs_faster(name):
    """If drift and diffusion change by their own values, the generator does."""
    scene = SCENES[name]
    grid = coarse_ordinates(scene, Change(scene.numerical_drift(), scene.noise.sigma**2 / 2))
    for parity in (EVEN, ODD):
        A, found = grid.generator[parity].toarray(), grid.change[parity].toarray()
        assert np.abs(found - A).max() < 1e-12 * np.abs(A).max()
