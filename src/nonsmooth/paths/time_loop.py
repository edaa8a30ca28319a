"""The loop over time steps, one for all schemes and scenes.

It advances the paths of one panel (see `kernels.panel`). When the loop is compiled, the type of the
coefficients it is given decides which scheme's `flow` and `kick` are called in it. It runs in
pieces, between which its thread can be stopped. This does not change any bit. Before threads run
it, the main thread compiles it, where Ctrl-C can interrupt that.
"""

import time
from collections.abc import Iterator
from typing import Any

import numba
import numpy as np
from numba.extending import intrinsic, overload

from nonsmooth.paths import tuning
from nonsmooth.paths.kernels.compilation import inlined, kernel
from nonsmooth.paths.kernels.panel import (
    BASE,
    BEFORE,
    DELTA,
    FLUSH,
    ROWS,
    WIDTH,
    Panel,
    flush,
    follow_extremes,
    observe,
    retire,
)
from nonsmooth.paths.kernels.random_numbers import normals
from nonsmooth.paths.kernels.vector_math import fma, like
from nonsmooth.paths.parallel import count
from nonsmooth.paths.schemes import registry

EVERYWHERE = (-np.inf, np.inf)  # levels that no path reaches


@intrinsic
def _pointer(typing, address):
    def generate(context, builder, signature, arguments):
        return context.cast(builder, arguments[0], address, signature.return_type)

    return numba.types.CPointer(address.dtype)(address), generate


def _flow(s, data, first, last, lanes):
    raise TypeError("flow is for kernels")


@overload(_flow)
def _choose_flow(s, data, first, last, lanes):
    chosen = registry.of_coefficients(s.instance_class).flow
    return lambda s, data, first, last, lanes: chosen(s, data, first, last, lanes)


def _kick(s, data, normal, lanes):
    raise TypeError("kick is for kernels")


@overload(_kick)
def _choose_kick(s, data, normal, lanes):
    chosen = registry.of_coefficients(s.instance_class).kick
    return lambda s, data, normal, lanes: chosen(s, data, normal, lanes)


@inlined
def _of_known_shape(panel):
    # Rows of a known length cannot overlap, which lets the compiler use vector instructions.
    return (
        numba.carray(_pointer(panel.words.ctypes), (4, WIDTH)),
        numba.carray(_pointer(panel.data.ctypes), (ROWS, WIDTH)),
        numba.carray(_pointer(panel.total.ctypes), (3, WIDTH)),
    )


def march(s: Any, panel: Panel, lanes: int, steps: int, lower: float, upper: float) -> int:
    """Advance the paths of a panel; drop those whose int g has reached one of the levels.

    Parameters
    ----------
    s : NamedTuple
        Coefficients of a scheme.
    panel : Panel
    lanes : int
        Number of paths.
    steps : int
    lower, upper : float
        Levels, infinite if there are none. After every `FLUSH` steps, and at the end, the extremes
        of int g over all steps so far are compared with them.

    Returns
    -------
    int
        Number of paths left, in the first lanes.
    """
    for first, last in _pieces(steps + 1):
        lanes = _march(s, panel, lanes, first, last, steps, lower, upper)
        count(last - first)
    return lanes


def compile_march(s: Any, panel: Panel) -> None:
    """Compile `march` for the coefficients of a scheme and the precision of a panel."""
    march(s, panel, 0, 0, *EVERYWHERE)


def _pieces(steps: int) -> Iterator[tuple[int, int]]:
    """Divide the steps of a loop into pieces that last long enough for Python not to matter.

    Their lengths are multiples of `FLUSH`, so that the division changes no bit.
    """
    first, length = 0, FLUSH
    while first < steps:
        began = time.perf_counter()
        yield first, min(first + length, steps)
        first += length
        if time.perf_counter() - began < tuning.INTERRUPTION.piece:
            length *= 2


@kernel
def _march(s, panel, lanes, first, last, steps, lower, upper):
    """Advance the paths of a panel by the steps from `first` up to `last`."""
    words, data, total = _of_known_shape(panel)
    normal = 2
    for k in range(first, last):
        _flow(s, data, k == 0, k == steps, lanes)
        if k == steps:
            observe(data, lanes)  # what the last flow has added to int g
        else:
            if normal >= 2:
                normals(words, data, lanes)
                if s.normals == 4:
                    normals(words, data[2:], lanes)
                normal = 0
            _kick(s, data, normal, lanes)
            normal += s.normals
        if lower != -upper:  # for levels -b and b, max |int g| is enough, which is kept anyway
            follow_extremes(data, lanes)
        if (k + 1) % FLUSH == 0 or k == steps:
            flush(data, total, lanes)
            if lower > -np.inf or upper < np.inf:
                lanes = retire(words, data, total, lanes, lower, upper)
    return lanes


def march_pair(
    fine: Any,
    coarse: Any,
    panel: Panel,
    other: Panel,
    lanes: int,
    steps: int,
    lower: float,
    upper: float,
    began: float,
    passage: np.ndarray,
) -> None:
    """Advance two panels on the same noise, the second with steps twice as long.

    Parameters
    ----------
    fine, coarse : NamedTuple
        Coefficients of a scheme, of steps h/2 and h; the coarse ones take increments as given.
    panel, other : Panel
        Of the fine and of the coarse paths. Random numbers are drawn from the generators of the
        first.
    lanes : int
        Number of paths.
    steps : int
        Of the coarse paths.
    lower, upper : float
        Levels, infinite if there are none.
    began : float
        Time of the first step.
    passage : array, shape (2, l)
        Times at which int g first reaches one of the levels, of the fine and of the coarse paths,
        interpolated within a step; inf before.
    """
    for first, last in _pieces(2 * steps + 1):
        _march_pair(
            fine, coarse, panel, other, lanes, first, last, steps, lower, upper, began, passage
        )
        count(last - first)


@kernel
def _march_pair(
    fine, coarse, panel, other, lanes, first, last, steps, lower, upper, began, passage
):
    """Advance two panels by the fine steps from `first` up to `last`."""
    words, data, total = _of_known_shape(panel)
    _, joined, other_total = _of_known_shape(other)
    a, b, c, d = fine.transition
    e, f, g = fine.factor
    for k in range(first, last):  # counts the fine steps
        odd = k % 2 == 1
        now = began + (k // 2) * float(coarse.step)
        _flow(fine, data, k == 0, k == 2 * steps, lanes)
        if not odd:
            _flow(coarse, joined, k == 0, k == 2 * steps, lanes)
        if k == 2 * steps:
            observe(data, lanes)
            observe(joined, lanes)
        else:
            normal = 1 if odd and fine.normals == 1 else 0
            if normal == 0:
                normals(words, data, lanes)
            # join the noise of two fine steps to that of one coarse step, see `scheme.Coefficients`
            for i in range(lanes):
                first = data[normal, i]
                second = data[1, i] if fine.normals == 2 else like(e, 0.0)
                early = joined[0, i] if odd else like(e, 0.0)
                also = joined[1, i] if odd else like(e, 0.0)
                joined[0, i] = fma(a, early, fma(b, also, fma(e, first, early)))
                joined[1, i] = fma(c, early, fma(d, also, fma(f, first, fma(g, second, also))))
            _kick(fine, data, normal, lanes)
            start = now + fine.step if odd else now
            _note_passage(data, passage[0], lanes, lower, upper, start, fine.step)
            if odd:
                _kick(coarse, joined, 0, lanes)
                _note_passage(joined, passage[1], lanes, lower, upper, now, coarse.step)
        if (k + 1) % FLUSH == 0 or k == 2 * steps:
            flush(data, total, lanes)
            flush(joined, other_total, lanes)


def compile_march_pair(fine: Any, coarse: Any, panel: Panel) -> None:
    """Compile `march_pair` for two sets of coefficients and the precision of a panel."""
    march_pair(fine, coarse, panel, panel, 0, 0, *EVERYWHERE, 0.0, np.empty((2, 0)))


@inlined
def _note_passage(data, passage, lanes, lower, upper, now, step):
    """Record the paths that have reached one of the levels within a step."""
    for i in range(lanes):
        before, after = data[BEFORE, i], data[BASE, i] + data[DELTA, i]
        if (after >= upper or after <= lower) and passage[i] == np.inf:
            level = upper if after >= upper else lower
            passage[i] = now + step * (level - before) / (after - before)
        data[BEFORE, i] = after
