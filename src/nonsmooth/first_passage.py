"""Distribution of the first time at which int_0^t g leaves an interval.

Its Laplace transform, of `transport` for one state variable and of `first_passage_plane` for two,
inverted on hyperbolic contours. A contour serves times of one
window. Where the probability, or the survival probability, is small, its contour starts at the
saddle point or at the leading pole instead of 0: the error is then relative.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import root_scalar

from nonsmooth import far_start, first_passage_march, first_passage_plane, models
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.expressions import vectorised
from nonsmooth.first_passage_march import UnstableError
from nonsmooth.laplace import hyperbola, through_saddle
from nonsmooth.ordinates import ordinates
from nonsmooth.scene import Scene
from nonsmooth.spectral import applies, potential
from nonsmooth.transport import first_passage, waves

# polynomial degree; nodes of a contour for a single time, and their spacing while the probability
# rises; more nodes, of larger real part, would only make the rounding errors grow
_LEVELS = ((4, 7, 1.2), (7, 11, 0.85), (9, 13, 0.75), (11, 15, 0.7), (14, 17, 0.65))
_LOOSE = 1e-4  # tolerance that the first levels may meet
_PER_DECADE = 12  # nodes more for each decade of times
_SECTOR = 0.6  # half angle about the negative axis, of the poles and of what grows there
# last time over first time, of a contour, at most and at least; the rise of the probability in one,
# until it has risen
_WINDOW, _SHORTEST, _GROWTH = 20.0, 3.0, 1e4
_RISEN = 0.05  # bound of the probability at the end of the rise
# Off the axis the transform may grow, like exp(|z| t) where paths run almost as given. The arms of
# a contour have such an angle to the left of the vertical that the growth takes at most some share
# of the decay of exp(z t), at smaller angles, too, or poles lie between: of a hyperbola, at the
# last angle, for |z| t > _FAR; of a contour through a saddle, beyond the saddle. Not looked at is
# where exp(z t) < exp(-_NEGLIGIBLY); poles near the axis make the transform grow by a factor only.
_ARMS = (0.2, 0.4, 0.67)
_STEEPEST = 0.0
_TAME, _FAR, _TAMED, _NEGLIGIBLY, _HARMLESS = 0.08, 6.0, 0.3, 30.0, 0.7
_MOST = 80  # terms of a contour through a saddle
# of the decay per relaxation time of a slow crossing, as measured against the second order formula;
# without symmetry the slow mode is not apart
_ROUNDING = {True: 1e-14, False: 1e-13}
_SAFETY = {True: 1.0, False: 3.0}  # without symmetry levels do not converge regularly
_SURELY = 0.1  # of what is negligible: two levels below, and their difference, leave it so
_SMALL = 1e-3  # survival probabilities below get contours of their own
_TAIL = 16.0  # depth of a start beyond which the modes lose digits
_UNDERFLOW = 1e-300
_DENSER = 0.65  # spacing of nodes where, from a far start, the probability rises fast up to 1
_NEGLECTED = 1e-9  # bound of what is left out of the law of a far start
_AXIS, _COARSE = 0.6, 6  # spacing of log z on the axis in the search for saddles; degree
_SPARE = 18.0  # exponent of what is neglected, relative to the probability
_DEPTH = 26.0  # the grid ends where the density has fallen by exp(-26), relative to the same
_LARGEST, _FINE = 150.0, 0.01  # z t at most; spacing of log z of the spline


def spectral_crossing(scene, lower, upper, times, tol):
    """P(int_0^t g leaves (lower, upper) before t).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise, or one to which `first_passage_plane` applies.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float or None
        Absolute error wanted; 1e-7, or 1e-4 for two variables, unless given.

    Returns
    -------
    dict
        `probability`, `survival`, with their errors.

    Raises
    ------
    SceneError
        If the scene is of another kind.
    ToleranceError
        If `tol` is not met; the message has the error.
    """
    if applies(scene):
        problem = _Line(scene, lower, upper)
    elif first_passage_plane.applies(scene):
        problem = first_passage_plane.Plane(scene, lower, upper)
        tol = problem.tol if tol is None else tol
        if first_passage_march.applies(problem, times):
            problem = first_passage_march.March(scene, lower, upper)
            try:
                return _refined(problem, times, tol, partial(_marched, problem, times))
            except UnstableError:  # slabs are not
                problem = first_passage_plane.Plane(scene, lower, upper)
    else:
        raise SceneError(
            "the spectral method needs the state (y) and white noise, or two state variables with "
            "finite n, odd g and drift, and white or Langevin noise, not "
            f"({', '.join(scene.state)}) with {scene.noise.title} and n = {scene.n:g}; "
            "use method='monte_carlo'"
        )
    try:
        tol = problem.tol if tol is None else tol
        if applies(scene) and _start_depth(scene) > _TAIL:
            return _from_afar(scene, lower, upper, times, tol)
        return _refined(problem, times, tol, _by_contours(problem, times))
    except (np.linalg.LinAlgError, RuntimeError) as error:  # of dense and of sparse matrices
        raise ToleranceError(
            f"the modes of the transport equation are not finite, as where g has a pole ({error}); "
            "use method='monte_carlo'"
        ) from None


def default_tolerance(scene):
    """Return the absolute error that `spectral_crossing` keeps unless told; None if it cannot."""
    if applies(scene):
        return _Line.tol
    return first_passage_plane.Plane.tol if first_passage_plane.applies(scene) else None


@dataclass(frozen=True)
class _Line:
    """A scene with the state y and white noise, and an interval.

    Attributes
    ----------
    relative : bool
        Whether small probabilities are wanted to relative accuracy.
    """

    scene: Scene
    lower: float
    upper: float
    tol = 1e-7
    relative = True
    levels, loose = _LEVELS, _LOOSE
    cure = "loosen tol"
    # what is taken as 0: probabilities, and values of the transform
    negligible, rounded = 1e-14, 1e-70
    inexact = 1e-13  # what no refinement shows, relative
    # last time over first time of a contour while the probability rises, and terms left out there
    narrow, last = 2.5, 1e-12

    @property
    def two_sided(self):
        """Whether both levels are finite."""
        return np.isfinite(self.lower) and np.isfinite(self.upper)

    def near_axis(self, radius, depth):
        """Return z -> E exp(-z tau) for |z| = radius; on the axis, of the order exp(-depth)."""
        time = depth / radius
        return self._on(_COARSE, time, self._reach(time, depth / 2), _DEPTH + depth)

    def transform(self, degree, times, rarity):
        """Return z -> E exp(-z tau) for probabilities from exp(-rarity) on, at given times."""
        return self._on(degree, times[0], self._reach(times[-1], rarity), _DEPTH + rarity)

    def _on(self, degree, time, reach, depth):
        grid = ordinates(
            self.scene, degree, time, reach, depth, distances=(-self.lower, self.upper)
        )
        return lambda z: first_passage(grid, z, self.lower, self.upper)

    def _reach(self, time, depth):
        """Change of velocity that is exceeded by `time` with at most 4 exp(-depth - _SPARE).

        That of Brownian motion without drift, which points to the origin.
        """
        return self.scene.noise.sigma * np.sqrt(2 * time * (depth + _SPARE))


@dataclass(frozen=True)
class _Late(_Line):
    """What is left of a far start after its descent to the bulk.

    Attributes
    ----------
    tail : far_start.Tail
    """

    tail: far_start.Tail
    relative = False
    levels = tuple((degree, count, _DENSER * spacing) for degree, count, spacing in _LEVELS)
    last = 1e-9
    cure = "loosen tol, or use method='monte_carlo'"

    def _on(self, degree, time, reach, depth):
        tail = self.tail
        grid = ordinates(
            replace(self.scene, start={"y": tail.side * tail.level}),
            degree,
            time,
            reach,
            depth,
            distances=(-self.lower, self.upper),
        )
        march = far_start.march(tail, self.lower, self.upper, degree)
        return lambda z: march.mean(z, *waves(grid, z, self.lower, self.upper))


def _from_afar(scene, lower, upper, times, tol):
    """`spectral_crossing` from a start in the tail: normal at first, then by `_Late`."""
    tail = far_start.tail(scene)
    distance = upper if tail.towards > 0 else -lower
    passed = np.array([tail.law(t).passed(distance) for t in np.minimum(times, tail.flight)])
    error = np.full(len(times), _NEGLECTED)
    late = times > tail.flight
    if late.any() and 1 - tail.law(tail.flight).passed(distance) > _NEGLECTED:
        left = 1 - tail.law(tail.descent).passed(distance)
        problem = _Late(scene, lower, upper, tail)
        # a level may no more than halve the error
        rest = times[late] - tail.descent
        found = _refined(problem, rest, tol / (2 * left), _by_contours(problem, rest))
        passed[late] = 1 - left * found["survival"]
        error[late] += 2 * left * found["probability_error"]
    return {
        "probability": passed,
        "probability_error": error,
        "survival": 1 - passed,
        "survival_error": error,
    }


def _by_contours(problem, times):
    """Return what solves the problem at a level by inverting the transform, as `_refined` asks."""
    return partial(_solve, problem, times, _saddles(problem, times))


def _marched(problem, times, level, _known, _wanted):
    return problem.solve(times, *level), np.full(len(times), True)


def _refined(problem, times, tol, solve):
    """Refine until two levels agree.

    `solve` takes a level, what is known, and the times at which more is wanted; it returns what is
    known then and where it has been solved anew.
    """
    worst = np.inf
    first = 0 if tol >= problem.loose else 1
    wanted, change = np.full(len(times), True), 0.0
    found, _ = solve(problem.levels[first], np.zeros((2, len(times))), wanted)
    odd = problem.scene.is_odd()
    for level in problem.levels[first + 1 :]:
        coarse, (found, solved) = found, solve(level, found, wanted)
        solution = np.clip(found, 0.0, 1.0)
        # not clipped before: two contours that both fail would agree on 0 or 1
        new = _SAFETY[odd] * np.abs(found - coarse) + np.abs(found - solution)
        change = np.where(solved, new, change)
        error = _largest_nearby(change, solution if problem.relative else 1 + 0 * change, times)
        error += problem.inexact * solution + _UNDERFLOW
        error += _ROUNDING[odd] * problem.scene.damping * times * solution[0] * solution[1]
        error[0] = np.where(solution[0] == 0, np.maximum(problem.negligible, error[0]), error[0])
        # the same event: what is known of the rarer of the two is known of both
        least = error.min(axis=0)
        error = np.where(error > 1e-12, least + 1e-15, error)
        if np.all(error <= tol):
            return {
                "probability": solution[0],
                "probability_error": error[0],
                "survival": solution[1],
                "survival_error": error[1],
            }
        if not error.max() < worst:  # rounding: finer grids do not help
            break
        worst = error.max()
        wanted = np.any(error > tol, axis=0)
    raise ToleranceError(
        f"the crossing probability has an error of {error.max():.1e}, above tol = {tol:g}; "
        f"{problem.cure}"
    )


def _start_depth(scene):
    """Logarithm of the largest invariant density over that at the start."""
    energy, _ = potential(scene)
    return float(vectorised(energy, (models.y,))(scene.start.get("y", 0.0)))


def _largest_nearby(errors, values, times):
    """Largest error within a factor of two in time, for single ones may vanish by chance.

    Those of larger values count relative to the value.
    """
    near = np.abs(np.log(times[:, None] / times)) <= np.log(2)
    values = np.maximum(values, _UNDERFLOW)
    share = np.minimum(values[:, :, None] / values[:, None, :], 1.0)
    return np.max(near * share * errors[:, None, :], axis=2)


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
    rising : numpy.ndarray of bool, shape (k,)
        Whether the probability is small or the transform grows too fast for a hyperbola.
    """

    place: np.ndarray
    width: np.ndarray
    bound: np.ndarray
    tilt: np.ndarray
    rising: np.ndarray


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
        return _Saddles(nothing, nothing, nothing + np.log(problem.rounded), nothing, nothing > 0)
    last = log_z[len(log_F) - 1]
    spline = CubicSpline(log_z[: len(log_F)], log_F)
    fine = np.linspace(first, last, int((last - first) / _FINE))
    z, cumulant, slope, bend = np.exp(fine), *(spline(fine, k) for k in range(3))
    radii = np.exp(log_z[: len(log_F)])
    growth = np.array(arms)
    bound, place, width, tilt, rising = [], [], [], [], []

    def tame(count, share, t, least):
        decay = radii[:, None] * t * np.sin(_ARMS[:count])
        seen = (radii[:, None] > least) & (decay < _NEGLIGIBLY)
        return np.all((growth[:, :count] <= _HARMLESS + share * decay)[seen])

    for t in times:
        bound.append(np.min(z * t + cumulant))
        rising.append(bound[-1] < np.log(_RISEN) or not tame(len(_ARMS), _TAME, t, _FAR / t))
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
        np.array(rising),
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


def _solve(problem, times, saddles, level, known, wanted):
    """Probability and survival probability, shape (2, k), anew in windows with a wanted time."""
    resolution, count, spacing = level
    begins = np.searchsorted(saddles.bound, np.log(problem.negligible))
    rises = max(begins, np.max(np.flatnonzero(saddles.rising) + 1, initial=0))
    found, solved = known.copy(), np.full(len(times), False)

    def transform(where):
        return problem.transform(resolution, times[where], -saddles.bound[where][0])

    def around_poles(where, first=0.0):
        """Contour to the right of the poles, of which `first` is the largest."""
        begin, end = times[where][0], max(times[where][-1], _SHORTEST * times[where][0])
        nodes = round(count + _PER_DECADE * np.log10(end / begin))
        return hyperbola(begin, end, nodes, _SECTOR, first)

    def store(here, values, of_survival=False):
        found[int(of_survival), here], found[1 - int(of_survival), here] = values, 1 - values
        solved[here] = True

    rise = [
        (here, transform(here))
        for here in _windows(
            begins, rises, (times, problem.narrow), (np.exp(saddles.bound), _GROWTH)
        )
        if wanted[here].any()
    ]
    negligible = begins
    for here, of_rise in reversed(rise):
        last = here.stop - 1  # at whose saddle the integrand is small at all earlier times, too
        tilt = np.min(saddles.tilt[here])
        contour = through_saddle(saddles.place[last], saddles.width[last], spacing, tilt)
        store(here, _probability(of_rise, contour, times[here], problem.last))
        # the probability increases: earlier ones are negligible, too, and the bound was too weak
        if problem.relative and abs(found[0, here.start]) < _SURELY * problem.negligible:
            negligible = here.start
            break
    store(slice(negligible), np.zeros(negligible))
    for here in _windows(rises, len(times), (times, _WINDOW)):
        if wanted[here].any():
            contour = around_poles(here)
            store(here, _probability(transform(here), contour, times[here], problem.last))
    late = rises + np.searchsorted(-found[1, rises:], -_SMALL)
    if wanted[late:].any() and problem.relative and problem.two_sided:
        pole = _leading_pole(transform(slice(late, None)), times[late])
        for here in _windows(late, len(times), (times, _WINDOW)):
            if wanted[here].any():
                values = _survival(transform(here), around_poles(here, pole), times[here])
                store(here, values, of_survival=True)
    return found, solved


def _probability(transform, contour, times, last):
    values = []
    for z, weight in zip(contour.nodes, contour.weights, strict=True):
        values.append(transform(z) / z)
        term = np.abs(weight * values[-1]) * np.exp(z.real * times[0])
        if len(values) == 1:
            largest = term
        elif term < last * largest or len(values) == _MOST:
            break
    return contour.until(len(values)).invert(np.array(values), times)


def _survival(transform, contour, times):
    return contour.invert(np.array([(1 - transform(z)) / z for z in contour.nodes]), times)


def _leading_pole(transform, time):
    """Largest pole of E exp(-z tau); at `time`, the survival probability is about _SMALL."""

    def inverse(z):
        return (1 / transform(z)).real

    rate = -np.log(_SMALL) / time
    return float(root_scalar(inverse, x0=-rate / 2, x1=-0.8 * rate, rtol=1e-14).root)
