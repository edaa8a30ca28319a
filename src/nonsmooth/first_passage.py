"""Distribution of the first time at which int_0^t g leaves an interval, for one-dimensional scenes.

The Laplace transform of `transport`, inverted on hyperbolic contours. A contour serves times of one
window. Where the probability, or the survival probability, is small, its contour starts at the
saddle point or at the leading pole instead of 0: the error is then relative.
"""

import bisect
from functools import lru_cache

import numpy as np
from scipy.optimize import minimize_scalar, root_scalar

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.laplace import hyperbola
from nonsmooth.ordinates import ordinates
from nonsmooth.spectral import applies
from nonsmooth.transport import first_passage

# polynomial degree, nodes of a contour for a single time; more, of larger real part, would only
# make the rounding errors grow
_LEVELS = ((7, 9), (9, 11), (11, 12), (14, 13))
_PER_DECADE = 10  # nodes more for each decade of times
# half angles about the negative axis: of the poles; while the probability rises, its transform
# grows there, like exp(-c z^(3/4)) for a noise that is integrated twice
_SECTOR, _WIDE_SECTOR, _WIDER = 0.3, 1.0, 2  # the last: times as many nodes
_WINDOW, _NARROW = 10.0, 1.6  # last time over first time, of a contour; while it rises
_NEGLIGIBLE, _RISEN = 1e-14, 0.5  # bounds of the probability; below the first, it is taken as 0
_FINELY = 0.7  # grading of the elements while the probability rises
_SMALL = 1e-3  # survival probabilities below get contours of their own
_UNDERFLOW = 1e-300


def spectral_crossing(scene, lower, upper, times, tol):
    """P(int_0^t g leaves (lower, upper) before t).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float
        Absolute error wanted.

    Returns
    -------
    dict
        `probability`, `survival`, with their errors.

    Raises
    ------
    SceneError
        If the scene has more state variables, or other noise.
    ToleranceError
        If `tol` is not met; the message has the error.
    """
    if not applies(scene):
        raise SceneError(
            f"the spectral method needs the state (y) and white noise, not "
            f"({', '.join(scene.state)}) with {scene.noise.title}; use method='monte_carlo'"
        )
    begins, rises = _rise(scene, lower, upper, times)
    solution = _solve(scene, lower, upper, times, begins, rises, *_LEVELS[0])
    for level in _LEVELS[1:]:
        coarse, solution = solution, _solve(scene, lower, upper, times, begins, rises, *level)
        error = np.abs(solution - coarse) + 1e-13 * solution + _UNDERFLOW
        error[0] = np.where(solution[0] == 0, _NEGLIGIBLE, error[0])
        # the same event: what is known of the rarer of the two is known of both
        least = error.min(axis=0)
        error = np.where(error > 1e-12, least + 1e-15, error)
        if np.all(error <= tol):
            break
    else:
        raise ToleranceError(
            f"the crossing probability has an error of {error.max():.1e}, above tol = {tol:g}; "
            "loosen tol"
        )
    return {
        "probability": solution[0],
        "probability_error": error[0],
        "survival": solution[1],
        "survival_error": error[1],
    }


def _windows(times, first, end, ratio):
    """Slices of increasing times whose last is at most `ratio` times the first."""
    while first < end:
        last = min(end, int(np.searchsorted(times, times[first] * ratio, "right")))
        yield slice(first, last)
        first = last


def _rise(scene, lower, upper, times):
    """Places of the first times at which the probability is not negligible, and has risen."""

    @lru_cache
    def bound(k):
        grid = ordinates(scene, _LEVELS[0][0], times[k], _FINELY)
        return _chernoff(grid, lower, upper, times[k])[0]

    begins = bisect.bisect_left(range(len(times)), _NEGLIGIBLE, key=bound)
    return begins, bisect.bisect_left(range(len(times)), _RISEN, lo=begins, key=bound)


def _solve(scene, lower, upper, times, begins, rises, degree, count):
    """Probability and survival probability, shape (2, k)."""

    def grid(where, **graded):
        return ordinates(scene, degree, times[where][0], **graded)

    found = np.zeros((2, len(times)))
    for here in _windows(times, begins, rises, _NARROW):
        fine = grid(here, grading=_FINELY)
        _, saddle = _chernoff(fine, lower, upper, times[here][0])
        found[0, here] = _invert(
            fine, lower, upper, times[here], count, _WIDE_SECTOR, saddle, _probability
        )
    for here in _windows(times, rises, len(times), _WINDOW):
        found[0, here] = _invert(
            grid(here), lower, upper, times[here], count, _SECTOR, 0.0, _probability
        )
    found[1] = 1 - found[0]
    late = rises + np.searchsorted(-found[1, rises:], -_SMALL)
    if late < len(times) and np.isfinite(lower) and np.isfinite(upper):
        pole = _leading_pole(grid(slice(late, None)), lower, upper, times[late])
        for here in _windows(times, late, len(times), _WINDOW):
            found[1, here] = _invert(
                grid(here), lower, upper, times[here], count, _SECTOR, pole, _survival
            )
            found[0, here] = 1 - found[1, here]
    return found


def _probability(transform, z):
    return transform / z


def _survival(transform, z):
    return (1 - transform) / z


def _invert(grid, lower, upper, times, count, sector, begin, transform):
    """Invert on a contour that crosses the axis at `begin` or, if that is left of it, at its own.

    The pole a survival probability begins at is negative: there the contour keeps clear of it.
    """
    window = times[0], max(times[-1], 1.01 * times[0])
    count = count * (_WIDER if sector == _WIDE_SECTOR else 1)
    own = hyperbola(*window, round(count + _PER_DECADE * np.log10(window[1] / window[0])), sector)
    shift = begin if begin < 0 else max(0.0, begin - own.nodes[0].real)
    nodes = own.nodes + shift
    values = [transform(first_passage(grid, z, lower, upper), z) for z in nodes]
    return np.exp(shift * times) * own.invert(np.array(values), times)


def _chernoff(grid, lower, upper, time):
    """Least value of exp(z t) E exp(-z tau) over z > 0, a bound of P(tau <= t), and its place."""

    def height(log_z):
        z = np.exp(log_z)
        value = first_passage(grid, z, lower, upper).real
        # where the grid does not resolve the modes, it is not a transform of a probability
        return z * time + (np.log(value) if 0 < value < 1 else 0.0)

    least = minimize_scalar(
        height,
        bounds=np.log(np.array([1e-2, 120.0]) / time),
        method="bounded",
        options={"xatol": 0.02},
    )
    return float(np.exp(least.fun)), float(np.exp(least.x))


def _leading_pole(grid, lower, upper, time):
    """Largest pole of E exp(-z tau); at `time`, the survival probability is about _SMALL."""

    def inverse(z):
        return (1 / first_passage(grid, z, lower, upper)).real

    rate = -np.log(_SMALL) / time
    return float(root_scalar(inverse, x0=-rate / 2, x1=-0.8 * rate, rtol=1e-14).root)
