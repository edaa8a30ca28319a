"""Random streams: one for each block of 1000 paths, derived from (seed, scene, block).

The generator is xoshiro128++ 1.0 (D. Blackman, S. Vigna, ACM Trans. Math. Softw. 47, 2021):
128 bits of state and 32 bits per draw, which suits the 32-bit units of vector instructions. Each
path has a generator of its own; the 128 bits that seed each are drawn from SFC64, which numpy's
SeedSequence seeds with (seed, scene, block). Two draws become two normal numbers (Box and Muller
1958); the first has a resolution of 2^-32, so that they reach 6.66 standard deviations.

The penalization n does not enter: scenes that differ only in n are driven by the same noise.
"""

import hashlib
import math

import numpy as np

from nonsmooth.paths.kernels import vector_math
from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.instructions import fma, like
from nonsmooth.scenes.scene import Scene

BLOCK = 1000  # paths per stream; changing it changes every Monte Carlo result
_U = np.uint32


def generator_words(scene: Scene, seed: int | tuple, block: int) -> np.ndarray:
    """Return the initial states of the generators of one block of paths.

    Parameters
    ----------
    scene : Scene
    seed : int or tuple
        A non-negative number, or (number, label, ...) for an ensemble of its own.
    block : int
        Index of the block, counted from the first path of the whole ensemble.

    Returns
    -------
    numpy.ndarray of uint32, shape (4, BLOCK)
    """
    entropy, *labels = seed if isinstance(seed, tuple) else (seed,)
    identity = repr((scene.identity, labels)).encode()
    key = int.from_bytes(hashlib.sha256(identity).digest()[:8], "big")
    sequence = np.random.SeedSequence(int(entropy), spawn_key=(key, block))
    words = np.random.SFC64(sequence).random_raw(2 * BLOCK).astype("<u8").view(np.uint32)
    return np.ascontiguousarray(words.reshape(BLOCK, 4).T)


def blocks(first: int, count: int) -> list[tuple[int, int]]:
    """Split `count` paths from path number `first` on into (block, paths) pairs.

    Raises
    ------
    ValueError
        If `first` is not at the start of a block.
    """
    if first % BLOCK:
        raise ValueError(f"paths start at a multiple of {BLOCK}, got {first}")
    return [((first + done) // BLOCK, min(BLOCK, count - done)) for done in range(0, count, BLOCK)]


def labelled(seed: int | tuple, label: str | int) -> tuple:
    """Return the seed of another ensemble, whose paths are independent of those of `seed`."""
    return (*seed, label) if isinstance(seed, tuple) else (seed, label)


@inlined
def _rotate(word, bits):
    return _U(_U(word << _U(bits)) | _U(word >> _U(32 - bits)))


@inlined
def draw(a, b, c, d):
    """Return 32 random bits and the generator's next state."""
    value = _U(_rotate(_U(a + d), 7) + a)
    shifted = _U(b << _U(9))
    c, d = _U(c ^ a), _U(d ^ b)
    b, a = _U(b ^ c), _U(a ^ d)
    return value, a, b, _U(c ^ shifted), _rotate(d, 11)


@inlined
def _box_muller(like_this, first, second):
    """Two independent normal numbers from 64 random bits."""
    uniform = fma(
        like(like_this, np.int32(first >> _U(1))),
        like(like_this, 2.0**-31),
        like(like_this, 2.0**-32),
    )
    radius = math.sqrt(like(like_this, -2.0) * vector_math.log(uniform))
    quadrant = _U(_U(second + _U(1 << 29)) >> _U(30))
    rest = np.int32(_U(second - _U(quadrant << _U(30))))
    sine, cosine = vector_math.sincos_in_quadrant(
        quadrant, like(like_this, rest) * like(like_this, 2.0**-31 * math.pi)
    )
    return radius * cosine, radius * sine


@inlined
def normals(words, out, lanes):
    """Fill out[0] and out[1] with independent standard normal numbers.

    Each lane has its own generator, from which its two numbers are drawn.

    Parameters
    ----------
    words : array of uint32, shape (4, l)
        Generator states, advanced in place.
    out : array, shape (2 or more, l)
    lanes : int
        At most l.
    """
    for i in range(lanes):
        a, b, c, d = words[0, i], words[1, i], words[2, i], words[3, i]
        first, a, b, c, d = draw(a, b, c, d)
        second, a, b, c, d = draw(a, b, c, d)
        words[0, i], words[1, i], words[2, i], words[3, i] = a, b, c, d
        out[0, i], out[1, i] = _box_muller(out[0, i], first, second)
