"""Derivatives by the adjoint equation are those of the discrete equations themselves."""

from dataclasses import replace

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic.case_modes import modes
from nonsmooth.kinetic.derivatives.adjoint import Adjoint
from nonsmooth.kinetic.ordinates_line import Change, changed, ordinates
from references import FRICTION

# with and without a symmetry, from rest and from elsewhere, and with a flow that stands still
SCENES = [
    FRICTION.with_n(3),
    ns.Scene("friction", n=3, start={"y": 0.4}, observable="tanh(y) - 0.1"),
    ns.Scene("friction", n=20, observable="max(abs(y) - 0.3, 0)*sign(y)"),
]
INTERVALS = [(-0.6, 0.6), (-0.6, 1.1), (-np.inf, 0.7), (-0.7, np.inf)]
PLACES = [0.7, 0.5 + 3j]
# no parameter of a scene, but functions that differ from all of them
CHANGE = Change(lambda y: np.cos(y) * y**2, lambda y: y * np.abs(y) - 0.2, 0.7)


def transform(grid, z, lower, upper):
    """E exp(-z tau) of each exit."""
    found = modes(grid, z)
    if np.isfinite([lower, upper]).all():
        return found.by_exit(lower, upper)
    return np.array([found.first_passage(lower, upper)])


def differentiated(function, spacing):
    """Central difference of the order 4."""
    near, far = (function(k * spacing) - function(-k * spacing) for k in (1, 2))
    return (8 * near - far) / (12 * spacing)


@pytest.mark.parametrize("z", PLACES)
@pytest.mark.parametrize("interval", INTERVALS, ids=str)
@pytest.mark.parametrize("scene", SCENES, ids=["odd", "skew", "still"])
class TestAdjoint:
    """Against differences of transforms on the same nodes.

    At a spacing of 1e-3 the difference has an error of 1e-12 times a fifth derivative, and rounding
    of 1e-12 / 1e-3. Relative deviations of 1e-7 leave room for both.
    """

    def test_change_of_the_equations(self, scene, interval, z):
        """Masses, stiffness and flow are changed by hand, in the directions of a change."""
        grid = ordinates(scene, 7, time=1.0, fold=False)
        moves = grid.g != 0
        direction = changed(scene, grid, CHANGE)
        # nodes at which the flow stands still must not begin to move
        direction = replace(direction, flow=np.where(moves, direction.flow, 0.0))

        def at(size):
            masses = grid.masses + size * direction.masses
            flow = grid.masses * grid.g + size * direction.flow
            stiffness = grid.stiffness[EVEN] + size * direction.stiffness
            total = masses.sum()  # a common factor of all three changes nothing
            there = replace(
                grid, masses=masses / total, g=flow / masses, stiffness={EVEN: stiffness / total}
            )
            return transform(there, z, *interval)

        expected = differentiated(at, 1e-3)
        found = Adjoint(grid, z, *interval).by_parameter(direction)
        assert np.abs(found - expected).max() < 1e-7 * np.abs(expected).max()

    def test_thresholds(self, scene, interval, z):
        """Each threshold is moved outwards."""
        grid, (lower, upper) = ordinates(scene, 7, time=1.0, fold=False), interval
        by_upper, by_lower = Adjoint(grid, z, lower, upper).by_levels()
        expected = [
            differentiated(lambda d: transform(grid, z, lower, upper + d), 1e-3),
            differentiated(lambda d: transform(grid, z, lower - d, upper), 1e-3),
        ]
        assert np.abs(by_upper - expected[0]).max() < 1e-7 * np.abs(expected).max()
        assert np.abs(by_lower - expected[1]).max() < 1e-7 * np.abs(expected).max()


def test_changes_of_the_nodes():
    """Masses and stiffness of a scene whose damping grows, on the same elements."""
    scene = FRICTION.with_n(3)
    grid = ordinates(scene, 5, fold=False)
    found = changed(scene, grid, Change(lambda y: (y / scene.noise.sigma) ** 2, np.zeros_like, 0.0))

    def ratios(damping):
        """Masses with another damping, up to a factor: elements would follow the density."""
        density = np.exp(-damping / scene.noise.sigma**2 * grid.nodes**2)
        return density * grid.masses * np.exp(scene.damping / scene.noise.sigma**2 * grid.nodes**2)

    expected = differentiated(lambda d: ratios(scene.damping + d), 1e-3)
    assert np.abs(found.masses - expected).max() < 1e-10 * grid.masses.max()
    assert np.abs(found.stiffness.sum(axis=1)).max() < 1e-9 * np.abs(found.stiffness).max()
    # K is linear in the density: its change by -Phi' is that of the energy <f', f'> of any f
    f = grid.nodes**2
    energy = f @ found.stiffness @ f
    assert energy == pytest.approx(
        scene.noise.sigma**2 / 2 * np.sum(4 * grid.nodes**2 * found.masses), rel=1e-9
    )
