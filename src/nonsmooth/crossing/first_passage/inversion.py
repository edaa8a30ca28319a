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

All hyperbolas of the third stage share values of F, most of which come from a rational fit
(`contours.inverted_together`). For one variable, F is good enough to be fitted on vertical lines,
and inverted by the poles of the fits (`vertical_lines`): in the rise through a saddle point, and
later on one line for all times but those of the end.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from scipy.optimize import root_scalar

from nonsmooth.crossing.first_passage import contours, tuning, vertical_lines
from nonsmooth.crossing.first_passage.problem import ContourLevel, LaplaceProblem
from nonsmooth.crossing.first_passage.saddle_points import SaddlePoints, saddle_points

Solver = Callable[[ContourLevel, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


def contour_solver(
    problem: LaplaceProblem, times: np.ndarray, tol: float, saddles: SaddlePoints | None = None
) -> Solver:
    """Prepare the inversion for given times.

    Parameters
    ----------
    problem : LaplaceProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float
        Absolute error wanted, for fits of F.
    saddles : SaddlePoints, optional
        Those of the problem unless given; for contours that serve others, too.

    Returns
    -------
    callable
        Takes a level of the problem, what is known so far, shape (2, k), and at which times more is
        wanted, shape (k,). Solves the windows with such a time anew. Returns probability and
        survival probability, shape (2, k), at which times they are new, and the part of their
        errors there that is not due to the grid, shape (k,).
    """
    return contour_solvers([problem], times, tol, None if saddles is None else [saddles])[0]


def contour_solvers(
    problems: Sequence[LaplaceProblem],
    times: np.ndarray,
    tol: float,
    saddles: list[SaddlePoints] | None = None,
) -> list[Solver]:
    """Prepare the inversion of several problems that may share what they compute.

    On a vertical line they ask for grids that serve all of them.

    Parameters
    ----------
    problems : sequence of LaplaceProblem
        Of one kind.
    times, tol
        As for `contour_solver`.
    saddles : list of SaddlePoints, optional
        The same.

    Returns
    -------
    list of callable
        As of `contour_solver`.
    """
    saddles = saddles or [saddle_points(problem, times) for problem in problems]
    kind: Callable = partial(_Inversion, tol)
    if problems[0].on_vertical_lines:
        kind = partial(_OnVerticalLines, _needs(problems, times, saddles), tol)

    def solver(problem, own):
        return lambda level, known, wanted: kind(problem, times, own, level, known, wanted).run()

    return [solver(*one) for one in zip(problems, saddles, strict=True)]


class _Inversion:
    """The inversion on one level.

    Parameters
    ----------
    tol : float
    problem : LaplaceProblem
    times : numpy.ndarray, shape (k,)
    saddles : SaddlePoints
    level : ContourLevel
    known, wanted
        As for `contour_solver`.
    """

    def __init__(
        self,
        tol: float,
        problem: LaplaceProblem,
        times: np.ndarray,
        saddles: SaddlePoints,
        level: ContourLevel,
        known: np.ndarray,
        wanted: np.ndarray,
    ):
        self.tol, self.problem, self.times, self.saddles = tol, problem, times, saddles
        self.level, self.known, self.wanted = level, known, wanted
        self.found, self.solved = known.copy(), np.full(len(times), False)
        self.inexact = np.zeros(len(times))

    def run(self):
        """Solve the stages one after the other."""
        settings = self.problem.settings
        begin = _begin(self.problem, self.saddles)
        ends = settings.relative and self.problem.two_sided
        late = begin + self._first_small(self.known[1, begin:]) if ends else len(self.times)
        windows = self._windows_of_later(begin, late)
        risen = windows[0][0].start if windows else late
        self._rise(begin, risen)
        self._later(windows)
        if ends:
            self._end(risen)
        return self.found, self.solved, self.inexact

    def _windows_of_later(self, begin, end):
        """Return windows that hyperbolas serve, each with the kind of hyperbola."""
        return list(_hyperbolic(self.times, self.saddles, begin, end))

    def _first_small(self, survival):
        return int(np.searchsorted(-survival, -tuning.INVERSION.small))

    def _transform(self, here):
        return self.problem.transform(
            self.level.resolution, self.times[here], -self.saddles.bound[here][0]
        )

    def _store(self, here, values, row=0, inexact=0.0):
        """Keep the values of the probability, row 0, or of the survival probability, row 1."""
        self.inexact[here] = inexact
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
        fits = tuning.CONTOUR_FITS
        windows = [(here, kind) for here, kind in windows if self.wanted[here].any()]
        if not windows:
            return
        transform = self._transform(slice(windows[0][0].start, windows[-1][0].stop))
        laid = [(self._hyperbola(*window).over_z(), self.times[window[0]]) for window in windows]
        found = contours.inverted_together(
            transform,
            laid,
            self.problem.settings.steady_truncation,
            fits.share * min(self.tol, fits.loosest),
        )
        for (here, _), values in zip(windows, found, strict=True):
            self._store(here, values)

    def _end(self, risen):
        """Solve windows in which the survival probability is small."""
        kind, late = tuning.INVERSION.steady, risen + self._first_small(self.found[1, risen:])
        if not self.wanted[late:].any():
            return
        pole = _leading_pole(self._transform(slice(late, None)), self.times[late])
        for here in _windows(late, len(self.times), (self.times, kind.ratio)):
            if self.wanted[here].any():
                integrand = _of_survival(self._transform(here))
                contour = self._hyperbola(here, kind, pole)
                truncation = self.problem.settings.steady_truncation
                found = contours.inverted(integrand, contour, self.times[here], truncation)
                self._store(here, found, 1)

    def _hyperbola(self, here, kind, pole=0.0):
        """Lay a hyperbola to the right of all poles, of which `pole` is the rightmost."""
        settings, times = tuning.INVERSION, self.times[here]
        first, last = times[0], max(times[-1], settings.shortest * times[0])
        nodes = round(self.level.nodes + kind.more + settings.per_decade * np.log10(last / first))
        return contours.hyperbola(first, last, nodes, kind.sector, pole)


class _OnVerticalLines(_Inversion):
    """The inversion on one level, by rational fits on vertical lines but at the end.

    Parameters
    ----------
    needs : dict
        What a grid has to serve, see `_needs`.
    tol, problem, times, saddles, level, known, wanted
        As for `_Inversion`.
    """

    def __init__(self, needs: dict, *of_level):
        super().__init__(*of_level)
        self.needs = needs

    def _windows_of_later(self, begin, end):
        """One window from where the probability is no longer small."""
        first = _risen(self.saddles, begin)
        return [(slice(first, end), None)] if first < end else []

    def _rise(self, begin, end):
        """Solve windows in which the probability is still small, the last first."""
        settings, negligible, above = self.problem.settings, begin, 0.0
        of_rise = _lines_of_rise(self.problem, self.times, self.saddles, begin, end)
        for here, abscissa in reversed(of_rise):
            self._on_line(here, abscissa, rising=True)
            # if the probability is negligible here, although its bound is not, it is so before
            first = here.start
            if abs(self.found[0, first]) < tuning.INVERSION.surely * settings.least_probability:
                negligible, above = first, self.inexact[first]
                break
        inexact = np.minimum(np.exp(self.saddles.bound[:negligible]), above)
        self._store(slice(negligible), np.zeros(negligible), inexact=inexact)

    def _later(self, windows):
        """Solve the window after the rise, on the line that serves its last time."""
        lines, last = tuning.VERTICAL_LINES, self.times[-1]
        for here, _ in windows:
            steps = np.log(last / self.times[here.stop - 1]) // np.log(lines.ratio)
            self._on_line(here, lines.ratio**steps / last, rising=False)

    def _on_line(self, here, abscissa, rising):
        """Fit F on a line, unless this is not wanted, and invert it."""
        if not self.wanted[here].any():
            return
        turn = self.problem.settings.levels.index(self.level) % 2
        first, last, rarity = self.needs[abscissa if rising else None]
        of_grid = self.level.resolution, np.array([first, last]), rarity
        parts, fronts = self.problem.parts(*of_grid)
        values, inexact = np.zeros(here.stop - here.start), 0.0
        if self.times[here.stop - 1] > fronts.min():
            line = self._line(parts, abscissa)
            accuracy = self._accuracy(line, here, rising)
            share, off = tuning.VERTICAL_LINES.negligible * min(accuracy, 1.0), 0.0
            # in the rise F is less than what bases leave out, and the best fits have no room for it
            if not rising and accuracy > tuning.VERTICAL_LINES.best:
                parts, off = self.problem.parts_on_line(parts, of_grid, line.abscissa, accuracy)
            begun = np.maximum(fronts, self.saddles.begin(line.abscissa, share))
            found = vertical_lines.inverted(parts, line, begun, accuracy, rising, offset=turn / 2)
            values = found.at(self.times[here])
            growth = abs(line.size) * np.exp(line.abscissa * self.times[here])
            inexact = tuning.VERTICAL_LINES.inverse * (off + found.misfit + share) * growth
        self._store(here, values, inexact=inexact)

    def _line(self, parts, abscissa):
        """Return the line, or the first one to the left of it where F is more than rounded."""
        line = vertical_lines.line(parts, abscissa)
        while line.size <= 0 and abscissa * self.times[-1] > 1:
            abscissa /= tuning.VERTICAL_LINES.ratio
            line = vertical_lines.line(parts, abscissa)
        return line

    def _accuracy(self, line, here, rising):
        """Return how accurate a fit has to be, relative to the size of F."""
        lines = tuning.VERTICAL_LINES
        if not rising:
            return max(lines.best, lines.accuracy * self.tol)
        worst = max(lines.relative, self.tol) if self.problem.settings.relative else np.inf
        bound = abs(line.size) * np.exp(line.abscissa * self.times[here.stop - 1])
        bound = max(bound, tuning.REFINEMENT.underflow)
        return max(lines.rising, min(worst, lines.accuracy * self.tol / bound))


def _begin(problem, saddles):
    """Return the first time at which the probability is not negligible."""
    return int(np.searchsorted(saddles.bound, np.log(problem.settings.least_probability)))


def _risen(saddles, begin):
    """Return the first time from `begin` on at which the probability is no longer small."""
    return max(begin, int(np.searchsorted(saddles.bound, np.log(tuning.SADDLE_POINTS.risen))))


def _lines_of_rise(problem, times, saddles, begin, end):
    """Windows in which the probability is still small, with the places of their lines."""
    if begin == end:
        return []
    abscissas = saddles.on_lines(times, tuning.VERTICAL_LINES.ratio)
    turns = np.cumsum(np.diff(abscissas, prepend=abscissas[0]) != 0) + 1
    one_line = np.inf if not problem.settings.relative else 1
    windows = _windows(begin, end, (turns, one_line))
    return [(here, abscissas[here.stop - 1]) for here in windows]


def _needs(problems, times, saddles):
    """First time, last time and rarity that grids serve, for each abscissa; None is the last line.

    Each is that of the most demanding of the problems.
    """
    needs: dict = {}
    for problem, own in zip(problems, saddles, strict=True):
        begin = _begin(problem, own)
        risen = _risen(own, begin)
        windows = _lines_of_rise(problem, times, own, begin, risen)
        if risen < len(times):
            windows.append((slice(risen, len(times)), None))
        for here, abscissa in windows:
            need = times[here][0], times[here][-1], -own.bound[here][0]
            first, last, rarity = needs.get(abscissa, need)
            needs[abscissa] = min(first, need[0]), max(last, need[1]), max(rarity, need[2])
    return needs


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
