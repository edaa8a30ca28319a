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
from nonsmooth.paths.kernels.compilation import announced, inlined, kernel, merged
from nonsmooth.paths.kernels.instructions import fma, larger, like, smaller
from nonsmooth.paths.kernels.panel import (
    BASE,
    BEFORE,
    DELTA,
    FLUSH,
    HIGH,
    LOW,
    ROWS,
    TOTAL_DELTA,
    TOTAL_MARTINGALE,
    TOTAL_VARIATION,
    WIDTH,
    Panel,
    flush,
    follow_extremes,
    observe,
    retire,
)
from nonsmooth.paths.kernels.random_numbers import normals
from nonsmooth.paths.parallel import count
from nonsmooth.paths.schemes import registry

EVERYWHERE = (-np.inf, np.inf)  # levels that no path reaches
_ABREAST = WIDTH // 9  # lanes whose sums are kept side by side, so that they vectorise
_NO_SUMS, _NO_CHANGES = np.empty((0, 5, 5)), np.empty((0, 4, 4))
_APART = np.ones((1, 2), dtype=bool)  # the ends of an interval that begins and ends with half-flows


@intrinsic
def pointer(typing, address):
    """Return an array's `.ctypes` as a pointer, which has no shape yet."""

    def generate(context, builder, signature, arguments):
        return context.cast(builder, arguments[0], address, signature.return_type)

    return numba.types.CPointer(address.dtype)(address), generate


def mechanical_flow(s, data, first, last, lanes):
    """Apply, in kernels, the flow of the scheme whose coefficients are given."""
    raise TypeError("mechanical_flow is for kernels")


@overload(mechanical_flow)
def _choose_flow(s, data, first, last, lanes):
    chosen = registry.of_coefficients(s.instance_class).flow
    return lambda s, data, first, last, lanes: chosen(s, data, first, last, lanes)


def noise_kick(s, data, normal, lanes):
    """Apply, in kernels, the kick of the scheme whose coefficients are given."""
    raise TypeError("noise_kick is for kernels")


@overload(noise_kick)
def _choose_kick(s, data, normal, lanes):
    chosen = registry.of_coefficients(s.instance_class).kick
    return lambda s, data, normal, lanes: chosen(s, data, normal, lanes)


@inlined
def of_known_shape(panel):
    """Return the panel's three arrays; rows of a known length cannot overlap, so they vectorise."""
    return (
        numba.carray(pointer(panel.words.ctypes), (4, WIDTH)),
        numba.carray(pointer(panel.data.ctypes), (ROWS, WIDTH)),
        numba.carray(pointer(panel.total.ctypes), (3, WIDTH)),
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
    for first, last in pieces(steps + 1):
        course = first, last, steps
        lanes = _march(s, panel, lanes, course, lower, upper, _NO_SUMS, _APART)
        count(last - first)
    return lanes


def march_and_sum(
    s: Any, panel: Panel, lanes: int, steps: int, sums: np.ndarray, joined: bool
) -> None:
    """Advance the paths of a panel through intervals of equal length; sum up at the end of each.

    Parameters
    ----------
    s : NamedTuple
        Coefficients of a scheme.
    panel : Panel
    lanes : int
        Number of paths.
    steps : int
        Of each interval.
    sums : array, shape (intervals, 5, 5)
        To which the products of (1, D, D^2, M, M^2 - <M>) of all paths are added.
    joined : bool
        Whether the half-flows on both sides of an output time may be one flow, which is faster:
        int g must be complete after a kick.
    """
    if steps > FLUSH:  # long enough for Python not to matter, and to be stopped within
        for own in sums:
            march(s, panel, lanes, steps, *EVERYWHERE)
            _march(s, panel, lanes, (0, 0, 0), *EVERYWHERE, own[None], _APART)
        return
    ends, course = _ends(len(sums), joined), (0, steps + 1, steps)
    for first, last in pieces(len(sums)):
        some = slice(first, last)
        _march(s, panel, lanes, course, *EVERYWHERE, sums[some], ends[some])
        count((last - first) * steps)


def _ends(intervals, joined):
    """Tell for each interval whether it begins and whether it ends with a half-flow."""
    ends = np.ones((intervals, 2), dtype=bool)
    if joined:
        ends[1:, 0] = ends[:-1, 1] = False
    return ends


def compile_march(s: Any, panel: Panel) -> None:
    """Compile `march` for the coefficients of a scheme and the precision of a panel."""
    with announced(_march):
        march(s, panel, 0, 0, *EVERYWHERE)


def pieces(steps: int) -> Iterator[tuple[int, int]]:
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
def _march(s, panel, lanes, course, lower, upper, sums, ends):
    """Advance the paths of a panel by the steps from `first` up to `last`.

    If sums are wanted, do so as often as there are, and add to the next ones each time.
    """
    arrays = of_known_shape(panel)
    total = arrays[2]
    for interval in range(max(len(sums), 1)):
        lanes = _advance(s, arrays, panel.left, lanes, course, ends[interval], lower, upper)
        if len(sums) > 0:
            _add_products(_moments, total, total, lanes, sums[interval])
    return lanes


@merged
def _advance(s, arrays, left, lanes, course, ends, lower, upper):
    words, data, total = arrays
    first, last, steps = course
    last -= not ends[1]
    normal = 2 - left[0]
    for k in range(first, last):
        mechanical_flow(s, data, ends[0] and k == 0, k == steps, lanes)
        if k == steps:
            observe(data, lanes)  # what the last flow has added to int g
        else:
            if normal >= 2:
                normals(words, data, lanes)
                if s.normals == 4:
                    normals(words, data[2:], lanes)
                normal = 0
            noise_kick(s, data, normal, lanes)
            normal += s.normals
        if lower != -upper:  # for levels -b and b, max |int g| is enough, which is kept anyway
            follow_extremes(data, lanes)
        if (k + 1) % FLUSH == 0 or k + 1 == last:
            flush(data, total, lanes)
            if lower > -np.inf or upper < np.inf:
                lanes = retire(words, data, total, lanes, lower, upper)
    left[0] = max(2 - normal, 0)
    return lanes


@inlined
def _moments(total, other, lane):
    """Return D, D^2, M and M^2 - <M> of a path."""
    d, m = total[TOTAL_DELTA, lane], total[TOTAL_MARTINGALE, lane]
    return d, d * d, m, fma(m, m, -total[TOTAL_VARIATION, lane])


@inlined
def _changes(total, other, lane):
    """Return D' - D, D'^2 - D^2 and D of a path, D' the other's, and 0."""
    d, after = total[TOTAL_DELTA, lane], other[TOTAL_DELTA, lane]
    return after - d, after * after - d * d, d, 0.0


@inlined
def _add_products(values, total, other, lanes, sums):
    """Add the products of 1 and the four values of a path, or as many as wanted, over all paths.

    The lanes without a path have zeros in them.
    """
    memory = np.empty((14, _ABREAST))  # read in the end, so that it is kept until then
    partial = numba.carray(pointer(memory.ctypes), (14, _ABREAST))
    for j in range(_ABREAST):
        a = b = c = d = aa = ab = ac = ad = bb = bc = bd = cc = cd = dd = 0.0
        for begin in range(0, WIDTH, _ABREAST):
            p, q, r, t = values(total, other, begin + j)
            a, b, c, d = a + p, b + q, c + r, d + t
            aa, ab, ac, ad = fma(p, p, aa), fma(p, q, ab), fma(p, r, ac), fma(p, t, ad)
            bb, bc, bd = fma(q, q, bb), fma(q, r, bc), fma(q, t, bd)
            cc, cd, dd = fma(r, r, cc), fma(r, t, cd), fma(t, t, dd)
        partial[0, j], partial[1, j], partial[2, j], partial[3, j] = a, b, c, d
        partial[4, j], partial[5, j], partial[6, j], partial[7, j] = aa, ab, ac, ad
        partial[8, j], partial[9, j], partial[10, j] = bb, bc, bd
        partial[11, j], partial[12, j], partial[13, j] = cc, cd, dd
    left = _ABREAST
    while left % 2 == 0:
        left //= 2
        for k in range(14):
            for j in range(left):
                partial[k, j] += partial[k, left + j]
    _add_symmetric(memory, lanes, left, sums)


@inlined
def _add_symmetric(partial, lanes, left, sums):
    """Add to a matrix what is left to sum of its upper triangle, row by row after the first entry.

    The matrix may be smaller, without the last rows and columns.
    """
    sums[0, 0] += lanes
    k = 0
    for i in range(5):
        for j in range(max(i, 1), 5):
            if j < len(sums):
                value = 0.0
                for part in range(left):
                    value += partial[k, part]
                sums[i, j] += value
                if i != j:
                    sums[j, i] += value
            k += 1


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
        interpolated within a step; inf before. With l = 0 neither these nor the extremes of int g
        are followed.
    """
    levels = lower, upper
    for first, last in pieces(2 * steps + 1):
        pair = fine, coarse, panel, other, lanes, first, last, steps
        _march_pair(*pair, *levels, began, 0.0, passage, _NO_CHANGES, _APART)
        count(last - first)


def march_pair_and_sum(
    fine: Any,
    coarse: Any,
    panel: Panel,
    other: Panel,
    lanes: int,
    steps: int,
    levels: tuple[float, float],
    began: float,
    span: float,
    passage: np.ndarray,
    sums: np.ndarray,
    joined: bool,
) -> None:
    """Advance two panels through intervals of equal length; sum up at the end of each.

    Parameters
    ----------
    fine, coarse, panel, other, lanes, began, passage
        As for `march_pair`.
    steps : int
        Coarse ones of each interval.
    levels : (float, float)
    span : float
        Length of an interval.
    sums : array, shape (intervals, 4, 4)
        To which the products of (1, D_h - D_h/2, D_h^2 - D_h/2^2, D_h/2) of all paths are added.
    joined : bool
        As for `march_and_sum`.
    """
    if steps > FLUSH:
        for k, own in enumerate(sums):
            at = began + k * span
            march_pair(fine, coarse, panel, other, lanes, steps, *levels, at, passage)
            pair = fine, coarse, panel, other, lanes, 0, 0, 0
            _march_pair(*pair, *levels, at, span, passage, own[None], _APART)
        return
    ends = _ends(len(sums), joined)
    for first, last in pieces(len(sums)):
        pair = fine, coarse, panel, other, lanes, 0, 2 * steps + 1, steps
        some, at = slice(first, last), began + first * span
        _march_pair(*pair, *levels, at, span, passage, sums[some], ends[some])
        count((last - first) * 2 * steps)


@kernel
def _march_pair(
    fine,
    coarse,
    panel,
    other,
    lanes,
    first,
    last,
    steps,
    lower,
    upper,
    began,
    span,
    passage,
    sums,
    ends,
):
    """Advance two panels by the fine steps from `first` up to `last`.

    If sums are wanted, do so as often as there are, and add to the next ones each time.
    """
    words, data, total = of_known_shape(panel)
    _, joined, other_total = of_known_shape(other)
    arrays = words, data, total, joined, other_total
    for interval in range(max(len(sums), 1)):
        now = began + interval * span
        begins, stops = ends[interval]
        course = first, last if stops else last - 1, steps, begins
        _advance_pair(fine, coarse, arrays, lanes, course, lower, upper, now, passage)
        if len(sums) > 0:
            _add_products(_changes, total, other_total, lanes, sums[interval])


@merged
def _advance_pair(fine, coarse, arrays, lanes, course, lower, upper, began, passage):
    words, data, total, joined, other_total = arrays
    first, last, steps, begins = course
    followed = passage.shape[1] > 0
    for k in range(first, last):  # counts the fine steps
        odd = k % 2 == 1
        now = began + (k // 2) * float(coarse.step)
        flow_of_pair(fine, coarse, data, joined, k, 2 * steps, begins, lanes)
        if k < 2 * steps:
            normal = draw(fine, words, data, odd, lanes)
            join_noise(fine, data, joined, normal, odd, lanes)
            noise_kick(fine, data, normal, lanes)
            if odd:
                noise_kick(coarse, joined, 0, lanes)
            if followed:
                start = now + fine.step if odd else now
                _note_passage(data, passage[0], lanes, lower, upper, start, fine.step)
                if odd:
                    _note_passage(joined, passage[1], lanes, lower, upper, now, coarse.step)
        if (k + 1) % FLUSH == 0 or k + 1 == last:
            flush(data, total, lanes)
            flush(joined, other_total, lanes)


@merged
def flow_of_pair(fine, coarse, data, joined, k, last, begins, lanes):
    """Let two panels flow for what is due at the k-th fine step; at the last int g is completed.

    Parameters
    ----------
    fine, coarse : NamedTuple
        Coefficients of the fine and of the coarse step.
    data, joined : array
        Of the fine and of the coarse paths.
    k, last : int
    begins : bool
        Whether the flow at k = 0 is a half-flow.
    lanes : int
    """
    begins = begins and k == 0
    mechanical_flow(fine, data, begins, k == last, lanes)
    if k % 2 == 0:
        mechanical_flow(coarse, joined, begins, k == last, lanes)
    if k == last:
        observe(data, lanes)
        observe(joined, lanes)


@inlined
def draw(fine, words, data, odd, lanes):
    """Draw normal numbers unless some are left, and return the row that has those of this step.

    Parameters
    ----------
    fine : NamedTuple
        Coefficients of the fine step.
    words, data : array
        Generators and values of a panel.
    odd : bool
        Whether the step is the second of a coarse one.
    lanes : int
    """
    normal = 1 if odd and fine.normals == 1 else 0
    if normal == 0:
        normals(words, data, lanes)
    return normal


@inlined
def join_noise(fine, data, joined, normal, odd, lanes):
    """Join the noise of two fine steps to that of a coarse one, see `scheme.Coefficients`.

    Parameters
    ----------
    fine : NamedTuple
        Coefficients of the fine step.
    data, joined : array
        Of the fine and of the coarse paths.
    normal : int
        Row of `data` with the normal numbers of the fine step.
    odd : bool
        Whether it is the second of the two.
    lanes : int
    """
    a, b, c, d = fine.transition
    e, f, g = fine.factor
    for i in range(lanes):
        first = data[normal, i]
        second = data[1, i] if fine.normals == 2 else like(e, 0.0)
        early = joined[0, i] if odd else like(e, 0.0)
        also = joined[1, i] if odd else like(e, 0.0)
        joined[0, i] = fma(a, early, fma(b, also, fma(e, first, early)))
        joined[1, i] = fma(c, early, fma(d, also, fma(f, first, fma(g, second, also))))


def compile_march_pair(fine: Any, coarse: Any, panel: Panel) -> None:
    """Compile `march_pair` for two sets of coefficients and the precision of a panel."""
    with announced(_march_pair):
        march_pair(fine, coarse, panel, panel, 0, 0, *EVERYWHERE, 0.0, np.empty((2, 0)))


@inlined
def _note_passage(data, passage, lanes, lower, upper, now, step):
    """Record the paths that have reached one of the levels within a step, and their extremes."""
    for i in range(lanes):
        before, after = data[BEFORE, i], data[BASE, i] + data[DELTA, i]
        data[LOW, i] = smaller(data[LOW, i], after)
        data[HIGH, i] = larger(data[HIGH, i], after)
        if (after >= upper or after <= lower) and passage[i] == np.inf:
            level = upper if after >= upper else lower
            passage[i] = now + step * (level - before) / (after - before)
        data[BEFORE, i] = after
