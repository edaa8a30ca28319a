"""Densities by Monte Carlo: averages over cells, of every scene and at n = inf."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate, stats

import nonsmooth as ns
from nonsmooth.errors import AccuracyWarning, SceneError, ToleranceError
from nonsmooth.statistics import tuning
from nonsmooth.statistics.density.bins import bin_averages

VELOCITIES, DISPLACEMENTS = np.linspace(-2, 2, 21), np.linspace(-0.9, 0.9, 10)
STICKING = ns.Scene("friction", "langevin", n=math.inf)


@pytest.mark.parametrize(
    "scene",
    [
        ns.Scene("friction", n=math.inf),
        ns.Scene("obstacle", n=math.inf, potential="x**2/2"),
        ns.Scene("obstacle", n=100, potential="x**2/2"),
    ],
)
def test_closed_forms_are_within_the_errors(scene):
    """Of averages over cells, of which chance exceeds one with a probability of 1e-3."""
    points = {"y": VELOCITIES, "x": DISPLACEMENTS}
    points = {name: points[name] for name in scene.state}
    found = ns.invariant_density(scene, 0.05, points, "monte_carlo", seed=1)
    for name, z in points.items():
        middle = (z[1:] + z[:-1]) / 2
        edges = np.concatenate([[2 * z[0] - middle[0]], middle, [2 * z[-1] - middle[-1]]])
        exact, _ = bin_averages(scene, {name: edges}, 1e-6)[name]
        error = float(found[f"density_{name}_error"])
        assert np.all(np.abs(found[f"density_{name}"] - exact) <= error)
        assert error <= 0.05 * float(found[f"density_{name}"].max())
        assert found[f"density_{name}"].attrs["cell_methods"] == f"{name}: mean"


@pytest.mark.slow
def test_grids_are_within_the_errors():
    """Averages over cells of a yielding structure, marginals and both variables alike."""
    scene = ns.Scene("elasto_plastic", n=10, potential="x**2/2")
    points = {"y": VELOCITIES, "x": DISPLACEMENTS}
    sampled = ns.invariant_density(scene, 0.05, points, "monte_carlo")
    fine = {
        name: np.linspace(1.5 * z[0] - z[1] / 2, 1.5 * z[-1] - z[-2] / 2, 20 * len(z) + 1)
        for name, z in points.items()
    }
    middles = {name: (z[1:] + z[:-1]) / 2 for name, z in fine.items()}
    solved = ns.invariant_density(scene, 1e-3, middles, "deterministic")
    for key in ("y", "x", "y_x"):
        name = f"density_{key}"
        value = solved[name].values
        for axis in range(value.ndim):  # the mean of 20 points in each cell
            value = value.reshape(*value.shape[:axis], -1, 20, *value.shape[axis + 1 :])
            value = value.mean(axis=axis + 1)
        gap = np.max(np.abs(value - sampled[name]))
        assert gap <= float(sampled[f"{name}_error"] + solved[f"{name}_error"])


def test_mass_at_rest_does_not_shrink_with_its_cell():
    """Friction holds the velocity at 0 for a share of the time, in a cell however small."""
    held = []
    for width in (1e-2, 1e-4):
        points = {"eta": np.linspace(-2, 2, 9), "y": np.array([-width, 0.0, width])}
        found = ns.invariant_density(STICKING, 0.05, points)
        held.append([float(found.density_y[1]) * width, float(found.density_y_error) * width])
    (wide, uncertain), (narrow, less) = held
    assert 0.3 < narrow <= wide + uncertain + less
    assert wide - narrow < 0.05


@pytest.mark.parametrize("rate", [1.0, pytest.param(0.05, marks=pytest.mark.slow)])
def test_noise_alone_is_normal(rate):
    """Of a g without the velocity, also if noise forgets its start only after 20 units of time."""
    spread = math.sqrt(1 / (2 * rate))
    z = np.linspace(-2 * spread, 2 * spread, 21)
    scene = ns.Scene("friction", ns.OrnsteinUhlenbeck(rate), observable="eta")
    found = ns.invariant_density(scene, points={"eta": z})
    half = (z[1] - z[0]) / 2
    shares = stats.norm.cdf(z + half, scale=spread) - stats.norm.cdf(z - half, scale=spread)
    gap = np.abs(found.density_eta - shares / (2 * half))
    assert np.all(gap <= float(found.density_eta_error))
    assert float(found.density_eta_error) <= 0.05 * float(found.density_eta.max())


def test_steep_potentials_are_sampled_with_stable_steps():
    """Four times the step is below the longest one, too."""
    noise = ns.Langevin("eta**4")
    points = {"eta": np.linspace(-1, 1, 5), "y": np.linspace(-0.5, 0.5, 5)}
    found = ns.invariant_density(ns.Scene("friction", noise, n=math.inf), 0.2, points)
    total = integrate.quad(lambda eta: math.exp(-2 * eta**4), -4, 4)[0]
    exact = [
        integrate.quad(lambda eta: math.exp(-2 * eta**4), z - 0.25, z + 0.25)[0] / total / 0.5
        for z in points["eta"]
    ]
    assert np.all(np.abs(found.density_eta - exact) <= float(found.density_eta_error))


def test_walls_belong_to_the_last_cell():
    """What a wall holds is counted if it is the edge of the cells, on either side."""
    points = {"y": VELOCITIES, "x": np.linspace(-0.9, 0.9, 10)}
    scene = ns.Scene("elasto_plastic", n=math.inf, potential="x**2/2")
    found = ns.invariant_density(scene, 0.1, points)
    total = float(found.density_x.sum()) * 0.2
    assert abs(total - 1) <= 10 * 0.2 * float(found.density_x_error)


@pytest.fixture
def patience(monkeypatch):
    """Shorten the last attempt to some seconds."""
    chosen = replace(tuning.SAMPLED_DENSITY, longest_time=200.0)
    monkeypatch.setattr(tuning, "SAMPLED_DENSITY", chosen)


@pytest.mark.slow
@pytest.mark.usefixtures("patience")
def test_cells_that_no_path_visits_are_not_known():
    """Their density is 0 within an error that is not 0."""
    points = {"eta": np.linspace(-2, 2, 5), "y": np.array([50.0, 51.0])}
    with pytest.warns(AccuracyWarning, match="values up to 0|averages up to 0"):
        found = ns.invariant_density(STICKING, points=points)
    assert float(found.density_y.max()) == 0
    assert float(found.density_y_error) > 0


@pytest.mark.slow
def test_threads_change_no_bit():
    """Blocks are added in their order; and the law of an odd scene is its own mirror image."""
    points = {"eta": np.linspace(-2, 2, 5), "y": np.linspace(-1, 1, 5)}
    one, two = (ns.invariant_density(STICKING, 0.1, points, threads=count) for count in (1, 2))
    assert one.identical(two)
    assert np.allclose(one.density_eta_y, one.density_eta_y[::-1, ::-1])


def test_what_cannot_be_sampled_is_refused():
    """A single point has no cell; a tolerance out of reach leaves what was found."""
    with pytest.raises(SceneError, match="two increasing points"):
        ns.invariant_density(STICKING, points={"eta": [0.0], "y": [0.0, 1.0]})
    with pytest.raises(SceneError, match="method='monte_carlo'"):
        ns.invariant_density(STICKING, method="deterministic")


@pytest.mark.slow
@pytest.mark.usefixtures("patience")
def test_a_tolerance_out_of_reach_leaves_what_was_found():
    """The message has the error, and the result is what was asked for."""
    points = {"eta": np.linspace(-2, 2, 81), "y": np.linspace(-1, 1, 81)}
    with pytest.raises(ToleranceError, match="relative error of") as refused:
        ns.invariant_density(STICKING, 1e-3, points)
    found = refused.value.result
    assert 0 < float(found.density_y_error) < 0.05 * float(found.density_y.max())


@pytest.mark.slow
def test_layers_that_no_grid_resolves_are_sampled():
    """The others stay as they were solved."""
    scene = ns.Scene("elasto_plastic", n=1e4, potential="x**2/2")
    points = {"y": VELOCITIES, "x": np.linspace(-1, 1, 11)}
    found = ns.invariant_density(scene, points=points)
    assert "cell_methods" not in found.density_y.attrs
    assert {"y: x: mean", "x: mean"} == {
        found[f"density_{key}"].attrs["cell_methods"] for key in ("x", "y_x")
    }
    for key in ("y", "x", "y_x"):
        assert float(found[f"density_{key}_error"]) <= 0.05 * float(found[f"density_{key}"].max())


def test_paths_that_never_forget_their_start_are_refused():
    """Before the first step: it would be one of 1e10."""
    scene = ns.Scene("friction", n=1e-6, damping=1e6)
    points = {"y": VELOCITIES}
    with pytest.raises(ToleranceError, match="until paths have forgotten their start"):
        ns.invariant_density(scene, 0.1, points, "monte_carlo")
