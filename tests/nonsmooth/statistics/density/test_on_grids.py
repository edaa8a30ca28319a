"""Densities on grids: the exact marginal of the noise on fine grids, and layers."""

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.statistics.density.on_grids import densities_on, first_grid, refined

STICKING = ns.Scene("friction", "langevin", n=2)
YIELDING = ns.Scene("elasto_plastic", n=100, potential="x**2/2")


def test_mass_stays_in_the_box():
    """On fine grids nothing grows at the ends, which spoils all digits unless they are closed."""
    grid = first_grid(STICKING, 1e-4)
    points = {symbol.name: np.linspace(-end, end, 101) for symbol, end in grid.ends.items()}
    found = densities_on(STICKING, grid.all_raised(5), points, 1e-6)
    exact = np.exp(-(points["eta"] ** 2)) / np.sqrt(np.pi)
    assert np.max(np.abs(found["eta",] - exact)) < 1e-8
    assert np.min(found["eta", "y"]) > -1e-4 * np.max(found["eta", "y"])


@pytest.mark.parametrize("ratio", [0.3, 0.6, 0.9])
def test_slow_convergence_is_seen(ratio):
    """Errors that fall by a constant factor are stated in full, also where that is near 1."""
    scene = ns.Scene("obstacle", n=2, potential="x**2/2")
    levels = iter(range(20))

    def solve(grid):
        return {("y",): np.array([1.0 + ratio ** next(levels)])}

    with pytest.raises(ToleranceError) as refused:
        refined(scene, first_grid(scene, 1e-9), 1e-9, solve, at_points=True)
    value, error = refused.value.result["y",]
    assert abs(value - 1) <= error * (1 + 1e-9)
    assert next(levels) > 3


@pytest.mark.slow
@pytest.mark.parametrize("scene", [YIELDING, STICKING.with_n(100)])
def test_layers_are_resolved(scene):
    """To a thousandth of the largest value; a hundredth is as right as it says."""
    end = 1.02 if "x" in scene.state else 0.012
    points = {name: np.linspace(-end, end, 41) for name in scene.state[-1:]}
    points |= {name: np.linspace(-1.5, 1.5, 41) for name in scene.state[:-1]}
    loose, tight = (
        ns.invariant_density(scene, tol, points, "deterministic") for tol in (1e-2, 1e-3)
    )
    for name in (name for name in loose if not name.endswith("_error")):
        gap = float(np.max(np.abs(loose[name] - tight[name])))
        assert gap <= float(loose[f"{name}_error"] + tight[f"{name}_error"])
        assert float(tight[f"{name}_error"]) <= 1e-3 * float(tight[name].max())


@pytest.mark.slow
def test_grids_that_miss_a_layer_do_not_answer():
    """In cells next to the kink the density is what paths have there; the others are solved for."""
    scene = ns.Scene("elasto_plastic", "langevin", n=100, potential="x**2/2")
    points = {"eta": np.linspace(-3, 3, 41), "y": np.linspace(-2, 2, 41)}
    points["x"] = 1 + np.arange(-3, 4) * 1e-3
    with pytest.raises(ToleranceError, match="layers for which x needs") as refused:
        ns.invariant_density(scene, 0.2, points, "deterministic")
    solved = refused.value.result
    assert math.isinf(solved.density_x_error)
    assert math.isinf(solved.density_y_x_error)
    assert float(solved.density_y_error) <= 0.2 * float(solved.density_y.max())
    answer = ns.invariant_density(scene, 0.2, points)
    assert answer.density_x.attrs["cell_methods"] == "x: mean"
    assert "cell_methods" not in answer.density_y.attrs
    assert float(answer.density_x_error) <= 0.2 * float(answer.density_x.max())
