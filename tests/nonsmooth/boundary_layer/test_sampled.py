"""kappa and the Poisson solution by Monte Carlo."""

import pytest

import nonsmooth as ns
from nonsmooth.boundary_layer import poisson, tuning
from nonsmooth.boundary_layer.sampled import sampled_kappa, sampled_poisson
from nonsmooth.boundary_layer.symmetric_line import layer_constants
from references import FRICTION, KAPPA


def test_kappa_of_dry_friction():
    """The sampled kappa is the published one within the stated error; the seed is fixed."""
    found = sampled_kappa(FRICTION, seed=1)
    assert abs(found.value - KAPPA) < found.error
    assert found.error < 0.2 * found.value


@pytest.mark.slow
@pytest.mark.parametrize(("n", "on_grids"), [(2, True), (2, False), (100, True)])
def test_kappa_of_a_yielding_structure(n, on_grids, monkeypatch):
    """The sampled kappa is the one solved on grids, within the stated errors; the seed is fixed.

    The first threshold is not far enough: kappa changes by more than a third if it is halved.
    """
    if not on_grids:
        monkeypatch.setattr(poisson, "on_coarse_grid", lambda scene: None)
    scene = ns.Scene("elasto_plastic", potential="x**2/2", n=n)
    found, solved = sampled_kappa(scene, seed=1), ns.extrapolation_length(scene, tol=1e-2)
    assert abs(found.value - solved.value) < found.error + solved.error
    relative = tuning.SAMPLED.tolerance_on_grids if on_grids else tuning.SAMPLED.tolerance
    assert found.error < relative * abs(found.value)


@pytest.mark.slow
def test_kappa_with_three_variables(monkeypatch):
    """What paths gain after a passage is the mean of the Poisson solution there."""
    scene = ns.Scene("friction", "hamiltonian", n=10)
    solved = sampled_kappa(scene, seed=1)
    assert solved.error < tuning.SAMPLED.tolerance_on_grids * solved.value
    monkeypatch.setattr(poisson, "on_coarse_grid", lambda scene: None)
    gained = sampled_kappa(scene, seed=2)
    assert abs(solved.value - gained.value) < solved.error + gained.error


def test_poisson_solution_at_a_start():
    """That of discrete ordinates, within the stated error, two standard errors and more."""
    scene = ns.Scene("friction", start={"y": 0.5})
    found, exact = sampled_poisson(scene, seed=1), layer_constants(scene)[0].u
    assert abs(found.value - exact) < found.error
    assert found.error < 0.3 * exact
