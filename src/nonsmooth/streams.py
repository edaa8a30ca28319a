"""Random streams: one per fixed-size block of paths, derived from (seed, scene, block).

The penalization n does not enter: scenes that differ only in n are driven by the same noise.
"""

import hashlib
from numbers import Integral

import numpy as np

from nonsmooth.errors import SceneError

BLOCK = 5_000  # paths per stream; changing it changes every Monte Carlo result


def generator(scene, seed, block):
    """Return the generator of one block of paths.

    Parameters
    ----------
    scene : Scene
    seed : int or tuple
        A non-negative number, or (number, label, ...) for an ensemble of its own.
    block : int
        Index of the block, counted from the first path of the whole ensemble.

    Returns
    -------
    numpy.random.Generator
        SFC64, seeded through numpy's SeedSequence.

    Raises
    ------
    SceneError
        If the seed is not a non-negative integer.
    """
    entropy, *labels = seed if isinstance(seed, tuple) else (seed,)
    if not (isinstance(entropy, Integral) and entropy >= 0):
        raise SceneError(f"a seed is a non-negative integer, got {entropy!r}; choose one")
    identity = repr((scene.identity, labels)).encode()
    key = int.from_bytes(hashlib.sha256(identity).digest()[:8], "big")
    sequence = np.random.SeedSequence(int(entropy), spawn_key=(key, block))
    return np.random.Generator(np.random.SFC64(sequence))


def blocks(first, count):
    """Split `count` paths from path number `first` on into (block, paths) pairs.

    Raises
    ------
    ValueError
        If `first` is not at the start of a block.
    """
    if first % BLOCK:
        raise ValueError(f"paths start at a multiple of {BLOCK}, got {first}")
    return [((first + done) // BLOCK, min(BLOCK, count - done)) for done in range(0, count, BLOCK)]
