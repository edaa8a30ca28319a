"""Grids of two variables for the kinetic equation."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic.ordinates_plane import axes, boxed
from nonsmooth.kinetic.tuning import PlaneLevel
from nonsmooth.scenes.symbols import x
from references import COLORED_FRICTION, PLASTIC_STRAIN
from support import coarse_ordinates


@pytest.mark.parametrize("scene", [COLORED_FRICTION, PLASTIC_STRAIN], ids=["friction", "plastic"])
class TestPlaneOrdinates:
    """The generator on half of a tensor grid."""

    def test_constants_are_kept(self, scene):
        """The generator of even functions takes them to 0, but for rounding."""
        grid = coarse_ordinates(scene)
        A = grid.generator[EVEN]
        assert np.max(np.abs(A @ grid.ones)) < 1e-15 * A.shape[0] * np.max(np.abs(A).sum(axis=1))

    def test_no_node_is_its_own_mirror_image(self, scene):
        """The axes are symmetric, and one of them has no node at 0."""
        level = PlaneLevel(4, (4, 9.0), (9, ()), 3, 8.0, 0.1, 1e-5)
        made = axes(scene, boxed(scene), level, 1.0).values()
        assert all(axis.nodes == pytest.approx(-axis.nodes[::-1]) for axis in made)
        assert np.prod([len(axis.nodes) for axis in made]) % 2 == 0


class TestElements:
    """Which elements a variable gets."""

    @pytest.mark.parametrize(("places", "many"), [((), 10), ((0.5,), 20)])
    def test_between_walls_there_are_few(self, places, many):
        """Nodes from the middle to a wall belong to the elements of `between`, of its degree."""
        scene = ns.Scene("elasto_plastic", n=100, potential="x**2/2")
        level = PlaneLevel(4, (4, 9.0), (9, places), 3, 8.0, 0.1, 1e-5)
        axis = axes(scene, boxed(scene), level, 1.0)[x]
        assert np.sum((axis.nodes > 0) & (axis.nodes < 1)) == many
        assert {*places, 1.0} < set(np.round(axis.edges, 12))
        assert np.sum(axis.edges > 1) == 2, "an edge in the wall, and its end"
