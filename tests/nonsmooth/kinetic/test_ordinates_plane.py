"""Grids of two variables for the kinetic equation."""

from dataclasses import replace

import numpy as np
import pytest

from nonsmooth.crossing.first_passage.tuning import PLANE
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from references import COLORED_FRICTION, PLASTIC_STRAIN
from support import coarse_ordinates


@pytest.mark.parametrize("scene", [COLORED_FRICTION, PLASTIC_STRAIN], ids=["friction", "plastic"])
class TestNodesThatAreHardlyVisited:
    """They are eliminated as if they were in balance."""

    def test_constants_stay(self, scene):
        """The generator of even functions still takes them to 0, but for rounding."""
        grid = coarse_ordinates(scene)
        A = grid.generator[EVEN]
        assert np.max(np.abs(A @ grid.ones)) < 1e-15 * A.shape[0] * np.max(np.abs(A).sum(axis=1))

    @pytest.mark.parametrize("z", [0.1, 1.0, 10.0])
    def test_the_equation_hardly_changes(self, scene, z, monkeypatch):
        """Weighted by the mass: by less than the stated errors have for what no level shows."""
        grid = coarse_ordinates(scene)
        monkeypatch.setattr(tuning, "PLANE_ORDINATES", replace(tuning.PLANE_ORDINATES, rare=0.0))
        whole = coarse_ordinates(scene)
        assert len(whole.ones) > 1.2 * len(grid.ones)
        assert np.array_equal(whole.speeds, grid.speeds)
        for parity in (EVEN, ODD):
            h = np.column_stack([np.sign(grid.speeds) ** (parity == ODD), np.tanh(grid.speeds)])
            one, two = (g.eliminated(z)[parity].applied(h) for g in (grid, whole))
            assert np.all(np.abs(grid.masses @ (one - two)) < z * PLANE.unseen_error)
