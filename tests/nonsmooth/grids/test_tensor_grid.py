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
