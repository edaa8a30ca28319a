"""The saddle points of the inverse Laplace transform, and how far contours may bend.

For a probability, the integrand is exp(z t) F(z) / z with F(z) = E exp(-z tau). On the positive
axis it has a minimum, the saddle point: a contour through it has no larger values than the result,
so that nothing cancels. The least value of exp(z t) F(z) is Chernoff's bound of P(tau <= t).

Away from the axis F is not always small. If all paths cross after almost the same time t_0, then
F(z) is about exp(-z t_0), which grows for Re z < 0. A contour may bend to the left only as far as
exp(z t) falls much faster than F grows. F is therefore also measured on some rays.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.problem import LaplaceProblem
from nonsmooth.errors import ToleranceError
from nonsmooth.progress import begin


@dataclass(frozen=True)
class SaddlePoints:
    """Saddle points of the integrand of the probability, for each time, and what they allow.

    Attributes
    ----------
    place, width : numpy.ndarray, shape (k,)
        z, and the standard deviation of the integrand along a contour through it.
    bound : numpy.ndarray, shape (k,)
        Logarithm of Chernoff's bound of the probability.
    tilt : numpy.ndarray, shape (k,)
        Angle to the vertical of the arms of a contour through it.
    early, steady : numpy.ndarray of bool, shape (k,)
        Whether a hyperbola of that kind serves: the probability is not small, and F grows little.
    axis : tuple of numpy.ndarray, shape (f,)
        Places on the axis, and log F there.
    """

    place: np.ndarray
    width: np.ndarray
    bound: np.ndarray
    tilt: np.ndarray
    early: np.ndarray
    steady: np.ndarray
    axis: tuple[np.ndarray, np.ndarray]

    def begin(self, abscissa: float, share: float) -> float:
        """Time before which only a share of F, at a place on the axis, has arisen; at least 0.

        This is Chernoff's bound for the law of tau with the density exp(-z tau) / F(z).
        """
        z, log_F = self.axis
        right = z > abscissa
        fallen = np.interp(abscissa, z, log_F) - log_F[right]
        return float(np.max((np.log(share) + fallen) / (z[right] - abscissa), initial=0.0))

    def on_lines(self, times: np.ndarray, ratio: float) -> np.ndarray:
        """Return where on a lattice exp(z t) F(z) is least, for each time.

        The lattice is that of ratio^k over the last time. Its bounds are little above Chernoff's,
        and one place serves all times between two turns.
        """
        z, log_F = self.axis
        places = ratio ** np.arange(1 + max(0.0, np.log(z[-1] * times[-1]) // np.log(ratio)))
        places /= times[-1]
        exponents = np.outer(times, places) + np.interp(np.log(places), np.log(z), log_F)
        return places[np.argmin(exponents, axis=1)]


def saddle_points(problem: LaplaceProblem, times: np.ndarray) -> SaddlePoints:
    """Find the saddle points by a spline of log F over log z on the axis.

    Parameters
    ----------
    problem : LaplaceProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.

    Returns
    -------
    SaddlePoints

    Raises
    ------
    ToleranceError
        If F is no transform of a probability on a coarse grid.
    """
    begin()
    log_z, log_F, growth = _samples(problem, times)
    # -log F grows at most by the factor exp(spacing) from one sample to the next. If the second one
    # is rounding already, F is tiny at all z: nothing crosses.
    if len(log_F) < 2:
        nothing = np.zeros(len(times))
        bound, fits = nothing + np.log(problem.settings.least_transform), nothing == 0
        return SaddlePoints(nothing, nothing, bound, nothing, fits, fits, (np.exp(log_z), log_F))
    axis = _axis(log_z, log_F, growth)
    place, width, bound, tilt, early, steady = zip(*(axis.at(t) for t in times), strict=True)
    return SaddlePoints(
        np.array(place),
        np.array(width),
        np.maximum.accumulate(bound),
        np.array(tilt),
        np.array(early),
        np.array(steady),
        (axis.z, axis.log_F),
    )


def in_common(several: Sequence[SaddlePoints], counts: np.ndarray) -> SaddlePoints:
    """Combine those of several problems, so that one contour serves all of them.

    It crosses the axis at the least of the places: a smaller probability, whose own place is
    farther, keeps its absolute accuracy there. Its arms bend as far as those of all problems may.

    Parameters
    ----------
    several : sequence of SaddlePoints
        For the same times.
    counts : numpy.ndarray of bool, shape (m, k)
        Which problem counts at which time.

    Returns
    -------
    SaddlePoints
        With the axis of the first.
    """
    counts = counts | ~counts.any(axis=0)

    def smallest(name):
        return np.min([getattr(own, name) for own in several], axis=0, where=counts, initial=np.inf)

    def everywhere(name):
        return np.all(~counts | [getattr(own, name) for own in several], axis=0)

    return replace(
        several[0],
        place=smallest("place"),
        width=smallest("width"),
        bound=np.max([own.bound for own in several], axis=0),
        tilt=smallest("tilt"),
        early=everywhere("early"),
        steady=everywhere("steady"),
    )


def _samples(problem, times):
    """Sample log F on the axis and log |F| on the rays, at the same |z|, until F is rounding.

    Problems that are inverted on vertical lines need no rays.
    """
    settings = tuning.SADDLE_POINTS
    angles = () if problem.on_vertical_lines else settings.angles
    first, last = np.log([settings.first / times[-1], settings.largest / times[0]])
    log_z = np.arange(first, last + settings.spacing, settings.spacing)
    log_F: list[float] = []
    growth = []
    for z in np.exp(log_z):
        # z is the saddle point of the time t = -(d log F / d log z) / z, and z t is at most -log F
        depth = max(1.0, -(1 + settings.spacing) * log_F[-1]) if log_F else 1.0
        transform = problem.coarse_transform(z, depth)
        value = transform(z).real
        if not -settings.inexact <= value <= 1 + settings.inexact:
            raise ToleranceError(
                f"the Laplace transform of the time of passage is {value:.2g} on a coarse grid and "
                "not between 0 and 1, as where a path starts far in the tails, or p is huge; start "
                "nearer, or use method='corrected' or 'monte_carlo'"
            )
        if value < problem.settings.least_transform:
            break
        log_F.append(np.log(value))
        growth.append([_size(transform, z * np.exp(1j * (np.pi / 2 + angle))) for angle in angles])
    return log_z[: len(log_F)], np.array(log_F), np.array(growth)


def _size(transform: Callable, z):
    """Logarithm of |F|; infinite where F has no value."""
    try:
        return np.log(abs(transform(z)))
    except np.linalg.LinAlgError:
        return np.inf


def _axis(log_z, log_F, growth):
    spline = CubicSpline(log_z, log_F)
    count = int((log_z[-1] - log_z[0]) / tuning.SADDLE_POINTS.fine)
    fine = np.linspace(log_z[0], log_z[-1], count)
    return _Axis(
        np.exp(log_z), growth, fine, np.exp(fine), *(spline(fine, order) for order in range(3))
    )


@dataclass(frozen=True)
class _Axis:
    """F on the positive axis, finely interpolated, and its growth on the rays.

    Attributes
    ----------
    radii : numpy.ndarray, shape (r,)
    growth : numpy.ndarray, shape (r, a)
        log |F| at these distances from 0, on each ray.
    log_z, z, log_F, slope, bend : numpy.ndarray, shape (f,)
        log F and its derivatives with respect to log z.
    """

    radii: np.ndarray
    growth: np.ndarray
    log_z: np.ndarray
    z: np.ndarray
    log_F: np.ndarray
    slope: np.ndarray
    bend: np.ndarray

    def at(self, t):
        """Place, width, bound, tilt, early and steady of `SaddlePoints` for a time."""
        settings = tuning.SADDLE_POINTS
        bound = np.min(self.z * t + self.log_F)
        best = np.argmin(self.z * t + self.log_F - self.log_z)
        place = self.z[best]
        # second derivative of the exponent z t + log F - log z in log z
        bend = max(self.bend[best] - self.slope[best] + 1, settings.least_bend)
        # the arms of a contour take the angle of a ray; F must also grow little on the rays between
        # it and the axis, for otherwise there are poles
        fitting = [
            k
            for k in (1, 2)
            if place < self.radii[-1] and self._grows_little(k, settings.tamed, t, place)
        ]
        return (
            place,
            place / np.sqrt(bend),
            bound,
            settings.angles[max(fitting) - 1] if fitting else settings.steepest,
            self._serves(t / tuning.INVERSION.early.since),
            self._serves(t / tuning.INVERSION.steady.since),
        )

    def _serves(self, t):
        """Whether the probability is not small and F grows little enough for a hyperbola."""
        settings = tuning.SADDLE_POINTS
        risen = np.min(self.z * t + self.log_F) >= np.log(settings.risen)
        everywhere = len(settings.angles)
        return risen and self._grows_little(everywhere, settings.tame, t, settings.far / t)

    def _grows_little(self, rays, share, t, least):
        """Whether on the first rays log |F| is at most a share of the fall of exp(z t).

        Only radii above the least one are examined, as far out as exp(z t) is not negligible.
        """
        settings = tuning.SADDLE_POINTS
        rays = min(rays, self.growth.shape[1])
        fall = self.radii[:, None] * t * np.sin(settings.angles[:rays])
        seen = (self.radii[:, None] > least) & (fall < settings.negligibly)
        return np.all((self.growth[:, :rays] <= settings.harmless + share * fall)[seen])
