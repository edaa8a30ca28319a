"""Inversion of the Laplace transform of first-passage times on hyperbolic contours.

A contour serves times of one window. Where the probability, or the survival probability, is small,
its contour starts at the saddle point or at the leading pole instead of 0: the error is then
relative. A problem is that of `first_passage_line` or of `first_passage_plane`.
"""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import root_scalar

from nonsmooth.crossing.first_passage.contours import hyperbola, through_saddle

_PER_DECADE = 8  # nodes more for each decade of times
_SHORTEST = 3.0  # last time over first time, of a hyperbola, at least
_GROWTH = 1e4  # of the probability, at most, for a contour through a saddle
# Off the axis the transform may grow, like exp(|z| t) where paths run almost as given. The arms of
# a contour have such an angle to the left of the vertical that the growth takes at most some share
# of the decay of exp(z t), at smaller angles, too, or poles lie between: of a hyperbola, for
# |z| t > _FAR; of a contour through a saddle, beyond the saddle. Not looked at is where
# exp(z t) < exp(-_NEGLIGIBLY); poles near the axis make the transform grow by a factor only.
_ARMS = (0.2, 0.4, 0.67)
_STEEPEST = 0.0
_FAR, _TAMED, _NEGLIGIBLY, _HARMLESS = 6.0, 0.3, 30.0, 0.7
_RISEN, _TAME = 0.05, 0.08  # bound of the probability, and share, at the end of the rise
_MOST = 100  # terms of a contour
_SURELY = 0.1  # of what is negligible: two levels below, and their difference, leave it so
_SMALL = 1e-3  # survival probabilities below get contours of their own
_AXIS = 0.6  # spacing of log z on the axis in the search for saddles
_LARGEST, _FINE = 150.0, 0.01  # z t at most; spacing of log z of the spline


class _Hyperbola(NamedTuple):
    """A kind of hyperbola, for times from `since` times the end of the rise on.

    Attributes
    ----------
    sector : float
        Half angle about the negative axis, of the poles and of what grows there.
    ratio : float
        Last time over first time, at most.
    more : int
        Nodes more.
    since : float
    """

    sector: float
    ratio: float
    more: int
    since: float


# what poles off the axis add has decayed after three times the rise
_EARLY, _STEADY = _Hyperbola(0.9, 4.0, 10, 1.0), _Hyperbola(0.3, 20.0, 3, 3.0)


def by_contours(problem, times):
    """Prepare the inversion for given times.

    Parameters
    ----------
    problem : first_passage_line.Line or first_passage_plane.Plane
    times : numpy.ndarray, shape (k,)
        Increasing, positive.

    Returns
    -------
    callable
        Takes a level of the problem, what is known, shape (2, k), and the times at which more is
        wanted; returns probability and survival probability, shape (2, k), anew in windows with
        such a time, and where it is anew.
    """
    return partial(_solve, problem, times, _saddles(problem, times))


@dataclass(frozen=True)
class _Saddles:
    """Saddle points on the axis of the integrand exp(z t) F(z) / z of the probability.

    Attributes
    ----------
    place, width : numpy.ndarray, shape (k,)
        z, and the standard deviation along a contour through it, for each time.
    bound : numpy.ndarray, shape (k,)
        Logarithm of Chernoff's bound of the probability, the least exp(z t) F(z).
    tilt : numpy.ndarray, shape (k,)
        Angle to the vertical of the arms of a contour through it.
    early, steady : numpy.ndarray of bool, shape (k,)
        Whether the probability is not small and the transform tame enough for such a hyperbola.
    """

    place: np.ndarray
    width: np.ndarray
    bound: np.ndarray
    tilt: np.ndarray
    early: np.ndarray
    steady: np.ndarray


def _saddles(problem, times):
    """Find them by a spline of the transform on the axis."""
    first, last = np.log([0.1 / times[-1], _LARGEST / times[0]])
    log_z, log_F, arms = np.arange(first, last + _AXIS, _AXIS), [], []
    for z in np.exp(log_z):
        # the saddle of the time t is where z t = d log F / d log z, which is less than log F
        depth = max(1.0, -(1 + _AXIS) * log_F[-1]) if log_F else 1.0
        transform = problem.near_axis(z, depth)
        value = transform(z).real
        if value < problem.rounded:
            break
        log_F.append(np.log(value))
        arms.append([_size(transform, z * np.exp(1j * (np.pi / 2 + arm))) for arm in _ARMS])
    if len(log_F) < 2:  # log F falls at most by a factor exp(_AXIS) a step: nothing has crossed
        nothing = np.zeros(len(times))
        bound, fits = nothing + np.log(problem.rounded), nothing == 0
        return _Saddles(nothing, nothing, bound, nothing, fits, fits)
    last = log_z[len(log_F) - 1]
    spline = CubicSpline(log_z[: len(log_F)], log_F)
    fine = np.linspace(first, last, int((last - first) / _FINE))
    z = np.exp(fine)
    cumulant, slope, bend = (spline(fine, k) for k in range(3))
    radii = np.exp(log_z[: len(log_F)])
    growth = np.array(arms)
    bound, place, width, tilt, early, steady = [], [], [], [], [], []

    def tame(count, share, t, least):
        decay = radii[:, None] * t * np.sin(_ARMS[:count])
        seen = (radii[:, None] > least) & (decay < _NEGLIGIBLY)
        return np.all((growth[:, :count] <= _HARMLESS + share * decay)[seen])

    def hyperbolic(t):
        risen = np.min(z * t + cumulant) >= np.log(_RISEN)
        return risen and tame(len(_ARMS), _TAME, t, _FAR / t)

    for t in times:
        bound.append(np.min(z * t + cumulant))
        early.append(hyperbolic(t / _EARLY.since))
        steady.append(hyperbolic(t / _STEADY.since))
        best = np.argmin(z * t + cumulant - fine)
        place.append(z[best])
        fitting = [k for k in (1, 2) if z[best] < radii[-1] and tame(k, _TAMED, t, z[best])]
        tilt.append(_ARMS[max(fitting) - 1] if fitting else _STEEPEST)
        # second derivative in z of the exponent, log z among it
        width.append(z[best] / np.sqrt(max(bend[best] - slope[best] + 1, 0.1)))
    return _Saddles(
        np.array(place),
        np.array(width),
        np.maximum.accumulate(bound),
        np.array(tilt),
        np.array(early),
        np.array(steady),
    )


def _size(transform, z):
    """Logarithm of |F|; infinite where it cannot be told."""
    try:
        return np.log(abs(transform(z)))
    except np.linalg.LinAlgError:
        return np.inf


def _windows(first, end, *growing):
    """Slices of indices over which increasing values grow at most by the factor beside them."""
    while first < end:
        last = min(np.searchsorted(v, v[first] * factor, "right") for v, factor in growing)
        yield slice(first, min(end, int(last)))
        first = int(last)


def _hyperbolic(times, saddles, begins, end):
    """Windows after the rise and before `end`, with the kind of hyperbola."""
    first, steady = (
        np.max(np.flatnonzero(~fits) + 1, initial=begins)
        for fits in (saddles.early, saddles.steady)
    )
    while first < end:
        kind = _EARLY if first < steady else _STEADY
        last = int(np.searchsorted(times, times[first] * kind.ratio, "right"))
        yield slice(first, min(end, last)), kind
        first = last


def _solve(problem, times, saddles, level, known, wanted):
    resolution, count, spacing = level
    begins = np.searchsorted(saddles.bound, np.log(problem.negligible))
    found, solved = known.copy(), np.full(len(times), False)

    def transform(where):
        return problem.transform(resolution, times[where], -saddles.bound[where][0])

    def of_probability(transform):
        return lambda z: transform(z) / z

    def of_survival(transform):
        return lambda z: (1 - transform(z)) / z

    def around_poles(where, kind, first=0.0):
        """Contour to the right of the poles, of which `first` is the largest."""
        begin, end = times[where][0], max(times[where][-1], _SHORTEST * times[where][0])
        nodes = round(count + kind.more + _PER_DECADE * np.log10(end / begin))
        return hyperbola(begin, end, nodes, kind.sector, first)

    def store(here, values, row=0):
        found[row, here], found[1 - row, here] = values, 1 - values
        solved[here] = True

    tails = problem.relative and problem.two_sided
    late = begins + np.searchsorted(-known[1, begins:], -_SMALL) if tails else len(times)
    risen = list(_hyperbolic(times, saddles, begins, late))
    rises = risen[0][0].start if risen else late
    turns = np.cumsum(np.diff(saddles.tilt, prepend=saddles.tilt[0]) != 0) + 1
    rise = [
        (here, of_probability(transform(here)))
        for here in _windows(
            begins, rises, (times, problem.narrow), (np.exp(saddles.bound), _GROWTH), (turns, 1)
        )
        if wanted[here].any()
    ]
    negligible = begins
    for here, of_rise in reversed(rise):
        last = here.stop - 1  # at whose saddle the integrand is small at all earlier times, too
        contour = through_saddle(
            saddles.place[last], saddles.width[last], spacing, saddles.tilt[last]
        )
        store(here, _inverted(of_rise, contour, times[here], problem.last))
        # the probability increases: earlier ones are negligible, too, and the bound was too weak
        if problem.relative and abs(found[0, here.start]) < _SURELY * problem.negligible:
            negligible = here.start
            break
    store(slice(negligible), np.zeros(negligible))
    for here, kind in risen:
        if wanted[here].any():
            integrand = of_probability(transform(here))
            contour = around_poles(here, kind)
            store(here, _inverted(integrand, contour, times[here], problem.least))
    late = rises + np.searchsorted(-found[1, rises:], -_SMALL)
    if tails and wanted[late:].any():
        pole = _leading_pole(transform(slice(late, None)), times[late])
        for here in _windows(late, len(times), (times, _STEADY.ratio)):
            if wanted[here].any():
                integrand = of_survival(transform(here))
                contour = around_poles(here, _STEADY, pole)
                store(here, _inverted(integrand, contour, times[here], problem.least), 1)
    return found, solved


def _inverted(transform, contour, times, last):
    """Sum until the terms at the first time, where they are largest, are negligible."""
    values = []
    for z, weight in zip(contour.nodes, contour.weights, strict=True):
        values.append(transform(z))
        term = np.abs(weight * values[-1]) * np.exp(z.real * times[0])
        if len(values) == 1:
            largest = term
        elif term < last * largest or len(values) == _MOST:
            break
    return contour.until(len(values)).invert(np.array(values), times)


def _leading_pole(transform, time):
    """Largest pole of E exp(-z tau); at `time`, the survival probability is about _SMALL."""

    def inverse(z):
        return (1 / transform(z)).real

    rate = -np.log(_SMALL) / time
    return float(root_scalar(inverse, x0=-rate / 2, x1=-0.8 * rate, rtol=1e-14).root)
