"""Sums over paths that leave an interval."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.paths.absorption.survival import crossed
from nonsmooth.paths.sampling import Sampling


def test_sums_of_parts():
    """An ensemble simulated in two parts has the sum of their sums."""
    scene = ns.Scene("friction")
    whole = Sampling(0.1, 2000, 1)
    first, second = Sampling(0.1, 1000, 1), Sampling(0.1, 1000, 1, first_path=1000)
    sums = [crossed(scene, "y", [(-1, 1)], [0.5, 2], s) for s in (whole, first, second)]
    assert np.allclose(sums[0], sums[1] + sums[2], rtol=1e-12)


def test_more_cross_with_time():
    """The probability to have left never falls, path by path."""
    scene = ns.Scene("friction")
    sums = crossed(scene, "y", [(-1, 1)], [0.5, 1, 2, 4], Sampling(0.1, 1000, 1))
    assert np.all(np.diff(sums[:, 0]) >= 0)
    assert 0 < sums[0, 0] < sums[-1, 0] <= 1000


def test_intervals_are_independent():
    """Each has the sums that it has alone, with the same bits."""
    scene, sampling = ns.Scene("friction"), Sampling(0.1, 2000, 1)
    levels = [(-1, 1), (-np.inf, 0.4), (-0.3, 2)]
    together = crossed(scene, "y", levels, [0.5, 2], sampling)
    alone = [crossed(scene, "y", [one], [0.5, 2], sampling) for one in levels]
    assert np.array_equal(together, np.concatenate(alone, axis=2))


def test_divergence_is_refused():
    """A potential without a bottom throws x to infinity."""
    with pytest.warns(ns.errors.AssumptionWarning):
        scene = ns.Scene("friction", potential="-x**4", observable="x")
    with pytest.raises(SceneError, match="diverged"):
        crossed(scene, "y", [(-np.inf, 1e30)], [50.0], Sampling(0.05, 100, 1))
