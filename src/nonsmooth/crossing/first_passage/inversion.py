"""Inversion of the Laplace transform of first-passage times, for many times at once.

The times are divided into windows, each served by one contour on which F(z) = E exp(-z tau) is
evaluated. For two variables there are up to four stages with increasing time:

- At first crossings are so rare that Chernoff's bound of their probability is negligible. The
  probability is set to 0.
- In the rise the contour goes through the saddle point of exp(z t) F(z) / z, which keeps the
  relative error of small probabilities small.
- Later the contour is a hyperbola around the poles of F on the negative axis and the pole of 1/z.
- In the end the survival probability is small. It is computed from (1 - F(z)) / z, and the
  hyperbola crosses the axis at the leading pole instead of 0, which keeps its relative error small.

For one variable, F is good enough to be fitted by rational functions on vertical lines
(`vertical_lines`): in the rise through a saddle point, and later on one line for all times but
those of the end.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.optimize import root_scalar

from nonsmooth.crossing.first_passage import contours, tuning, vertical_lines
from nonsmooth.crossing.first_passage.problem import ContourLevel, LaplaceProblem
from nonsmooth.crossing.first_passage.saddle_points import SaddlePoints, saddle_points

Solver = Callable[[ContourLevel, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def contour_solver(problem: LaplaceProblem, times: np.ndarray, tol: float) -> Solver:
    """Prepare the inversion for given times.

    Parameters
    ----------
    problem : LaplaceProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float
        Absolute error wanted, for fits on vertical lines.

    Returns
    -------
    callable
        Takes a level of the problem, what is known so far, shape (2, k), and at which times more is
        wanted, shape (k,). Solves the windows with such a time anew. Returns probability and
        survival probability, shape (2, k), and at which times they are new.
    """
    saddles = saddle_points(problem, times)

    def solve(level, known, wanted):
        kind = partial(_OnVerticalLines, tol) if problem.on_vertical_lines else _Inversion
        return kind(problem, times, saddles, level, known, wanted).run()

    return solve


class _Inversion:
    """The inversion on one level.

    Parameters
    ----------
    problem : LaplaceProblem
    times : numpy.ndarray, shape (k,)
    saddles : SaddlePoints
    level : ContourLevel
    known, wanted
        As for `contour_solver`.
    """

    def __init__(
        self,
        problem: LaplaceProblem,
        times: np.ndarray,
        saddles: SaddlePoints,
        level: ContourLevel,
        known: np.ndarray,
        wanted: np.ndarray,
    ):
        self.problem, self.times, self.saddles = problem, times, saddles
        self.level, self.known, self.wanted = level, known, wanted
        self.found, self.solved = known.copy(), np.full(len(times), False)

    def run(self):
        """Solve the stages one after the other."""
        settings = self.problem.settings
        begin = int(np.searchsorted(self.saddles.bound, np.log(settings.least_probability)))
        ends = settings.relative and self.problem.two_sided
        late = begin + self._first_small(self.known[1, begin:]) if ends else len(self.times)
        windows = self._windows_of_later(begin, late)
        risen = windows[0][0].start if windows else late
        self._rise(begin, risen)
        self._later(windows)
        if ends:
            self._end(risen)
        return self.found, self.solved

    def _windows_of_later(self, begin, end):
        """Return windows that hyperbolas serve, each with the kind of hyperbola."""
        return list(_hyperbolic(self.times, self.saddles, begin, end))

    def _first_small(self, survival):
        return int(np.searchsorted(-survival, -tuning.INVERSION.small))

    def _transform(self, here):
        return self.problem.transform(
            self.level.resolution, self.times[here], -self.saddles.bound[here][0]
        )

    def _store(self, here, values, row=0):
        """Keep the values of the probability, row 0, or of the survival probability, row 1."""
        self.found[row, here], self.found[1 - row, here] = values, 1 - values
        self.solved[here] = True

    def _rise(self, begin, end):
        """Solve windows in which the probability is still small, the last first."""
        settings, saddles = self.problem.settings, self.saddles
        turns = np.cumsum(np.diff(saddles.tilt, prepend=saddles.tilt[0]) != 0) + 1
        windows = _windows(
            begin,
            end,
            (self.times, settings.window),
            (np.exp(saddles.bound), tuning.INVERSION.growth),
            (turns, 1),
        )
        # transforms are asked for in the order of times
        rise = [
            (here, _of_probability(self._transform(here)))
            for here in windows
            if self.wanted[here].any()
        ]
        negligible = begin
        for here, integrand in reversed(rise):
            # at the saddle point of the last time the integrand is small at earlier times, too
            last = here.stop - 1
            contour = contours.through_saddle(
                saddles.place[last], saddles.width[last], self.level.spacing, saddles.tilt[last]
            )
            self._store(
                here,
                contours.inverted(integrand, contour, self.times[here], settings.rise_truncation),
            )
            # The probability increases with time. If it is negligible here, although its bound is
            # not, then it is negligible at all earlier times, too.
            least = tuning.INVERSION.surely * settings.least_probability
            if settings.relative and abs(self.found[0, here.start]) < least:
                negligible = here.start
                break
        self._store(slice(negligible), np.zeros(negligible))

    def _later(self, windows):
        """Solve windows, each on a hyperbola of the kind given with it."""
        for here, kind in windows:
            if self.wanted[here].any():
                integrand = _of_probability(self._transform(here))
                self._store(here, self._on_hyperbola(integrand, here, kind))

    def _end(self, risen):
        """Solve windows in which the survival probability is small."""
        kind, late = tuning.INVERSION.steady, risen + self._first_small(self.found[1, risen:])
        if not self.wanted[late:].any():
            return
        pole = _leading_pole(self._transform(slice(late, None)), self.times[late])
        for here in _windows(late, len(self.times), (self.times, kind.ratio)):
            if self.wanted[here].any():
                integrand = _of_survival(self._transform(here))
                self._store(here, self._on_hyperbola(integrand, here, kind, pole), 1)

    def _on_hyperbola(self, integrand, here, kind, pole=0.0):
        """Invert on a hyperbola to the right of all poles, of which `pole` is the rightmost."""
        settings, times = tuning.INVERSION, self.times[here]
        first, last = times[0], max(times[-1], settings.shortest * times[0])
        nodes = round(self.level.nodes + kind.more + settings.per_decade * np.log10(last / first))
        contour = contours.hyperbola(first, last, nodes, kind.sector, pole)
        return contours.inverted(integrand, contour, times, self.problem.settings.steady_truncation)


class _OnVerticalLines(_Inversion):
    """The inversion on one level, by rational fits on vertical lines but at the end.

    Parameters
    ----------
    tol : float
    problem, times, saddles, level, known, wanted
        As for `_Inversion`.
    """

    def __init__(self, tol: float, *of_level):
        super().__init__(*of_level)
        self.tol = tol

    def _windows_of_later(self, begin, end):
        """One window from where the probability is no longer small."""
        risen = np.log(tuning.SADDLE_POINTS.risen)
        first = max(begin, int(np.searchsorted(self.saddles.bound, risen)))
        return [(slice(first, end), None)] if first < end else []

    def _rise(self, begin, end):
        """Solve windows in which the probability is still small, the last first."""
        settings, bounds = self.problem.settings, np.exp(self.saddles.bound)
        growth = tuning.VERTICAL_LINES.growth if settings.relative else np.inf
        negligible = begin
        for here in reversed(list(_windows(begin, end, (bounds, growth)))):
            last = here.stop - 1
            size = 1.0 if settings.relative else bounds[last]
            self._on_line(here, self.saddles.place[last], self.tol / size, rising=True)
            # if the probability is negligible here, although its bound is not, it is so before
            if (
                abs(self.found[0, here.start])
                < tuning.INVERSION.surely * settings.least_probability
            ):
                negligible = here.start
                break
        self._store(slice(negligible), np.zeros(negligible))

    def _later(self, windows):
        """Solve the window after the rise."""
        for here, _ in windows:
            self._on_line(here, 1 / self.times[here.stop - 1], self.tol, rising=False)

    def _on_line(self, here, abscissa, tol, rising):
        """Fit F on a line, unless this is not wanted, and invert it."""
        if not self.wanted[here].any():
            return
        settings, saddles = tuning.VERTICAL_LINES, self.saddles
        turn = self.problem.settings.levels.index(self.level) % 2
        best = settings.rising if rising else settings.best
        accuracy = max(best, settings.accuracy * tol)
        parts, fronts = self.problem.parts(
            self.level.resolution, self.times[here], -saddles.bound[here][0]
        )
        values = np.zeros(here.stop - here.start)
        if self.times[here.stop - 1] > fronts.min():
            begun = saddles.begin(abscissa, settings.negligible * min(accuracy, 1.0))
            values = vertical_lines.inverted(
                parts,
                abscissa,
                np.maximum(fronts, begun),
                accuracy,
                rising,
                offset=turn / 2,
            ).at(self.times[here])
        self._store(here, values)


def _of_probability(transform):
    return lambda z: transform(z) / z


def _of_survival(transform):
    return lambda z: (1 - transform(z)) / z


def _windows(first, end, *growing):
    """Slices of indices over which increasing values grow at most by the factor beside them."""
    while first < end:
        last = min(np.searchsorted(v, v[first] * factor, "right") for v, factor in growing)
        yield slice(first, min(end, int(last)))
        first = int(last)


def _hyperbolic(times, saddles, begin, end):
    """Yield the windows before `end` that hyperbolas serve, each with the kind of hyperbola."""
    first, steady = (
        np.max(np.flatnonzero(~fits) + 1, initial=begin) for fits in (saddles.early, saddles.steady)
    )
    while first < end:
        kind = tuning.INVERSION.early if first < steady else tuning.INVERSION.steady
        last = int(np.searchsorted(times, times[first] * kind.ratio, "right"))
        yield slice(first, min(end, last)), kind
        first = last


def _leading_pole(transform, time):
    """Find the rightmost pole of F. At `time` the survival probability has just become small."""

    def inverse(z):
        return (1 / transform(z)).real

    rate = -np.log(tuning.INVERSION.small) / time
    return float(root_scalar(inverse, x0=-rate / 2, x1=-0.8 * rate, rtol=1e-14).root)
