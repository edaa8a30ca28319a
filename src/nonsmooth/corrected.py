"""Corrected asymptotic formulas for threshold crossing.

With e = p^(-1/2): towards a threshold b, int g behaves like a Brownian motion of variance 2 D t
towards b + e kappa (order 1, error O(1/p)). Order 2 adds, for equal thresholds, that waves
cos(k x) decay at the rate D k^2 - e^2 B k^4 and that the start weakens them by
1 + e^2 k^2 (S - h): error O(p^(-3/2)).
"""

from dataclasses import replace

import numpy as np

from nonsmooth.brownian import brownian_crossing
from nonsmooth.errors import SceneError
from nonsmooth.milne import expansion, leading

_TERMS = np.arange(4000)


def corrected_crossing(scene, lower, upper, horizons, p, order):
    """P(int_0^t g leaves (sqrt(p) lower, sqrt(p) upper) before p T), corrected for a finite p.

    Parameters
    ----------
    scene : Scene
        With odd g and drift; one state variable and white noise or, for order 1, two and finite n.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite, "1".
    horizons : numpy.ndarray, shape (k,)
        T > 0, "1".
    p : float
    order : {1, 2}
        2 needs lower = -upper.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
        The error inherited from the constants.

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
    constants, errors = leading(scene) if order == 1 else expansion(scene)
    formula = _first if order == 1 else _second
    value = formula(constants, lower, upper, horizons, p)
    error = np.full(np.shape(value), 1e-15)
    names = [name for name, size in vars(errors).items() if size > 0]
    for name in names:
        shifted = replace(constants, **{name: getattr(constants, name) + getattr(errors, name)})
        error += np.abs(formula(shifted, lower, upper, horizons, p) - value)
    return value, error


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
