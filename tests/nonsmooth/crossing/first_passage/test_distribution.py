"""The deterministic distribution of the first passage: which scenes have one."""

import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError


def test_a_scene_of_four_variables_is_told_to_sample():
    """The message names the method."""
    scene = ns.Scene("elasto_plastic", "hamiltonian")
    with pytest.raises(SceneError, match="monte_carlo"):
        ns.crossing_probability(scene, 0.3, [1.0], 30, method="deterministic")


def test_other_scenes_are_told_to_sample():
    """The message names the method to use."""
    with pytest.raises(ns.NonsmoothError, match="monte_carlo"):
        ns.crossing_probability(
            ns.Scene("friction", "hamiltonian"), 0.6, [1.0], method="deterministic", tol=1e-7
        )
