"""Estimates of a probability from the number of paths that have crossed."""

import numpy as np
import scipy
from numpy.typing import ArrayLike

DESCRIPTIONS = {
    "probability": "probability of crossing sqrt(p) b by p T",
    "probability_error": "standard error of the probability",
    "lower": "lower 95 % confidence limit (Jeffreys)",
    "upper": "upper 95 % confidence limit (Jeffreys)",
}


def proportion(
    successes: ArrayLike, trials: ArrayLike, level: float = 0.95
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Estimate a probability with a confidence interval that holds down to rare events.

    The interval is Jeffreys' (Brown, Cai and DasGupta, Statist. Sci. 16, 2001), the quantiles of
    the beta law of the counts plus one half; its limits are 0 and 1 where nothing or everything
    was counted.

    Parameters
    ----------
    successes, trials : array_like of int
    level : float
        Confidence level of the two-sided interval.

    Returns
    -------
    estimate, lower, upper : numpy.ndarray
    """
    successes, trials = np.broadcast_arrays(successes, trials)
    a, b = successes + 0.5, trials - successes + 0.5
    lower = np.where(successes == 0, 0.0, scipy.special.betaincinv(a, b, (1 - level) / 2))
    upper = np.where(successes == trials, 1.0, scipy.special.betainccinv(a, b, (1 - level) / 2))
    return successes / trials, lower, upper


def limits_less_bias(
    crossed: np.ndarray, paths: int, bias: np.ndarray, bias_error: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """95 % limits of a probability that is counted with a bias, which is known with an error.

    The distances of Jeffreys' limits and that of the bias are added as squares (Zou and Donner,
    Statist. Med. 27, 2008), around the fraction less the bias. The interval is widened to contain
    the fraction itself; what this adds to the level is taken from the other limit, so that a large
    bias does not make it too wide.

    Parameters
    ----------
    crossed : numpy.ndarray of int, shape (k,)
    paths : int
    bias, bias_error : numpy.ndarray, shape (k,)
        The expectation of the fraction less the probability, and the standard error of that.

    Returns
    -------
    lower, upper : numpy.ndarray, shape (k,)
    """
    level = 0.95
    fraction, low, high = proportion(crossed, paths, level)
    two_sided = scipy.special.ndtri((1 + level) / 2)
    below, above = (
        np.hypot(own, two_sided * bias_error) for own in (fraction - low, high - fraction)
    )
    # how many standard errors the bias is, at least those of the two-sided interval
    distance = np.maximum(np.where(bias > 0, above, below), np.finfo(float).tiny)
    away = two_sided * np.maximum(np.abs(bias) / distance, 1.0)
    other = scipy.special.ndtri(np.minimum(level + scipy.special.ndtr(-away), (1 + level) / 2))
    other = np.where(away > two_sided, other / two_sided, 1.0)
    centre = fraction - bias
    lower = centre - np.where(bias > 0, other, 1.0) * below
    upper = centre + np.where(bias < 0, other, 1.0) * above
    return (
        np.clip(np.minimum(lower, fraction), 0.0, 1.0),
        np.clip(np.maximum(upper, fraction), 0.0, 1.0),
    )


def crossing_estimate(crossed: np.ndarray, paths: int) -> dict:
    """Turn numbers of crossed paths into `probability`, its standard error and 95 % limits.

    The standard error is that of Jeffreys' beta law, so that it is not 0 where none has crossed.
    """
    probability, lower, upper = proportion(crossed, paths)
    a, b = crossed + 0.5, paths - crossed + 0.5
    return {
        "probability": probability,
        "probability_error": np.sqrt(a * b / (a + b + 1)) / (a + b),
        "lower": lower,
        "upper": upper,
    }
