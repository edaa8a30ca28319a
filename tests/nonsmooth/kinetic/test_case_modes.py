"""The transform of the first passage from Case's modes."""

import numpy as np
import pytest

from nonsmooth.kinetic.case_modes import modes, modes_at_real
from nonsmooth.kinetic.ordinates_line import ordinates
from references import FRICTION, MIRRORED, SKEWED


@pytest.mark.slow
@pytest.mark.parametrize("z", [0.7, 0.3 + 2j, -0.5 + 2j])
def test_transform_without_symmetry(z):
    """Converges in the degree, and the mirrored scene has the mirrored walls."""
    for levels in ((-0.3, 0.6), (-np.inf, 0.6)):
        values = [
            modes(ordinates(SKEWED, degree, 1.0), z).first_passage(*levels) for degree in (7, 9, 13)
        ]
        assert abs(values[0] - values[2]) < 1e-6
        assert abs(values[1] - values[2]) < 1e-7
        swapped = modes(ordinates(MIRRORED, 9, 1.0), z).first_passage(-levels[1], -levels[0])
        assert abs(swapped - values[1]) < 1e-9


@pytest.mark.parametrize("scene", [FRICTION, SKEWED])
def test_parts_of_the_exits_have_the_sum(scene):
    """On half grids and on whole ones."""
    grid = ordinates(scene, 6, 1.0)
    for z in (0.7, 0.3 + 2j):
        found = modes(grid, z)
        assert abs(found.by_exit(-0.3, 0.6).sum() - found.first_passage(-0.3, 0.6)) < 1e-10
    assert np.all(modes(grid, 0.1).by_exit(-0.3, 0.6).real > 0)


def test_the_nearer_exit_is_taken_more_often():
    """Thresholds exchanged exchange the parts, if g is odd and the start 0."""
    grid = ordinates(FRICTION, 6, 1.0)
    upper, lower = modes(grid, 0.5).by_exit(-0.3, 0.6).real
    assert lower > upper
    assert np.allclose(modes(grid, 0.5).by_exit(-0.6, 0.3).real, [lower, upper], rtol=1e-9)


@pytest.mark.parametrize("z", [0.01, 0.7, 30.0])
def test_modes_at_real_places_are_those_of_symmetric_matrices(z):
    """The same decay, and the same transform, by a matrix that is not symmetric."""
    grid = ordinates(SKEWED, 6, 0.1)
    own, other = modes_at_real(grid, z), modes(grid, z)
    assert np.allclose(own.by_exit(-0.3, 0.6), other.by_exit(-0.3, 0.6), rtol=1e-9, atol=0)
    slow = np.sort(own.above.rates)[:20]
    assert np.allclose(slow, np.sort(other.above.rates.real)[:20], rtol=1e-8)
