"""A panel: the paths of one block side by side in arrays that fit into a core's cache.

Each path has a column of its own, called a lane. Loops over lanes have no branches and no calls, so
that the compiler turns them into vector instructions. Time integrals are added up in the precision
of the steps for a few steps (see `FLUSH`), and these sums in double precision.
"""

from typing import NamedTuple

import numpy as np

from nonsmooth.paths.kernels.compilation import inlined, kernel
from nonsmooth.paths.kernels.instructions import larger, smaller
from nonsmooth.paths.kernels.random_numbers import BLOCK, generator_words
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES

FLUSH = 64  # steps after which integrals are added in double precision

_CACHE_LINE = 64  # bytes
# Length of a row: a bit more than the number of paths, so that in single precision it is an
# odd number of cache lines. The same column of different rows then lies in different sets of the
# cache, and rows do not push each other out.
WIDTH = 1008

# Rows of `data`. 0 to 3: normal numbers. 4 to 7: the state. 8 to 15: scratch. From 16 on:
# GAIN, what the step adds to int g; DELTA, int g since the last flush; MARTINGALE, its martingale
# part, and VARIATION, the quadratic variation of that, since then; BASE, int g at the last flush;
# PEAK, max |int g|; BEFORE, int g one step earlier; LOW and HIGH, its extremes where followed.
STATE = ZETA, ETA, Y, X = 4, 5, 6, 7
WORK = 8
GAIN, DELTA, MARTINGALE, VARIATION, BASE, PEAK, BEFORE, LOW, HIGH = range(16, 25)
ROWS = 25
# Rows of `total`: int g, its martingale part and the variation, up to the last flush.
TOTAL_DELTA, TOTAL_MARTINGALE, TOTAL_VARIATION = range(3)


class Panel(NamedTuple):
    """Arrays of one block of paths, one lane each.

    The kernels see them with a fixed shape: the compiler then knows that rows do not overlap.

    Attributes
    ----------
    words : uint32 (4, WIDTH)
        The generators' states.
    data : float32 or float64 (ROWS, WIDTH)
    total : float64 (3, WIDTH)
    left : int64 (1,)
        How many normal numbers in the first two rows of `data` `time_loop.march` has not used.
    """

    words: np.ndarray
    data: np.ndarray
    total: np.ndarray
    left: np.ndarray


def new_panel(scene: Scene, seed: int | tuple, block: int, precision: str = "float32") -> Panel:
    """Return the panel of a block at time 0.

    Parameters
    ----------
    scene : Scene
    seed : int or tuple
    block : int
    precision : {"float32", "float64"}
    """
    data = _aligned(ROWS, precision)
    for row, symbol in zip(STATE, STATE_VARIABLES, strict=True):
        data[row] = scene.start.get(symbol.name, 0.0)
    words = _aligned(4, "uint32")
    words[:, :BLOCK] = generator_words(scene, seed, block)
    return Panel(words, data, _aligned(3, "float64"), np.zeros(1, dtype=np.int64))


def _aligned(rows, kind):
    """Zeros whose rows begin with a cache line, so that no vector lies across two of them."""
    size = rows * WIDTH * np.dtype(kind).itemsize
    memory = np.zeros(size + _CACHE_LINE, dtype=np.uint8)
    first = -memory.ctypes.data % _CACHE_LINE
    return memory[first : first + size].view(kind).reshape(rows, WIDTH)


def extremes(panel: Panel, lanes: int, symmetric: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the smallest and the largest int g of the first lanes so far, in double precision.

    Parameters
    ----------
    panel : Panel
    lanes : int
    symmetric : bool
        Whether only max |int g| was kept, and -max |int g| stands for the smallest.

    Returns
    -------
    low, high : numpy.ndarray, shape (lanes,)
    """
    low, high, peak = panel.data[[LOW, HIGH, PEAK], :lanes].astype(float)
    return (-peak, peak) if symmetric else (low, high)


@inlined
def observe(data, lanes):
    """Add the step's gain to int g and keep track of its largest absolute value."""
    for i in range(lanes):
        delta = data[DELTA, i] + data[GAIN, i]
        data[DELTA, i] = delta
        data[PEAK, i] = larger(data[PEAK, i], abs(data[BASE, i] + delta))
        data[GAIN, i] = 0


@inlined
def flush(data, total, lanes):
    """Move what has gathered since the last flush to `total`."""
    for i in range(lanes):
        total[TOTAL_DELTA, i] += data[DELTA, i]
        total[TOTAL_MARTINGALE, i] += data[MARTINGALE, i]
        total[TOTAL_VARIATION, i] += data[VARIATION, i]
        data[DELTA, i] = data[MARTINGALE, i] = data[VARIATION, i] = 0
        data[BASE, i] = total[TOTAL_DELTA, i]


@inlined
def follow_extremes(data, lanes):
    """Keep track of the smallest and the largest int g, after `observe`."""
    for i in range(lanes):
        value = data[BASE, i] + data[DELTA, i]
        data[LOW, i] = smaller(data[LOW, i], value)
        data[HIGH, i] = larger(data[HIGH, i], value)


@kernel
def retire(words, data, total, lanes, lower, upper):
    """Drop the paths whose int g has reached one of the levels; return how many are left.

    The last lane takes the place of a dropped one, so that those left stay side by side. A path
    that has become infinite is not dropped, so that the divergence is noticed at the end.
    """
    symmetric = lower == -upper
    i = 0
    while i < lanes:
        low = -data[PEAK, i] if symmetric else data[LOW, i]
        high = data[PEAK, i] if symmetric else data[HIGH, i]
        if (low <= lower or high >= upper) and -np.inf < low and high < np.inf:
            lanes -= 1
            _copy(words, lanes, i)
            _copy(data, lanes, i)
            _copy(total, lanes, i)
        else:
            i += 1
    return lanes


@inlined
def _copy(rows, lane, to):
    # an assignment of slices would be compiled with a message about their shapes: seconds
    for row in range(len(rows)):
        rows[row, to] = rows[row, lane]
