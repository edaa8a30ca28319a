"""Where a crossing probability W takes a value P, with limits from the limits of W.

W is monotone in the threshold and in the time. So if its upper limit at x is below P, or its lower
limit above P, then x is on a known side of the root. Limits of the root are such x; they hold
whenever those of W hold there.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.special import logit

from nonsmooth.reliability import tuning

RISING, FALLING = 1, -1


class Values(NamedTuple):
    """W at some x, each an array of shape (k,).

    Attributes
    ----------
    probability, error, lower, upper : numpy.ndarray
    """

    probability: np.ndarray
    error: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    def before(self, target: float, sense: int) -> np.ndarray:
        """Whether the root is surely not before x."""
        return self.upper <= target if sense == RISING else self.lower >= target

    def after(self, target: float, sense: int) -> np.ndarray:
        """Whether the root is surely not after x."""
        return self.lower >= target if sense == RISING else self.upper <= target


class Root(NamedTuple):
    """A root and its limits, 0 and inf where nothing is known.

    Attributes
    ----------
    value, error, lower, upper : float
    """

    value: float
    error: float
    lower: float
    upper: float


def solved_root(
    evaluate: Callable[[np.ndarray], Values], target: float, guess: float, sense: int
) -> Root:
    """Find a root by the secant method in log x and logit W, which is nearly linear.

    Parameters
    ----------
    evaluate : callable
        Takes increasing x > 0, shape (k,).
    target : float
        P, between 0 and 1.
    guess : float
    sense : {RISING, FALLING}
        Of W in x.

    Returns
    -------
    Root
        The error is the distance to the farther limit.
    """
    search = tuning.SEARCH
    x, slope, W, error = _secant(evaluate, target, guess, sense)
    # in log x; where the slope is not known, doubling finds the limits
    own = (error + abs(W - target)) / max(abs(slope) * W * (1 - W), np.finfo(float).tiny)
    first = float(np.clip(search.margin * own, search.rounding, np.log(search.farthest)))
    spread, done = np.array([first, first]), np.array([False, False])
    while True:
        ends = x * np.exp([-spread[0], spread[1]])
        values = evaluate(ends)
        done = np.array([values.before(target, sense)[0], values.after(target, sense)[1]])
        if done.all():
            break
        spread[~done] *= 2
        if spread.max() > np.log(search.widest):
            break
    lower, upper = np.where(done, ends, [0.0, np.inf])
    return Root(x, max(x - lower, upper - x), float(lower), float(upper))


def _secant(evaluate, target, guess, sense):
    """Return x, d logit W / d log x there, W and its error."""
    search, wanted = tuning.SEARCH, logit(target)
    place, slope = np.log(guess), 2.0 * sense
    left, right, before, distance = -np.inf, np.inf, None, np.inf
    for _ in range(search.most):
        W, error = (float(part[0]) for part in evaluate(np.exp([place]))[:2])
        gap = sense * (logit(np.clip(W, 1e-300, 1 - 1e-16)) - wanted)
        if before is not None and 0 < W < 1:
            found = (gap - before[1]) / (place - before[0]) if place != before[0] else 0.0
            slope = sense * found if 0 < found < np.inf else slope
        distance, last = abs(W - target), distance
        if distance <= search.close * error or right - left <= search.rounding:
            break
        if distance <= error and distance > search.falls * last:
            break
        left, right = (left, place) if gap > 0 else (place, right)
        before = (place, gap) if 0 < W < 1 else None
        reach = np.log(search.farthest)
        place += np.clip(-gap / abs(slope), -reach, reach)
        if not left < place < right:
            place = (left + right) / 2
    return float(np.exp(place)), slope, W, error


def root_on_grid(x: np.ndarray, values: Values, target: float, sense: int) -> Root:
    """Invert values on a grid.

    Parameters
    ----------
    x : numpy.ndarray, shape (k,)
        Increasing.
    values : Values
    target, sense
        As for `solved_root`.

    Returns
    -------
    Root
        The limits are points of the grid, or 0 and inf if the grid ends before. The error is that
        of W, over its slope.
    """
    before, after = values.before(target, sense), values.after(target, sense)
    # limits of samples need not be monotone: the root is within the widest interval they allow
    first = int(np.argmin(before)) if not before.all() else len(x)
    last = len(x) - int(np.argmin(after[::-1])) if not after.all() else 0
    rising = np.maximum.accumulate(sense * values.probability)
    value = float(np.exp(np.interp(sense * target, rising, np.log(x))))
    near = np.clip(np.searchsorted(x, value) + np.array([-3, 3]), 0, len(x) - 1)
    change = abs(float(np.diff(values.probability[near])[0]))
    error = float(np.interp(value, x, values.error))
    width = float(np.diff(x[near])[0])
    lower = float(x[first - 1]) if first > 0 else 0.0
    upper = float(x[last]) if last < len(x) else np.inf
    return Root(value, error * width / change if change > 0 else np.inf, lower, upper)
