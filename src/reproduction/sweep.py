"""The bias of the time step in crossing probabilities at large p, where halving costs too much."""

import numpy as np

from nonsmooth.crossing.counting import bias_of_counts
from nonsmooth.paths.ensembles import coupled
from nonsmooth.paths.moments import step_bias, variance_of_fine
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.thresholds import bounds


def crossing_bias(
    scene: Scene,
    threshold: float,
    horizons: np.ndarray,
    p: float,
    probability: np.ndarray,
    measured: float,
    sampling: Sampling,
) -> tuple[np.ndarray, np.ndarray]:
    """Bias of W(sqrt(p) b, p T) by the time step, and its standard error.

    Up to p = `measured` it is what halving the step changes. Beyond, W is W_star(b / gamma, T), in
    which a relative bias of gamma^2 is one of T, and a correction that falls like p^(-1/2). The
    bias of gamma^2 is measured by halving up to the time p T at p = `measured`, between the last
    horizon and that nearest to half of it. What it does not explain of the bias of W there, divided
    by the square root of p over `measured`, is part of the error.

    Parameters
    ----------
    scene : Scene
    threshold : float
        b, "1".
    horizons : numpy.ndarray, shape (k,)
        Increasing T, "1".
    p : float
    probability : numpy.ndarray, shape (k,)
        W at this p.
    measured : float
    sampling : Sampling
        With the step whose bias is asked for, and the paths on which it is halved.

    Returns
    -------
    bias, error : numpy.ndarray, shape (k,)
    """
    nearest = min(p, measured)
    times = nearest * horizons
    change, passage = coupled(
        scene, times, sampling, tuple(np.sqrt(nearest) * np.array(bounds(threshold)))
    )
    order = registry.scheme(scene, "strang").weak_order(scene)
    bias, error = bias_of_counts(times, passage, order)
    if p <= measured:
        return bias, error
    relative, relative_error = _bias_of_gamma2(times, change, order)
    crossed = np.mean(passage[0][:, None] <= times, axis=0)
    rest = np.abs(bias - relative * _slope(horizons, crossed)) + error
    slope = _slope(horizons, probability)
    return relative * slope, np.hypot(relative_error * slope, np.max(rest) * np.sqrt(measured / p))


def _bias_of_gamma2(times, change, order):
    """Relative bias of the slope of Var D over the second half, and its standard error.

    The error is computed as if the variances at both times were independent, which makes it larger
    than the slope's own.
    """
    bias, error = step_bias(change, order)
    half = int(np.argmin(np.abs(times - times[-1] / 2)))
    v = variance_of_fine(change)
    growth = v[-1] - v[half]
    return (bias[-1] - bias[half]) / growth, np.hypot(error[-1], error[half]) / growth


def _slope(horizons, probability):
    """Return dW / dlog T."""
    return horizons * np.gradient(probability, horizons)
