"""The loop over time steps that follows the probabilities of paths to have stayed in intervals.

Two panels advance on the same noise, the second with steps twice as long, so that the bias of the
step is known for every path. Each step begins and ends with a half-flow, because only the states
between two steps are those of a path.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from nonsmooth.paths.kernels.compilation import announced, inlined, kernel
from nonsmooth.paths.kernels.panel import Panel
from nonsmooth.paths.parallel import count
from nonsmooth.paths.time_loop import (
    draw,
    join_noise,
    mechanical_flow,
    noise_kick,
    of_known_shape,
    pieces,
)

STATIONARY = np.empty(0)  # no factors of the noise
_FAR = 40.0  # exponents of crossing within a step beyond which its probability, 4e-18, is nothing


class Intervals(NamedTuple):
    """What is left: a row of the panels, the levels, and the noise in that row.

    Attributes
    ----------
    row : int
    lower, upper : numpy.ndarray, shape (m,)
        Of each interval; there may be none, and paths then only move.
    intensity : float
        Variance of the noise in the row per unit of time; 0 if it drives another variable.
    """

    row: int
    lower: np.ndarray
    upper: np.ndarray
    intensity: float


def march_survival(
    fine: Any,
    coarse: Any,
    panel: Panel,
    other: Panel,
    lanes: int,
    steps: int,
    intervals: Intervals,
    before: np.ndarray,
    survival: np.ndarray,
    scale: np.ndarray = STATIONARY,
) -> None:
    """Advance two panels on the same noise, the second with steps twice as long.

    Parameters
    ----------
    fine, coarse : NamedTuple
        Coefficients of a scheme, of steps h/2 and h; the coarse ones take increments as given.
    panel, other : Panel
        Of the fine and of the coarse paths.
    lanes : int
        Number of paths.
    steps : int
        Of the coarse paths.
    intervals : Intervals
    before : numpy.ndarray, shape (2, lanes)
        Values of the row now, of fine and coarse paths; kept up to date.
    survival : numpy.ndarray, shape (2, m, lanes)
        Probabilities to have stayed inside; kept up to date.
    scale : numpy.ndarray, shape (2 steps,) or (0,)
        Factors of the noise in the fine steps; empty if there are none.
    """
    for first, last in pieces(steps):
        if survival.size and not survival.any():
            return
        own = scale[2 * first : 2 * last]
        _march(fine, coarse, panel, other, lanes, last - first, intervals, before, survival, own)
        count(3 * (last - first))


def compile_march_survival(fine: Any, coarse: Any, panel: Panel) -> None:
    """Compile `march_survival` for two sets of coefficients and the precision of a panel."""
    nowhere = Intervals(0, np.empty(0), np.empty(0), 0.0)
    with announced(_march):
        nothing = np.empty((2, 0)), np.empty((2, 0, 0))
        _march(fine, coarse, panel, panel, 0, 0, nowhere, *nothing, STATIONARY)


@kernel
def _march(fine, coarse, panel, other, lanes, steps, intervals, before, survival, scale):
    words, data, _ = of_known_shape(panel)
    _, joined, _ = of_known_shape(other)
    for k in range(2 * steps):
        odd = k % 2 == 1
        own = scale[k] if len(scale) > 0 else 1.0
        joint = math.sqrt((scale[k - 1] ** 2 + own**2) / 2) if odd and len(scale) > 0 else 1.0
        for end in range(2):
            mechanical_flow(fine, data, end == 0, end == 1, lanes)
            if end == 0:
                normal = draw(fine, words, data, odd, lanes)
                join_noise(fine, data, joined, normal, odd, lanes)
                if len(scale) > 0:
                    _multiply(data, normal, fine.normals, own, lanes)
                noise_kick(fine, data, normal, lanes)
        _survive(data, intervals, fine.step * own**2, before[0], survival[0], lanes)
        if odd:
            if len(scale) > 0:
                _multiply(joined, 0, 2, joint, lanes)
            for end in range(2):
                mechanical_flow(coarse, joined, end == 0, end == 1, lanes)
                if end == 0:
                    noise_kick(coarse, joined, 0, lanes)
            _survive(joined, intervals, coarse.step * joint**2, before[1], survival[1], lanes)


@inlined
def _multiply(data, first, count, factor, lanes):
    for row in range(first, first + count):
        for i in range(lanes):
            data[row, i] *= factor


@inlined
def _survive(data, intervals, span, before, survival, lanes):
    """Multiply the probabilities with those of having stayed inside during the last step.

    Parameters are as for `march_survival`; `span` is the step times the square of its factor.
    """
    variance = intervals.intensity * span
    now = data[intervals.row]
    for j in range(len(intervals.lower)):
        lower, upper, inside = intervals.lower[j], intervals.upper[j], survival[j]
        for i in range(lanes):
            start, end = before[i], float(now[i])
            if inside[i] == 0:
                continue
            if end >= upper or end <= lower:
                inside[i] = 0
            elif variance > 0:
                above = 2 * (upper - start) * (upper - end) / variance
                below = 2 * (start - lower) * (end - lower) / variance
                if above < _FAR:
                    inside[i] *= -math.expm1(-above)
                if below < _FAR:
                    inside[i] *= -math.expm1(-below)
    for i in range(lanes):
        before[i] = now[i]
