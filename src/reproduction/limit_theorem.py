"""The functional central limit theorem, Theorem 6 of the paper, on samples.

Xi_p(t) = p^(-1/2) int_0^(p t) g tends to gamma W on [0, 1] as p grows. Hence Xi_p(1)/gamma tends to
a standard normal variable and max_{t <= 1} |Xi_p(t)|/gamma to the maximum of |W|, whose
distribution function is 1 - W_star, eq. (34) of the paper. The distances between the laws of
samples and these limits are measured here.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtr, ndtri

from nonsmooth.crossing.brownian import brownian_survival
from nonsmooth.paths.ensembles import over_blocks
from nonsmooth.paths.kernels.panel import PEAK, TOTAL_DELTA
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.scenes.scene import Scene


def scaled_integrals(
    scene: Scene, p: ArrayLike, steps: Sequence[float], sampling: Sampling
) -> np.ndarray:
    """Simulate Xi_p(1) and max_{t <= 1} |Xi_p(t)|, every p on the same paths.

    Parameters
    ----------
    scene : Scene
    p : array_like, shape (k,)
        Increasing scales, "1".
    steps : sequence of float
        Longest step up to each p from the one before. The maximum is that over the steps.
    sampling : Sampling
        Its step is not used.

    Returns
    -------
    numpy.ndarray, shape (2, k, paths)

    Raises
    ------
    SceneError
        If a path diverges.
    """
    p = np.asarray(p, dtype=float)

    def reduce(panel, count):
        return np.stack([panel.total[TOTAL_DELTA, :count], panel.data[PEAK, :count]])

    grid = [equal_steps(p, step)[k] for k, step in enumerate(steps)]
    kept = over_blocks(scene, grid, sampling, reduce, control=False)
    return np.swapaxes(np.concatenate(list(kept), axis=2), 0, 1) / np.sqrt(p)[:, None]


def normal_law(value: ArrayLike) -> np.ndarray:
    """Distribution function of W(1)."""
    return ndtr(value)


def maximum_law(value: ArrayLike) -> np.ndarray:
    """Distribution function of max_{t <= 1} |W(t)| at positive values, 1 - W_star."""
    return brownian_survival(value, 1.0)


def kolmogorov_distance(sample: ArrayLike, law: Callable) -> float:
    """Largest distance between the distribution function of a sample and a continuous law.

    Parameters
    ----------
    sample : array_like, shape (k,)
    law : callable
        Distribution function.

    Returns
    -------
    float
    """
    below = law(np.sort(sample))
    rank = np.arange(len(below) + 1) / len(below)
    return float(max(np.max(rank[1:] - below), np.max(below - rank[:-1])))


def sampling_bound(count: int, probability: float) -> float:
    """Bound a sample's Kolmogorov distance to its own law, but for a given probability.

    This is the bound of Dvoretzky, Kiefer and Wolfowitz with Massart's constant (Ann. Probab. 18,
    1990). It holds for every law and every count. By the triangle inequality it also bounds the
    difference between the distances of the sample and of its law to a third law.

    Parameters
    ----------
    count : int
        Size of the sample.
    probability : float
        With which the bound may be exceeded.

    Returns
    -------
    float
    """
    return float(np.sqrt(np.log(2 / probability) / (2 * count)))


def distance_to_limit(
    sample: np.ndarray, law: Callable, gamma2: float, gamma2_error: float
) -> tuple[float, float]:
    """Kolmogorov distance of a sample, divided by gamma, to its limit.

    Parameters
    ----------
    sample : array_like, shape (k,)
        Of Xi_p(1) or of its running maximum.
    law : callable
        `normal_law` or `maximum_law`.
    gamma2, gamma2_error : float
        The asymptotic variance and its standard error or error bound.

    Returns
    -------
    distance, sensitivity : float
        The sensitivity is the change of the distance by the error of gamma^2.
    """
    distance, less, more = (
        kolmogorov_distance(sample / np.sqrt(gamma2 + shift), law)
        for shift in (0.0, -gamma2_error, gamma2_error)
    )
    return distance, max(abs(less - distance), abs(more - distance))


def error_bound(count: int, sensitivity: ArrayLike, probability: float) -> np.ndarray:
    """Bound on the error of `distance_to_limit`, of the sample and of gamma^2 together.

    Parameters
    ----------
    count : int
    sensitivity : array_like
    probability : float
        With which the bound may be exceeded, by the sample and by gamma^2 in equal parts.

    Returns
    -------
    numpy.ndarray
    """
    return sampling_bound(count, probability / 2) - ndtri(probability / 4) * np.asarray(sensitivity)


def allowed_distance(p: ArrayLike, distance: ArrayLike, error: ArrayLike) -> np.ndarray:
    """Extrapolate an upper bound of the distance at the largest p from the smaller ones.

    A distance of order p^(-1/2) is p^(-1/2) (c + c'/p^(1/2) + ...). Let c(p) be p^(1/2) times the
    distance. For c at the largest p the bound takes the larger of two values: the largest c(p) at
    the smaller p, and the extrapolation of the last two of these by a straight line in p^(-1/2).
    The bound holds if the errors hold and c(p) falls, rises ever more slowly, or follows the two
    terms above.

    Parameters
    ----------
    p : array_like, shape (k,)
        Increasing, at least three.
    distance, error : array_like, shape (..., k)
        Measured distances and bounds on their errors.

    Returns
    -------
    numpy.ndarray, shape (...)
        The bound of the measured distance at the largest p.
    """
    p, distance, error = (np.asarray(value, dtype=float) for value in (p, distance, error))
    root = np.sqrt(p)
    upper, lower = ((distance + sign * error) * root for sign in (1, -1))
    slope = (1 / root[-2] - 1 / root[-1]) / (1 / root[-3] - 1 / root[-2])
    line = upper[..., -2] + slope * (upper[..., -2] - lower[..., -3])
    constant = np.maximum(upper[..., :-1].max(axis=-1), line)
    return error[..., -1] + constant / root[-1]
