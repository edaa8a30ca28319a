"""Mean and variance of int g from sums over paths, and the bias of the time step."""

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import SceneError
from nonsmooth.paths import tuning


def moments(gram: ArrayLike) -> dict[str, np.ndarray]:
    """Mean and variance of D = int_0^t g and their standard errors.

    Where the paths carry control variates, regression on them reduces the errors.

    Parameters
    ----------
    gram : array_like, shape (t, 5, 5)
        From `ensembles.gram`; the sum over the parts, if the ensemble was simulated in parts.

    Returns
    -------
    dict
        Arrays over time: `mean`, `mean_error`, `variance`, `variance_error` (standard errors). At
        early times it may be that D is the same on all paths, to rounding, so that the sample shows
        no spread. The errors are then those of a sample in which D is another on one path, by as
        much as its size at the first output time at which there is a spread.

    Raises
    ------
    SceneError
        If the spread is lost in rounding of the mean, or D = 0 on all paths at the last time.
    """
    gram = np.asarray(gram)
    paths = gram[:, 0, 0]
    if not gram[-1, 2, 2] > 0:
        raise SceneError(
            "int g is 0 on all paths at all times, so that nothing is known of its spread; choose "
            "a longer time or another observable"
        )
    average = gram[:, 0] / paths[:, None]
    covariance = gram / paths[:, None, None] - average[:, :, None] * average[:, None, :]
    spread, squares = (np.diagonal(part, axis1=1, axis2=2)[:, 1:3] for part in (covariance, gram))
    rounding = tuning.MONTE_CARLO.resolved * squares / paths[:, None]
    lost = np.any(spread <= rounding, axis=1)
    first = int(np.argmin(lost))
    if np.any(paths < 2) or np.any(lost[first:]):
        raise SceneError(
            "the spread of int g is lost in its mean, or there is one path only; "
            "subtract the mean from g or take more paths"
        )
    # To first order in the fluctuations the sample variance is the mean of D^2 - 2 E[D] D.
    of_mean = np.tile([0.0, 1.0, 0.0, 0.0, 0.0], (len(gram), 1))
    of_variance = np.stack([0 * paths, -2 * average[:, 1], 1 + 0 * paths, 0 * paths, 0 * paths], 1)
    inverse = np.linalg.pinv(covariance[:, 3:, 3:], hermitian=True)
    result = {}
    for name, value, weights in (
        ("mean", average[:, 1], of_mean),
        ("variance", spread[:, 0] * paths / (paths - 1), of_variance),
    ):
        slope = np.einsum("tij,tjk,tk->ti", inverse, covariance[:, 3:], weights)
        weights[:, 3:] -= slope
        error = np.einsum("ti,tij,tj->t", weights, covariance, weights)
        result[name] = value - np.sum(slope * average[:, 3:], axis=1)
        result[f"{name}_error"] = np.sqrt(np.maximum(error, 0.0) / paths)
    # what the control variates take off may be more than there is
    result["variance"] = np.maximum(result["variance"], 0.0)
    square = gram[first, 2, 2] / gram[first, 1, 1]  # the size of D^2: E D^4 / E D^2
    result["mean_error"][:first] = np.sqrt(square) / paths[:first]
    result["variance_error"][:first] = square / paths[:first]
    return result


def bias_over_change(order: float) -> float:
    """Return the bias of a step over what halving it changes, for the weak order q = `order`."""
    return 1 / (1 - 2**-order)


def fine_bias_over_change(order: float) -> float:
    """Return the bias of half the step over what halving it changes."""
    return 1 / (2**order - 1)


def step_bias(change: np.ndarray, order: float) -> tuple[np.ndarray, np.ndarray]:
    """Bias of the variance of D due to the time step, and its standard error.

    Parameters
    ----------
    change : numpy.ndarray, shape (t, 4, 4)
        From `ensembles.coupled`.
    order : float
        Weak order q of the scheme: the bias is what halving the step changes over 1 - 2^-q.

    Returns
    -------
    bias, error : numpy.ndarray, shape (t,)
    """
    count = change[:, :1, 0]
    average = change[:, 0] / count
    covariance = change / count[..., None] - average[:, :, None] * average[:, None, :]
    shift, square, mean = average[:, 1:].T
    # Var D_h - Var D_h/2, and its derivatives with respect to the averages
    value = square - shift * (2 * mean + shift)
    weights = np.stack([0 * mean, -2 * (mean + shift), 0 * mean + 1, -2 * shift], axis=1)
    factor = bias_over_change(order)
    variance = np.einsum("ti,tij,tj->t", weights, covariance, weights)
    return factor * value, factor * np.sqrt(np.maximum(variance, 0.0) / count[:, 0])


def mean_bias(change: np.ndarray, order: float) -> tuple[np.ndarray, np.ndarray]:
    """Bias of the mean of D due to the time step, and its standard error; see `step_bias`."""
    count = change[:, 0, 0]
    shift = change[:, 0, 1] / count
    spread = np.sqrt(np.maximum(change[:, 1, 1] / count - shift**2, 0.0) / count)
    factor = bias_over_change(order)
    return factor * shift, factor * spread


def variance_of_fine(change: np.ndarray) -> np.ndarray:
    """Variance of D with the half step, shape (t,); `change` is from `ensembles.coupled`."""
    count = change[:, 0, 0]
    return change[:, 3, 3] / count - (change[:, 0, 3] / count) ** 2
