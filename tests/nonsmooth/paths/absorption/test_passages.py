"""First-passage times with two steps, of paths that are dropped once they have crossed."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.paths.absorption.passages import coupled_passages
from nonsmooth.paths.ensembles import coupled
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.sampling import Sampling
from references import FRICTION

TIMES = [2.0, 50.0]


@pytest.mark.parametrize("levels", [(-1.0, 1.0), (-1.5, 0.7), (-np.inf, 1.0)])
def test_times_are_those_of_paths_that_are_kept(levels):
    """Where a path is dropped must not matter but for rounding.

    That of int g is some 1000 steps times 2e-16; the time differs by this over the speed, of which
    the least of 3000 crossings is a 3000th or more: 6e-10.
    """
    sampling = Sampling(0.1, 1_500, 10, precision="float64")
    dropped = coupled_passages(FRICTION, TIMES, sampling, levels)
    _, kept = coupled(FRICTION, TIMES, sampling, levels)
    assert np.array_equal(np.isinf(dropped), np.isinf(kept))
    crossed = np.isfinite(kept)
    assert 0.5 < crossed.mean() < 1
    assert np.max(np.abs(dropped[crossed] - kept[crossed])) < 1e-9


@pytest.mark.parametrize("levels", [(-1.0, 1.0), (-1.5, 0.7)])
def test_two_levels(levels):
    """The earlier of the times of each level, bit for bit, for both steps."""
    passages = [
        coupled_passages(FRICTION, TIMES, Sampling(0.1, 1_500, 10), pair)
        for pair in (levels, (levels[0], np.inf), (-np.inf, levels[1]))
    ]
    assert np.array_equal(passages[0], np.minimum(*passages[1:]))


def test_blocks_are_independent():
    """The times of one run of two blocks are those of the first alone, and then others."""
    whole, first = (
        coupled_passages(FRICTION, TIMES[:1], Sampling(0.1, paths, 5, threads=threads), (-1.0, 1.0))
        for paths, threads in ((2 * BLOCK, 2), (BLOCK, 1))
    )
    assert np.array_equal(whole[:, :BLOCK], first)


def test_divergence_is_an_error():
    """A path that becomes nan must not count as one that never crosses."""
    scene = ns.Scene("friction", potential="-x**4", observable="y", start={"x": 5.0})
    with pytest.raises(SceneError, match="diverged"):
        coupled_passages(scene, TIMES, Sampling(0.1, 10, 1), (-1e30, 1e30))
