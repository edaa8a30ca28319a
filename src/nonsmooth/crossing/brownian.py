"""Threshold crossing of Brownian motion that starts at 0 between two levels.

With the distances near <= far of the levels from 0, L = near + far, r = sqrt(2 T) and
z = pi^2 T / (2 L^2), it stays between them up to T with the probability

    4/pi sum_{odd n} sin(n pi near/L)/n exp(-n^2 z)                                    (modes)
  = erf(near/r) - sum_k (-1)^k [erfc((k L + far)/r) - erfc(((k+1) L + near)/r)]        (images),

the paper's series and the one that Poisson summation makes of it. The images are used where
near >= sqrt(T), because nothing cancels there, or where L >= 10 sqrt(T), because the sum over k is
below rounding there. The modes are used elsewhere; all terms that matter have the same sign there.
"""

import math
from collections.abc import Callable
from functools import wraps
from typing import TypeVar

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.special import erf, erfc, erfcx

from nonsmooth.checks import require_numbers
from nonsmooth.crossing import tuning
from nonsmooth.errors import SceneError
from nonsmooth.scenes.thresholds import bounds

Function = TypeVar("Function", bound=Callable)
_SIZES = 1e-75, 1e75  # the fourth power of what is between is in double precision
_TIMES = 1e-300, 1e75  # levels further than some roots of T are cut, so that T may be smaller
_MOST_VALUES = 10**7  # take seconds, and a gigabyte


def _keeping_coordinates(title: str) -> Callable[[Function], Function]:
    """Make a function of arrays one that also takes xarray's, whose coordinates the result has."""

    def decorate(function):
        @wraps(function)
        def evaluate(b, T, lower=None):
            if not any(isinstance(one, xr.DataArray) for one in (b, T, lower)):
                return function(b, T, lower)
            given = (b, T) if lower is None else (b, T, lower)
            try:
                found = xr.apply_ufunc(function, *given)
            except ValueError:  # of labels and sizes; wrong values are SceneErrors
                raise SceneError(
                    "b, T and lower do not fit together: a dimension has several sizes or "
                    "coordinates, or no name; give each list as an xarray.DataArray with its name"
                ) from None
            return found.rename(None).assign_attrs(long_name=title, units="1")

        return evaluate

    return decorate


@_keeping_coordinates("probability of a crossing")
def brownian_crossing(b: ArrayLike, T: ArrayLike, lower: ArrayLike | None = None) -> np.ndarray:
    """Probability that W reaches b or the lower level before T, W_star of eq. (34) of the paper.

    Parameters
    ----------
    b : array_like
        Upper level, "1"; positive, inf if there is none.
    T : array_like
        Horizon, "1"; non-negative and finite.
    lower : array_like, optional
        Lower level, "1"; negative, -inf if there is none. -b unless given.

    Returns
    -------
    numpy.ndarray
        Of the shape that the arguments broadcast to. The relative error is some units in the last
        place, and as many times the exponent where the value is exponentially small. The value is 0
        at T = 0, and where it is below the smallest double. If an argument is an
        xarray.DataArray, so is the result, with its coordinates.

    Raises
    ------
    SceneError
        If an argument is out of range.
    """
    path = _Path(b, T, lower)
    early = path.tail(path.near) + path.reflected(path.tail)
    return path.chosen(early, 1 - path.modes(lambda n: 4 / (np.pi * n)), at_once=0.0)


def brownian_exit(b: float, T: ArrayLike, lower: float) -> np.ndarray:
    """Probability that W reaches b before T and before the lower level.

    Parameters
    ----------
    b, lower : float
        lower < 0 < b, each possibly infinite.
    T : array_like
        Horizons, "1"; at 0 no level has been reached.

    Returns
    -------
    numpy.ndarray
        With an absolute error of some units in the last place of 1.
    """
    T = np.asarray(T, dtype=float)
    if np.isinf(b):
        return np.zeros(T.shape)
    root = np.sqrt(2 * np.maximum(T, np.finfo(float).tiny))
    if np.isinf(lower):
        return erfc(b / root)
    width = b - lower
    late = -lower / width - _modes(b, T, width, lambda k: 2 / (np.pi * k))
    early = sum(
        erfc((k + b) / root) - erfc((k + 2 * width - b) / root) for k in _round_trips(width)
    )
    return np.where(width**2 > T, early, late)


def brownian_exit_density(b: float, T: ArrayLike, lower: float) -> np.ndarray:
    """Density in T of `brownian_exit`, with a relative error of some units in the last place.

    Parameters are those of `brownian_exit`; T is positive.

    Returns
    -------
    numpy.ndarray
    """
    T = np.asarray(T, dtype=float)
    if np.isinf(b):
        return np.zeros(T.shape)

    def rate(distance):
        return distance / np.sqrt(2 * np.pi * T**3) * np.exp(-(distance**2) / (2 * T))

    if np.isinf(lower):
        return rate(b)
    width = b - lower
    late = _modes(b, T, width, lambda k: np.pi * k / width**2)
    early = sum(rate(k + b) - rate(k + 2 * width - b) for k in _round_trips(width))
    return np.where(width**2 > T, early, late)


def _round_trips(width):
    """Lengths of the ways back and forth between the levels; enough of them for T < width^2."""
    return 2 * width * np.arange(tuning.BROWNIAN_SERIES.exit_turns)


def _modes(b, T, width, weight):
    """Sum over the eigenfunctions; enough of them for T > width^2."""
    return sum(
        weight(k) * np.sin(k * np.pi * b / width) * np.exp(-T * (k * np.pi / width) ** 2 / 2)
        for k in tuning.BROWNIAN_SERIES.exit_modes
    )


@_keeping_coordinates("probability of no crossing")
def brownian_survival(b: ArrayLike, T: ArrayLike, lower: ArrayLike | None = None) -> np.ndarray:
    """Probability that W stays below b and above the lower level up to T, 1 - W_star.

    The relative accuracy is that of `brownian_crossing`, however small the value, and so are the
    errors raised.

    Parameters
    ----------
    b, T, lower : array_like
        As for `brownian_crossing`.

    Returns
    -------
    numpy.ndarray
    """
    path = _Path(b, T, lower)
    early = erf(path.near / np.sqrt(2 * path.T)) - path.reflected(path.tail)
    return path.chosen(early, path.modes(lambda n: 4 / (np.pi * n)), at_once=1.0)


@_keeping_coordinates("density of the first crossing")
def brownian_first_passage_density(
    b: ArrayLike, T: ArrayLike, lower: ArrayLike | None = None
) -> np.ndarray:
    """Density in T of the time when W first reaches b or the lower level, d W_star / d T.

    The relative accuracy is that of `brownian_crossing`, however small the value, and so are the
    errors raised.

    Parameters
    ----------
    b, T, lower : array_like
        As for `brownian_crossing`.

    Returns
    -------
    numpy.ndarray
    """
    path = _Path(b, T, lower)
    early = path.rate(path.near) + path.reflected(path.rate)
    return path.chosen(early, path.modes(lambda n: 2 * np.pi * n / path.width**2), at_once=0.0)


class _Path:
    """Levels and horizon, broadcast and checked, and the terms of the two series."""

    def __init__(self, b, T, lower):
        b, T = require_numbers("b", b, *_SIZES), require_numbers("T", T, *_TIMES)
        lower = -b if lower is None else require_numbers("lower", lower, *_SIZES)
        try:
            size = math.prod(np.broadcast_shapes(b.shape, lower.shape, T.shape))
            if size > _MOST_VALUES:
                raise SceneError(f"b and T make {size} values; ask for at most {_MOST_VALUES}")
            b, lower, T = np.broadcast_arrays(b, lower, T)
        except ValueError:
            raise SceneError(
                f"b, T and lower have the shapes {b.shape}, {T.shape} and {lower.shape}; give "
                "shapes that broadcast"
            ) from None
        for wrong, need in (
            (b <= 0, "an upper level b > 0"),
            (lower >= 0, "a lower level < 0"),
            ((T < 0) | np.isinf(T), "a finite horizon T >= 0"),
        ):
            if np.any(wrong):
                raise SceneError(f"Brownian motion from 0 needs {need}; choose such a one")
        self.began = T != 0
        self.T = np.where(T == 0, 1.0, T)
        near, far = np.minimum(b, -lower), np.maximum(b, -lower)
        reach = tuning.BROWNIAN_SERIES.reach * np.sqrt(self.T)
        self.near, self.far = np.minimum(near, reach), np.minimum(far, reach)
        self.width = self.near + self.far

    def tail(self, distance):
        """Probability that |W(T)| exceeds a distance."""
        return _decay(distance * (distance / self.T) / 2, erfcx(distance / np.sqrt(2 * self.T)))

    def rate(self, distance):
        """Density of the first passage of one level."""
        factor = distance / self.T / np.sqrt(2 * np.pi * self.T)
        return _decay(distance * (distance / self.T) / 2, factor)

    def reflected(self, term):
        """Sum a term over the images."""
        return sum(
            (-1) ** k * (term(k * self.width + self.far) - term((k + 1) * self.width + self.near))
            for k in tuning.BROWNIAN_SERIES.images
        )

    def modes(self, weight):
        """Sum over the eigenfunctions; the decay of the first is a factor of the sum."""
        z = np.pi**2 / 2 * (self.T / self.width / self.width)
        place = np.pi * (self.near / self.width)
        terms = (
            weight(n) * np.sin(n * place) * np.exp((1 - n * n) * z)
            for n in tuning.BROWNIAN_SERIES.modes
        )
        return _decay(z, sum(terms))

    def chosen(self, images, modes, at_once):
        """Take the series in which nothing cancels, or the value at T = 0."""
        few_images = self.width**2 >= tuning.BROWNIAN_SERIES.images_from * self.T
        by_images = (self.near**2 >= self.T) | few_images
        return np.where(self.began, np.where(by_images, images, modes), at_once)


def _decay(exponent, factor):
    """Return factor exp(-exponent), also where the exponential alone would underflow."""
    half = np.exp(-exponent / 2)
    return half * (factor * half)


def asymptotic_crossing(
    threshold: float | tuple[float, float], horizons: ArrayLike, gamma2: float, gamma2_error: float
) -> tuple[np.ndarray, np.ndarray]:
    """W_star of a threshold over gamma, and the error it inherits from gamma^2.

    Parameters
    ----------
    threshold : float or (float, float)
        As for `thresholds.bounds`.
    horizons : array_like, shape (k,)
        T, "1".
    gamma2, gamma2_error : float
        gamma^2 and its error.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
    """
    lower, upper = bounds(threshold)
    # W reaches b / gamma before T as likely as b before gamma^2 T
    value, below, above = (
        brownian_crossing(upper, max(gamma2 + shift, 0.0) * np.asarray(horizons), lower)
        for shift in (0.0, -gamma2_error, gamma2_error)
    )
    inherited = np.maximum(np.abs(above - value), np.abs(value - below))
    return value, inherited + tuning.BROWNIAN_SERIES.rounding
