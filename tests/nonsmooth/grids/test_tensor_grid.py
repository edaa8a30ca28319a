"""The box of a tensor grid."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.grids import tensor_grid
from nonsmooth.scenes.symbols import y


def test_the_box_holds_the_invariant_density():
    """The velocity of an obstacle scene is normal with variance sigma^2 / (2 C_b)."""
    scene = ns.Scene("obstacle", ns.White(2.0), n=100, damping=0.5, potential="x**2/2")
    grid = tensor_grid.fitted(scene, 20.0, 2)
    assert grid.ends[y] == pytest.approx(2.0 * np.sqrt(40.0), rel=0.15)


@pytest.mark.parametrize("level", [0, 1, 2])
def test_coarse_grids_do_not_inflate_the_box(level):
    """White noise gives the velocity at most the variance of the linear oscillator.

    A narrow well is coarsely resolved by the first grid, which smears the density.
    """
    scene = ns.Scene("obstacle", ns.White(0.4), damping=0.8, potential="15*x**2", observable="x")
    grid = tensor_grid.fitted(scene, 24.0, level)
    assert grid.ends[y] <= 0.4 * np.sqrt(24.0 / 0.8) * (1 + 1e-12)


@pytest.mark.parametrize("noise", ["white", "langevin"])
def test_the_invariant_measure_needs_half_of_the_grid(noise, monkeypatch):
    """It is even if the drift is odd, although g is not; on all of the grid it is the same."""
    scene = ns.Scene("obstacle", noise, n=10, potential="x**2/2", observable="x**2")
    grid = tensor_grid.fitted(scene, 12.0, 0)
    accuracy = 1e-8
    _, half = tensor_grid.invariant_measure(scene, grid, accuracy)
    monkeypatch.setattr(ns.Scene, "has_odd_drift", lambda scene: False)
    _, whole = tensor_grid.invariant_measure(scene, grid, accuracy)
    assert half == pytest.approx(half[tuple(slice(None, None, -1) for _ in half.shape)], abs=1e-15)
    # an error of the residual is amplified by the time that the scene takes to forget, about 10
    assert half == pytest.approx(whole, abs=10 * accuracy)
