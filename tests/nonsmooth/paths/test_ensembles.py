"""Ensembles of paths: the same bits however they are run, and no path is lost."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.paths.ensembles import coupled, gram, integrals_at, paths_at
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


@pytest.mark.parametrize("noise", ["white", "langevin", "hamiltonian"])
def test_output_times_change_no_path(noise):
    """Nor do odd numbers of steps between them, after which a normal number is left over."""
    scene, sampling = ns.Scene("friction", noise), Sampling(0.01, 50, 3, precision="float64")
    one, many = (paths_at(scene, times, sampling)[-1] for times in ([1.0], [0.37, 0.68, 1.0]))
    assert np.allclose(one, many, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    "scene",
    [
        FRICTION,
        ns.Scene("elasto_plastic", potential="x**2/2"),
        ns.Scene("obstacle", "langevin", observable="x"),
    ],
    ids=["velocity", "force", "displacement"],
)
def test_sums_are_those_of_the_paths(scene):
    """Where int g is complete after a kick, half-flows on both sides of an output time are one."""
    times, sampling = np.arange(1, 9) * 0.25, Sampling(0.05, 300, 2, precision="float64")
    d = integrals_at(scene, times, sampling)[:, 0]
    sums = gram(scene, times, sampling)[:, 1]
    assert np.allclose(sums[:, 0], d.sum(axis=1), rtol=0, atol=1e-12 * np.abs(d).sum(axis=1))
    assert np.allclose(sums[:, 1], (d**2).sum(axis=1), rtol=1e-12)


def test_passages_are_followed_where_there_are_levels():
    """The changes are the same with and without, and with levels that no path reaches."""
    sampling = Sampling(0.05, 200, 5)
    (changes, none), (same, passage) = (
        coupled(FRICTION, [1.0, 2.0], sampling, levels)
        for levels in ((-np.inf, np.inf), (-0.5, 1e9))
    )
    assert none.shape == (2, 0)
    assert passage.shape == (2, 200)
    assert np.array_equal(changes, same)
    assert 0 < np.mean(np.isfinite(passage)) < 1


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
