"""Cycles of paths: when they end, and what int g has gained by then."""

import numpy as np

import nonsmooth as ns
from nonsmooth.boundary_layer.cycles import Cycle, followed, followed_twice
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.symbols import eta, y

SCENE = ns.Scene("friction", "langevin")
STEP, STEPS, FAR = 0.05, 2000, 0.5


def sampling(paths=1500, threads=1):
    """Return two blocks of paths, the second one not full."""
    return Sampling(STEP, paths, (1, "cycles"), threads=threads)


def test_cycles_end_at_the_passage():
    """A path has then just passed b, with a velocity towards it, mirrored or not."""
    (ends,) = followed(SCENE, 100, STEPS, [Cycle(FAR, 0)], sampling())
    assert ends.paths == 1500
    assert set(np.unique(ends.path)) <= set(range(1500))
    assert np.max(ends.path) >= 1000  # of the second block
    assert set(ends.state) == {eta, y}
    assert np.all(ends.state[y] > -STEP)
    assert np.all(ends.gain >= 0)
    assert np.max(ends.gain) < STEP * (np.max(ends.state[y]) + 1)


def test_looks():
    """Fewer looks notice the same passages later, and shorter time has fewer passages."""
    every, other, early, after = followed(
        SCENE,
        100,
        STEPS,
        [Cycle(FAR, 0), Cycle(FAR, 0, stride=2), Cycle(FAR, 0, until=STEPS // 2), Cycle(FAR, 40)],
        sampling(),
    )
    assert np.mean(other.gain) > np.mean(every.gain)
    assert len(other.gain) < len(every.gain)
    # passages are a renewal process after some time; the counts of 1500 paths scatter by 1 %
    assert abs(len(early.gain) / len(every.gain) - 0.5) < 0.05
    assert len(after.gain) < len(every.gain)


def test_no_passage():
    """There are no ends."""
    (ends,) = followed(SCENE, 0, 10, [Cycle(100.0, 0)], sampling(10))
    assert len(ends.path) == len(ends.gain) == len(ends.state[y]) == 0


def test_threads_change_no_bit():
    """Blocks come in their order."""
    one, two = (
        followed(SCENE, 10, 400, [Cycle(FAR, 0)], sampling(threads=threads))[0]
        for threads in (1, 2)
    )
    assert np.array_equal(one.path, two.path)
    assert np.array_equal(one.gain, two.gain)


def test_half_the_step():
    """It passes at about the same times, with about half the gain."""
    half, whole = followed_twice(SCENE, 100, STEPS, Cycle(FAR, 0), sampling())
    assert abs(len(half.path) / len(whole.path) - 1) < 0.02
    assert np.mean(half.gain) < np.mean(whole.gain)
