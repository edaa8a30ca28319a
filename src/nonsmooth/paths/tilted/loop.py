"""The loop over time steps of paths whose noise is shifted towards a level.

Before each kick the normal number xi of a path becomes xi + a, where a may depend on all that has
happened to the path. The logarithm of the likelihood ratio gains -a xi - a^2 / 2, so that weighted
averages are exactly those of the scheme without the shift, whatever a is. Hence a is computed anew
only after a time in which the state changes little: it costs more than a step. A path that has
reached a level is not shifted any more.
"""

import math
from typing import Any

import numba
import numpy as np

from nonsmooth.paths.kernels.compilation import announced, inlined, kernel
from nonsmooth.paths.kernels.instructions import fma, like, maximum, minimum, where
from nonsmooth.paths.kernels.panel import (
    BASE,
    BEFORE,
    DELTA,
    FLUSH,
    MARTINGALE,
    STATE,
    TOTAL_MARTINGALE,
    WIDTH,
    Panel,
    flush,
    observe,
)
from nonsmooth.paths.kernels.random_numbers import normals
from nonsmooth.paths.parallel import count
from nonsmooth.paths.tilted.tilt import Tilt
from nonsmooth.paths.time_loop import (
    draw,
    flow_of_pair,
    join_noise,
    mechanical_flow,
    noise_kick,
    of_known_shape,
    pieces,
    pointer,
)

# Rows of a panel that have another meaning here: the logarithm of the likelihood ratio, and which
# level a path has reached: 1 for the upper, -1 for the lower one, 0 while it is on its way.
LOG_WEIGHT, REACHED = MARTINGALE, BEFORE
TOTAL_LOG_WEIGHT = TOTAL_MARTINGALE
SUMS = 3  # over the paths that have reached the level: their number, weights, and squares of these
# Rows of the memory: the state, the values of the polynomials, a, and the monomials.
_VALUES, _SHIFT, _MONOMIALS = len(STATE), len(STATE) + 4, len(STATE) + 5
_ROWS = 64


def march_tilted(
    s: Any,
    panel: Panel,
    tilt: Tilt,
    lanes: int,
    steps: int,
    began: float,
    levels: tuple[float, float],
    counted: int,
    sums: np.ndarray,
) -> int:
    """Advance the paths of a panel on shifted noise; drop those that have reached a level.

    Parameters
    ----------
    s : NamedTuple
        Coefficients of a scheme.
    panel : Panel
    tilt : Tilt
    lanes : int
        Number of paths.
    steps : int
    began : float
        Time of the first step.
    levels : (float, float)
        Lower and upper level of int g.
    counted : int
        Which level counts: 1 for the upper, -1 for the lower one, 0 for both.
    sums : array, shape (SUMS,)
        To which the paths that have reached a level are added, when they are dropped: after every
        `FLUSH` steps, and at the end. If it is empty, none are dropped.

    Returns
    -------
    int
        Number of paths left, in the first lanes.
    """
    memory = _memory(tilt)
    for first, last in pieces(steps + 1):
        course = lanes, first, last, steps, began
        lanes = _march(s, panel, tilt, memory, *course, *levels, counted, sums)
        count(last - first)
    return lanes


def compile_march_tilted(s: Any, panel: Panel, tilt: Tilt) -> None:
    """Compile `march_tilted` for the coefficients of a scheme and the precision of a panel."""
    with announced(_march):
        march_tilted(s, panel, tilt, 0, 0, 0.0, (-1.0, 1.0), 0, np.zeros(SUMS))


def march_tilted_pair(
    fine: Any,
    coarse: Any,
    panels: tuple[Panel, Panel],
    tilt: Tilt,
    lanes: int,
    steps: int,
    began: float,
    levels: tuple[float, float],
) -> None:
    """Advance two panels on the same noise, which is shifted as the first one's paths need it.

    If one of two companions has reached a level, the noise is not shifted any more.

    Parameters
    ----------
    fine, coarse : NamedTuple
        Coefficients of a scheme, of steps h/2 and h; the coarse ones take increments as given.
    panels : (Panel, Panel)
        Of the fine and of the coarse paths. The first has the random numbers and the weights.
    tilt, lanes, began, levels
        As for `march_tilted`.
    steps : int
        Of the coarse paths.
    """
    memory = _memory(tilt)
    for first, last in pieces(2 * steps + 1):
        course = lanes, first, last, steps, began
        _march_pair(fine, coarse, *panels, tilt, memory, *course, *levels)
        count(last - first)


def compile_march_tilted_pair(fine: Any, coarse: Any, panel: Panel, tilt: Tilt) -> None:
    """Compile `march_tilted_pair`."""
    with announced(_march_pair):
        march_tilted_pair(fine, coarse, (panel, panel), tilt, 0, 0, 0.0, (-1.0, 1.0))


def _memory(tilt):
    """Memory for the polynomials and the shifts."""
    assert _MONOMIALS + len(tilt.parent) <= _ROWS
    number = tilt.coefficient.dtype
    return np.empty((_ROWS, WIDTH), dtype=number)


@kernel
def _march(s, panel, tilt, memory, lanes, first, last, steps, began, lower, upper, counted, sums):
    words, data, total = of_known_shape(panel)
    memory = numba.carray(pointer(memory.ctypes), (_ROWS, WIDTH))
    normal = 2
    for k in range(first, last):
        mechanical_flow(s, data, k == 0, k == steps, lanes)
        if k == steps:
            observe(data, lanes)
        else:
            if normal >= 2:
                normals(words, data, lanes)
                if s.normals == 4:
                    normals(words, data[2:], lanes)
                normal = 0
            if _is_due(tilt, k, s.step):
                _choose(tilt, data, memory, s.step, began + k * s.step, lanes)
            _shift(data, data, memory, normal, lanes)
            noise_kick(s, data, normal, lanes)
            normal += s.normals
        _notice(data, lanes, lower, upper)
        if (k + 1) % FLUSH == 0 or k == steps:
            flush(data, total, lanes)
            if len(sums) > 0:
                lanes = _retire(words, data, total, lanes, counted, sums)
    return lanes


@kernel
def _march_pair(
    fine, coarse, panel, other, tilt, memory, lanes, first, last, steps, began, lower, upper
):
    words, data, total = of_known_shape(panel)
    _, joined, other_total = of_known_shape(other)
    memory = numba.carray(pointer(memory.ctypes), (_ROWS, WIDTH))
    for k in range(first, last):  # counts the fine steps
        odd = k % 2 == 1
        flow_of_pair(fine, coarse, data, joined, k, 2 * steps, True, lanes)
        if k < 2 * steps:
            normal = draw(fine, words, data, odd, lanes)
            if _is_due(tilt, k, fine.step):
                _choose(tilt, data, memory, fine.step, began + k * fine.step, lanes)
            _shift(data, joined, memory, normal, lanes)
            join_noise(fine, data, joined, normal, odd, lanes)
            noise_kick(fine, data, normal, lanes)
            if odd:
                noise_kick(coarse, joined, 0, lanes)
        _notice(data, lanes, lower, upper)
        _notice(joined, lanes, lower, upper)
        if (k + 1) % FLUSH == 0 or k == 2 * steps:
            flush(data, total, lanes)
            flush(joined, other_total, lanes)


@inlined
def _notice(data, lanes, lower, upper):
    """Note which level a path has reached first."""
    low, high = like(data[0, 0], lower), like(data[0, 0], upper)
    zero, one = like(data[0, 0], 0.0), like(data[0, 0], 1.0)
    for i in range(lanes):
        value, before = data[BASE, i] + data[DELTA, i], data[REACHED, i]
        now = where(value >= high, one, where(value <= low, -one, zero))
        data[REACHED, i] = where(before == zero, now, before)


@inlined
def _is_due(tilt, k, step):
    """Whether shifts are computed anew: after a while, and after paths have been dropped."""
    return k % max(1, int(tilt.kept / step + 0.5)) == 0 or k % FLUSH == 0


@inlined
def _choose(tilt, data, memory, step, now, lanes):
    """Compute by how much normal numbers are shifted; see `tilt.Guide`."""
    number = data[0, 0]
    left = tilt.end - now
    scale = like(number, 1.0 / (tilt.gamma * math.sqrt(left)))
    target = like(number, tilt.target - tilt.side * tilt.mean * left)
    root, side, cap = like(number, math.sqrt(step)), tilt.side, tilt.cap
    late = like(number, math.exp(tilt.haste * (now - tilt.due)))
    zero, bound = like(number, 0.0), like(number, root * tilt.bound)
    # the hazard rate of the normal law (A. V. Boyd, 1959), to a percent
    slope, inverse = like(number, 1 - 1 / math.pi), like(number, 1 / math.pi**2)
    square = like(number, 2 / math.pi)
    _evaluate(tilt, data, memory, late, lanes)
    for i in range(lanes):
        covered = data[BASE, i] + data[DELTA, i] + memory[_VALUES, i]
        away = maximum(fma(-side, covered, target), zero) * scale
        hazard = fma(slope, away, math.sqrt(fma(inverse * away, away, square)))
        q = scale * hazard
        q = side * q * cap / (q + cap)
        theta = fma(q, memory[_VALUES + 3, i], memory[_VALUES + 2, i])
        theta = fma(q, theta, memory[_VALUES + 1, i])
        memory[_SHIFT, i] = minimum(maximum(root * q * theta, -bound), bound)


@inlined
def _shift(data, other, memory, normal, lanes):
    """Shift normal numbers and add to the logarithm of the likelihood ratio.

    Neither a path that has reached a level is led any more nor one whose companion in `other` has:
    what it does alone then happens with the weight that both had on arrival.
    """
    zero, half = like(data[0, 0], 0.0), like(data[0, 0], 0.5)
    for i in range(lanes):
        on_way = where(other[REACHED, i] == zero, memory[_SHIFT, i], zero)
        shift = where(data[REACHED, i] == zero, on_way, zero)
        drawn = data[normal, i]
        data[LOG_WEIGHT, i] -= shift * fma(half, shift, drawn)
        data[normal, i] = drawn + shift


@inlined
def _evaluate(tilt, data, memory, late, lanes):
    """Evaluate the polynomials in the state, four terms at a time: fewer loads and stores."""
    one, zero = like(data[0, 0], 1.0), like(data[0, 0], 0.0)
    for row in range(len(STATE)):
        width = tilt.width[row]
        for i in range(lanes):
            memory[row, i] = minimum(maximum(data[STATE[0] + row, i] * width, -one), one)
    for i in range(lanes):
        memory[_MONOMIALS, i] = one
    for t in range(1, len(tilt.parent)):
        row, parent, term = tilt.variable[t], _MONOMIALS + tilt.parent[t], _MONOMIALS + t
        for i in range(lanes):
            memory[term, i] = memory[parent, i] * memory[row, i]
    for output in range(_VALUES, _SHIFT):
        for i in range(lanes):
            memory[output, i] = zero
    for k in range(len(tilt.output)):
        output, (t, u, v, w) = _VALUES + tilt.output[k], _terms(tilt, k)
        a, b, c, d = _coefficients(tilt, k, late)
        for i in range(lanes):
            pair = fma(a, memory[t, i], b * memory[u, i])
            value = fma(c, memory[v, i], fma(d, memory[w, i], memory[output, i]))
            memory[output, i] = value + pair


@inlined
def _terms(tilt, k):
    """Rows of four monomials."""
    term = tilt.term[k]
    return (
        _MONOMIALS + term[0],
        _MONOMIALS + term[1],
        _MONOMIALS + term[2],
        _MONOMIALS + term[3],
    )


@inlined
def _coefficients(tilt, k, late):
    """Coefficients of four monomials now."""
    always, last = tilt.coefficient[k], tilt.last[k]
    return (
        fma(late, last[0], always[0]),
        fma(late, last[1], always[1]),
        fma(late, last[2], always[2]),
        fma(late, last[3], always[3]),
    )


@kernel
def _retire(words, data, total, lanes, counted, sums):
    """Drop the paths that have reached a level, and add up the weights of those that count."""
    i = 0
    while i < lanes:
        if data[REACHED, i] == 0:
            i += 1
            continue
        if counted == 0 or data[REACHED, i] == counted:
            weight = math.exp(total[TOTAL_LOG_WEIGHT, i])
            sums[0] += 1
            sums[1] += weight
            sums[2] += weight * weight
        lanes -= 1
        for row in range(len(words)):
            words[row, i] = words[row, lanes]
        for row in range(len(data)):
            data[row, i] = data[row, lanes]
        for row in range(len(total)):
            total[row, i] = total[row, lanes]
    return lanes
