"""The generator is the published one, its normal numbers are normal, its streams are apart."""

import numba
import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from nonsmooth.paths.kernels import random_numbers
from nonsmooth.paths.kernels.random_numbers import BLOCK, blocks, generator_words, normals
from references import FALSE_ALARM, FRICTION

# from the state (1, 2, 3, 4): the reference implementation's vector, as the Rust crate
# rand_xoshiro quotes it, and the draw after 102400 draws, as PHP's test of user engines does
FIRST = [
    641,
    1573767,
    3222811527,
    3517856514,
    836907274,
    4247214768,
    3867114732,
    1355841295,
    495546011,
    621204420,
]
LATE = 0x2C873CFA


@numba.njit
def draws(count):
    """Draw from the state (1, 2, 3, 4)."""
    a, b, c, d = np.uint32(1), np.uint32(2), np.uint32(3), np.uint32(4)
    out = np.empty(count, dtype=np.uint32)
    for i in range(count):
        out[i], a, b, c, d = random_numbers.draw(a, b, c, d)
    return out


@pytest.fixture(scope="module")
def sample():
    """Return 1e7 normal numbers, (draw, lane), lanes being streams of several blocks."""
    lanes = np.hstack([generator_words(FRICTION, 7, block) for block in range(4)])
    out = np.empty((2, lanes.shape[1]), dtype=np.float32)
    drawn = []
    for _ in range(10_000_000 // out.size + 1):
        normals(lanes, out, lanes.shape[1])
        drawn.append(out.copy())
    return np.concatenate(drawn).astype(float)


def test_known_answers():
    """Published vectors of xoshiro128++ 1.0."""
    numbers = draws(102_401)
    assert list(numbers[:10]) == FIRST
    assert numbers[-1] == LATE


@pytest.mark.slow
def test_moments(sample):
    """The first six moments, each within z standard errors of the normal's."""
    z = stats.norm.isf(FALSE_ALARM / 2 / 6)
    for k, (moment, square) in enumerate(
        [(0, 1), (1, 3), (0, 15), (3, 105), (0, 945), (15, 10395)], start=1
    ):
        error = np.sqrt((square - moment**2) / sample.size)
        assert abs(np.mean(sample**k) - moment) < z * error


def test_law(sample):
    """Kolmogorov-Smirnov against the normal law."""
    assert stats.kstest(sample.ravel(), "norm").pvalue > FALSE_ALARM


def test_tails(sample):
    """Numbers beyond 1, 2, ... 5.5 on either side are Poisson about what is expected."""
    for level in (1, 2, 3, 4, 5, 5.5):
        expected = sample.size * stats.norm.sf(level)
        for count in (np.sum(sample > level), np.sum(sample < -level)):
            p = min(stats.poisson.cdf(count, expected), stats.poisson.sf(count - 1, expected))
            assert p > FALSE_ALARM / 24


def test_no_correlation(sample):
    """Neighbouring draws, neighbouring lanes and neighbouring streams; so are their squares."""
    z = stats.norm.isf(FALSE_ALARM / 2 / 10)
    standard = sample
    squared = (sample**2 - 1) / np.sqrt(2)
    for numbers in (standard, squared):
        for a, b in (
            (numbers[:-1], numbers[1:]),
            (numbers[:-2], numbers[2:]),
            (numbers[:, :-1], numbers[:, 1:]),
            (numbers[:, :-BLOCK], numbers[:, BLOCK:]),
            (numbers[1:, :-1], numbers[:-1, 1:]),
        ):
            assert abs(np.mean(a * b)) * np.sqrt(a.size) < z


def test_precisions_share_their_noise():
    """The same bits become the same normal numbers, to single precision."""
    words = generator_words(FRICTION, 3, 0)
    single, double = np.empty((2, BLOCK), np.float32), np.empty((2, BLOCK))
    normals(words.copy(), single, BLOCK)
    normals(words.copy(), double, BLOCK)
    assert np.allclose(single, double, atol=4e-6, rtol=0)


def test_streams_are_derived_from_seed_scene_and_block_only():
    """Streams differ by seed, scene and block; n and the spelling of a number do not enter."""
    damped = ns.Scene("friction", damping=2.0)
    keys = [(s, seed, b) for s in (FRICTION, damped) for seed in (1, 2, (1, "a")) for b in (0, 1)]
    states = np.hstack([generator_words(*key) for key in keys])
    assert len(np.unique(states, axis=1).T) == states.shape[1]
    again = generator_words(ns.Scene("friction", n=3, damping=1), np.int64(1), 0)
    assert np.array_equal(again, generator_words(FRICTION, 1, 0))


def test_blocks():
    """Parts of an ensemble start where a stream starts."""
    assert blocks(BLOCK, BLOCK + 5) == [(1, BLOCK), (2, 5)]
    with pytest.raises(ValueError, match="multiple"):
        blocks(17, 100)
