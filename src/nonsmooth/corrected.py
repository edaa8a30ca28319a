"""Corrected asymptotic formulas for threshold crossing.

With e = p^(-1/2) and odd g: towards a threshold b, int g behaves like a Brownian motion of
variance 2 D t towards b + e kappa (order 1, error O(1/p)). Order 2 adds, for equal thresholds, that
waves cos(k x) decay at the rate D k^2 - e^2 B k^4 and that the start weakens them by
1 + e^2 k^2 (S - h): error O(p^(-3/2)).

Without symmetry of g each threshold has its kappa, and the third cumulant of int g, 6 C t, enters
at the order 1, too: f_s = D f_xx + e C f_xxx, whose solution is that of C = 0 with the times of
passage to a threshold b earlier by e C b / (2 D^2): - C x f_s / (2 D^2) solves the equation, and
the rates of passage, which are solutions, make it vanish at the thresholds from the start.
"""

from dataclasses import replace

import numpy as np

from nonsmooth import milne_plane
from nonsmooth.brownian import brownian_crossing, brownian_exit
from nonsmooth.errors import SceneError
from nonsmooth.half_space import Walls, walls
from nonsmooth.milne import expansion
from nonsmooth.overshoot import sampled_length
from nonsmooth.spectral import applies
from nonsmooth.streams import labelled
from nonsmooth.variance import limit_variance

_TERMS = np.arange(4000)


def corrected_crossing(scene, lower, upper, horizons, p, order, seed=0, threads=None):
    """P(int_0^t g leaves (sqrt(p) lower, sqrt(p) upper) before p T), corrected for a finite p.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise; odd g for order 2. For order 1 also two variables with
        finite n and odd g, or any other with odd g and the start at the origin.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite, "1".
    horizons : numpy.ndarray, shape (k,)
        T > 0, "1".
    p : float
    order : {1, 2}
        2 needs lower = -upper.
    seed, threads
        Of the constants that are sampled.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
        The error is that inherited from the constants; the distance of the formula to the
        probability, of the order 1/p or p^(-3/2), comes on top and is not known.

    Raises
    ------
    SceneError
        If the scene, or the order for these thresholds, has no such formula.
    """
    if order not in (1, 2):
        raise SceneError(f"the corrected formula has the orders 1 and 2, not {order!r}; choose one")
    if order == 2 and lower != -upper:
        raise SceneError(
            "the corrected formula of order 2 needs the same threshold on both sides; use order=1"
        )
    if order == 1 and milne_plane.applies(scene):
        (constants, errors), formula = milne_plane.leading(scene), _first
    elif not applies(scene):
        (constants, errors), formula = _sampled(scene, order, seed, threads), _skewed
    elif scene.is_odd():
        (constants, errors), formula = expansion(scene), _first if order == 1 else _second
    elif order == 1:
        (constants, errors), formula = walls(scene), _skewed
    else:
        raise SceneError(
            f"the corrected formula of order 2 needs odd g, not g = {scene.observable!r}; "
            "use order=1"
        )
    value = formula(constants, lower, upper, horizons, p)
    error = np.full(np.shape(value), 1e-15)
    names = [name for name, size in vars(errors).items() if size > 0]
    for name in names:
        shifted = replace(constants, **{name: getattr(constants, name) + getattr(errors, name)})
        error += np.abs(formula(shifted, lower, upper, horizons, p) - value)
    return value, error


def _sampled(scene, order, seed, threads):
    if order == 2 or any(scene.start.values()):
        raise SceneError(
            f"for the state ({', '.join(scene.state)}) with {scene.noise.title} the corrected "
            "formula has order 1, from the origin; use order=1 and that start, or "
            "method='monte_carlo'"
        )
    length = sampled_length(scene, seed=labelled(seed, "length"), threads=threads)
    gamma2 = limit_variance(scene, labelled(seed, "variance"), threads)
    return (
        Walls(gamma2.value / 2, length.value, length.value, 0.0, 0.0),
        Walls(gamma2.error / 2, length.error, length.error, 0.0, 0.0),
    )


def _skewed(constants, lower, upper, horizons, p):
    scale = 1 / np.sqrt(p)
    variance = 2 * constants.diffusion
    above = upper + scale * (constants.upper - constants.poisson)
    below = lower - scale * (constants.lower + constants.poisson)
    shift = scale * constants.skewness / constants.diffusion  # of the variance, per unit of length
    value = np.zeros(np.shape(horizons))
    if np.isfinite(upper):
        value += brownian_exit(above, variance * horizons + shift * upper, below)
    if np.isfinite(lower):
        value += brownian_exit(-below, variance * horizons + shift * lower, -above)
    return np.clip(value, 0.0, 1.0)


def _first(constants, lower, upper, horizons, p):
    scale = 1 / np.sqrt(p)
    # the Brownian motion starts at e u(start)
    above = upper + scale * (constants.length - constants.poisson)
    below = lower - scale * (constants.length + constants.poisson)
    return brownian_crossing(above, 2 * constants.diffusion * horizons, below)


def _second(constants, lower, upper, horizons, p):
    """Sum the series, resummed so that it is the survival of a subordinated Brownian motion.

    The rate D k^2 / (1 + e^2 (B/D) k^2) is a Bernstein function of k^2, and the amplitude is a
    shift of time: a probability, and monotone in T, if B >= 0; otherwise the rate is not resummed.
    """
    diffusion = constants.diffusion
    k2 = ((2 * _TERMS + 1) * np.pi / 2 / (upper + constants.length / np.sqrt(p))) ** 2
    weights = 4 / np.pi * (-1.0) ** _TERMS / (2 * _TERMS + 1)
    slowed = constants.dispersion / diffusion / p
    delay = (constants.corner - constants.start) / diffusion / p
    time = np.maximum(np.atleast_1d(horizons) - delay, 0.0)[:, None]
    if slowed > 0:
        rate = diffusion * k2 / (1 + slowed * k2)
        # at high wave numbers, an atom: that time has not begun to run
        atom = np.exp(-diffusion / slowed * time)
        survival = atom[:, 0] + (np.exp(-rate * time) - atom) @ weights
    else:
        survival = np.exp(-(diffusion * k2 - diffusion * slowed * k2**2) * time) @ weights
    return np.where(time[:, 0] > 0, np.clip(1 - survival, 0.0, 1.0), 0.0)
