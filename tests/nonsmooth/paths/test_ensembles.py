"""Ensembles of paths: the same bits however they are run, and no path is lost."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.paths.ensembles import gram, paths_at
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.sampling import Sampling
from references import FRICTION


def test_spelling_of_a_number_changes_no_stream():
    """Damping 1 and 1.0 are the same scene; a start outside the limit's walls is no obstacle."""
    ends = [
        paths_at(ns.Scene("obstacle", damping=c, start={"x": 2}), [0.5], Sampling(0.1, 3, 1))
        for c in (1, 1.0, np.float64(1.0))
    ]
    assert np.array_equal(ends[0], ends[1])
    assert np.array_equal(ends[0], ends[2])


def test_number_of_threads_changes_no_bit():
    """One and three threads give identical sums."""
    runs = [gram(FRICTION, [0.5, 1.0], Sampling(0.05, 5 * BLOCK + 7, 9, threads=k)) for k in (1, 3)]
    assert np.array_equal(*runs)


def test_shards_are_parts_of_the_whole():
    """Sums of two shards, added in order, are the sums of one run, to the last bit."""
    whole = gram(FRICTION, [0.5], Sampling(0.1, 2 * BLOCK + 40, 3))
    shards = [(0, BLOCK), (BLOCK, BLOCK), (2 * BLOCK, 40)]
    parts = [gram(FRICTION, [0.5], Sampling(0.1, count, 3, first)) for first, count in shards]
    assert np.array_equal(whole, sum(parts))


def test_paths_do_not_depend_on_their_neighbours():
    """A block's first paths are the same whether the others are asked for or not."""
    few, many = (paths_at(FRICTION, [0.5, 1.0], Sampling(0.1, count, 3)) for count in (5, BLOCK))
    assert np.array_equal(few, many[..., :5])


def test_streams_differ_between_seeds():
    """No two runs share a sample."""
    seeds = (1, 2, (1, "a"), (1, 0))
    ends = [paths_at(FRICTION, [0.5], Sampling(0.1, 10, seed))[-1, 0] for seed in seeds]
    assert len(np.unique(ends)) == np.size(ends)


def test_a_minority_of_diverging_paths_is_seen():
    """A path that leaves every bound is not replaced by a healthy one."""
    scene = ns.Scene("obstacle", n=10, potential="x**2/2", observable="exp(400*(x - 1))")
    with pytest.raises(SceneError, match="diverged"):
        gram(scene, [5.0], Sampling(0.05, BLOCK, 1))
