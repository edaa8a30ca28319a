"""Where a crossing probability W takes a value P, with limits from the limits of W.

W is monotone in the threshold and in the time. So if its upper limit at x is below P, or its lower
limit above P, then x is on a known side of the root. Limits of the root are such x. Where the slope
is known well, they are not computed, but follow from the limits of W near by, under the assumption
that the slope changes by no more than is usual (`tuning.SEARCH.bend`).
"""

from collections.abc import Callable, Generator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from nonsmooth.errors import ToleranceError
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


Search = Generator[np.ndarray, Values, Root]


def solved_roots(
    searches: Sequence[Search], evaluate: Callable[[dict[int, np.ndarray]], dict[int, Values]]
) -> list[Root]:
    """Advance several searches together, so that W at several x is computed at once.

    Parameters
    ----------
    searches : sequence of Search
        From `searched`.
    evaluate : callable
        Takes from the places of some searches the x, shape (k,), at which each asks for W; returns
        the values of each.

    Returns
    -------
    list of Root

    Raises
    ------
    ToleranceError
        If `evaluate` does before W is known well enough to tell a root.
    """
    found: dict[int, Root] = {}
    wanted = {k: next(search) for k, search in enumerate(searches)}
    while wanted:
        for k, value in _evaluated(evaluate, wanted).items():
            search = searches[k]
            try:
                told = isinstance(value, Values)
                wanted[k] = search.send(value) if told else search.throw(value)
            except StopIteration as done:
                found[k] = done.value
                del wanted[k]
    return [found[k] for k in range(len(searches))]


def _evaluated(evaluate, wanted):
    """Values for each search, or what refuses them; if it refuses all together, for each alone."""
    try:
        return evaluate(wanted)
    except ToleranceError as refused:
        if len(wanted) == 1:
            return dict.fromkeys(wanted, refused)
    alone = ({k: x} for k, x in wanted.items())
    return {k: value for one in alone for k, value in _evaluated(evaluate, one).items()}


def searched(
    reference: Callable[[float], float],
    target: float,
    guess: tuple[float, float],
    sense: int,
    tol: float = 0.0,
    beside: float = 0.0,
) -> Search:
    """Search a root by the secant method, from few values of W.

    At x, W is what the reference is at some x*: the crossing probability of Brownian motion. In
    their logarithms x* is a nearly linear function of x, so that two values of W tell its slope,
    and with it the limits. Where errors of W hide the slope, limits are looked for by doubling.

    Parameters
    ----------
    reference : callable
        A function of one x with values from 0 to 1, monotone like W, and of nearly its shape.
    target : float
        P, between 0 and 1.
    guess : (float, float)
        Of x, and of the slope.
    sense : {RISING, FALLING}
        Of W in x.
    tol : float, optional
        Error of W that is good enough, if values are better than that.
    beside : float, optional
        Distance in log x up to which W is wanted at places beside each x, too.

    Yields
    ------
    numpy.ndarray, shape (k,)
        x > 0, of which it is sent the `Values`.

    Returns
    -------
    Root
        The error is the distance to the farther limit.

    Raises
    ------
    ToleranceError
        If one is thrown in before W is known well enough to tell a root.
    """
    search, wanted = tuning.SEARCH, equivalent(reference, target, sense)
    x, left, right = guess[0], 0.0, np.inf
    points: list[_Point] = []
    known: tuple[_Point, float, float] | None = None
    for _ in range(search.most):
        places = around(x, beside)
        try:
            values = yield places
        except ToleranceError:
            root = None if known is None else _by_slope(*known, np.inf)
            if root is None:
                raise
            return root  # with wider limits
        new = [
            _point(place, one, tol, lambda W: equivalent(reference, W, sense) - wanted)
            for place, *one in _telling(np.log(places), values, target)
        ]
        points += new
        base = min(points, key=lambda point: abs(point.gap))
        slope, doubt = _slope(points, base, guess[1])
        known = base, slope, doubt
        root = _by_slope(*known, search.vague)
        if root is not None:
            return root
        distance = np.abs(values.probability - target) - search.close * values.error
        if (len(points) > 1 and distance.min() <= 0) or right - left <= search.rounding * x:
            break
        for point in new:
            if point.gap > 0:
                right = min(right, np.exp(point.place))
            else:
                left = max(left, np.exp(point.place))
        last = min(new, key=lambda point: abs(point.gap))
        x = np.exp(last.place + _step(last, slope, told=doubt < np.inf))
        if not left < x < right and left > 0 and right < np.inf:
            x = np.sqrt(left * right)
    return (yield from _by_doubling(target, sense, base, slope))


def equivalent(reference: Callable[[float], float], W: float, sense: int) -> float:
    """Find where a reference takes a value.

    Parameters
    ----------
    reference : callable
        A function of x > 0 with values from 0 to 1, monotone.
    W : float
    sense : {RISING, FALLING}

    Returns
    -------
    float
        log x; -inf or inf where only a limit has the value, or none.
    """

    def beyond(place):
        return sense * (reference(np.exp(place)) - W)

    end = tuning.SEARCH.ends
    if beyond(-end) >= 0:
        return -np.inf
    if beyond(end) <= 0:
        return np.inf
    return brentq(beyond, -end, end, xtol=1e-14, rtol=1e-14)


def around(x: float, beside: float) -> np.ndarray:
    """Return x, and places on either side of it up to a distance in log x, unless that is 0."""
    return np.unique(x * np.exp(beside * np.linspace(-1, 1, 2 * tuning.SEARCH.places + 1)))


class _Point(NamedTuple):
    """One value of W: log x, and how far log x* and its limits are from where W = P.

    `wanted` is the largest error of log x* that is good enough.
    """

    place: float
    gap: float
    low: float
    high: float
    wanted: float

    @property
    def error(self) -> float:
        """The larger distance to a limit."""
        return max(self.high - self.gap, self.gap - self.low)


def _telling(places, values, target):
    """Return few places with their values: those around the root, and the farthest ones."""
    passed = np.flatnonzero(np.diff(values.probability < target))  # W may jump from 0 to 1
    nearest = passed[0] if len(passed) else np.argmin(np.abs(values.probability - target))
    chosen = np.unique(np.clip(nearest + np.array(tuning.SEARCH.telling), 0, len(places) - 1))
    return zip(*(part[chosen] for part in (places, *values)), strict=True)


def _point(place, values, tol, distance):
    """Return one value of W; `distance` takes it to that of log x* from where W = P."""
    W, _, lower, upper = (float(part) for part in values)
    gap, *limits = (distance(part) for part in (W, lower, upper))
    low, high = sorted(limits)
    good = max(high - gap, gap - low)
    if 0 < W - tol < W + tol < 1:
        good = max(good, abs(distance(W + tol) - distance(W - tol)) / 2)
    return _Point(place, gap, low, high, good)


def _slope(points, base, guess):
    """Return the slope near a point from those two points that tell it best, and its doubt.

    The doubt is relative: from the errors, and from the distance over which the slope may change.
    """
    best = guess, np.inf
    for one, two in combinations([point for point in points if np.isfinite(point.gap)], 2):
        rise, run = two.gap - one.gap, two.place - one.place
        if run == 0 or not 0 < rise / run < np.inf:
            continue
        errors = one.error + two.error
        bent = max(_bent(point.place - base.place, point.gap - base.gap) for point in (one, two))
        doubt = errors / abs(rise) + bent
        if doubt < min(best[1], tuning.SEARCH.told):
            best = rise / run, doubt
    return best


def _bent(way, reached):
    """Return the relative change of a slope over a way in log x and one in log x*, at most."""
    search = tuning.SEARCH
    return np.maximum(search.bend * np.abs(way), search.front * np.abs(reached))


def _by_slope(base, slope, doubt, most):
    """Return the root that a point and the slope tell, or None where they tell too little.

    What the slope leaves open may be so many times what an error of W does that is good enough.
    """
    search = tuning.SEARCH
    gaps = np.array([base.gap, base.high, base.low])
    ways = -gaps / slope
    if not np.all(np.isfinite(ways)):
        return None
    doubts = doubt + _bent(ways, gaps)
    vague = abs(base.gap) * doubt > most * base.wanted + search.rounding
    if vague or doubts.max() > search.doubt:
        return None
    way, first, last = ways
    first = min(first / (1 - doubts[1]), first / (1 + doubts[1])) - search.rounding
    last = max(last / (1 - doubts[2]), last / (1 + doubts[2])) + search.rounding
    value, lower, upper = np.exp(base.place + np.array([way, first, last]))
    return Root(value, max(value - lower, upper - value), lower, upper)


def _step(last, slope, told):
    """Return the next change of log x; it is to tell the slope, if it need not be too wide."""
    search = tuning.SEARCH
    gap, wide = last.gap, search.wide * last.error + search.rounding
    if np.isinf(wide) and last.low * last.high > 0:  # beyond the root, and far as it may be
        gap = np.copysign(np.inf, gap)
    elif not told and wide < slope * search.doubt / (2 * search.bend):
        gap = np.copysign(max(abs(gap), wide), gap)
    reach = np.log(search.farthest)
    return np.clip(-gap / slope, -reach, reach)


def _by_doubling(target, sense, point, slope):
    """Look for limits on either side of a point, ever farther away."""
    search, x = tuning.SEARCH, np.exp(point.place)
    reach = max(abs(point.gap), abs(point.low), abs(point.high)) / slope
    reach = float(np.clip(search.margin * reach, search.rounding, np.log(search.first)))
    limits = []
    for side in (-1, 1):
        spread = reach
        while spread <= np.log(search.widest):
            end = x * np.exp([side * spread])
            values = yield end
            found = values.before(target, sense) if side < 0 else values.after(target, sense)
            if found[0]:
                limits.append(float(end[0]))
                break
            spread *= 2
        else:
            limits.append(0.0 if side < 0 else np.inf)
    return Root(float(x), max(x - limits[0], limits[1] - x), *limits)


def root_on_grid(x: np.ndarray, values: Values, target: float, sense: int) -> Root:
    """Invert values on a grid.

    Parameters
    ----------
    x : numpy.ndarray, shape (k,)
        Increasing, at least four.
    values : Values
    target, sense
        As for `searched`.

    Returns
    -------
    Root
        The limits are points of the grid, or 0 and inf if the grid ends before. The error is that
        of W, over its slope, and what the grid leaves open: as much of the interval around the root
        as the slope changes, all of it where W jumps. Paths that arrive together are told apart by
        rounding, which the limits allow for.
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
    rounding = tuning.SEARCH.counted_rounding
    missed = error * width / change if change > 0 else np.inf
    return Root(
        value,
        missed + _left_open(x, rising, value) + rounding * value,
        lower * (1 - rounding),
        upper * (1 + rounding),
    )


def _left_open(x, rising, value):
    """By how much a root on a grid is unsure because the slope changes from point to point."""
    place = int(np.clip(np.searchsorted(x, value), 2, len(x) - 2))
    around = slice(place - 2, place + 2)
    before, slope, after = np.diff(rising[around]) / np.diff(x[around])
    width, turn = float(x[place] - x[place - 1]), max(abs(slope - before), abs(after - slope))
    return width * min(1.0, turn / slope) if slope > 0 else width
