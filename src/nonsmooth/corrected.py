"""Corrected asymptotic formulas for threshold crossing.

With e = p^(-1/2), a start at the origin and odd g, the survival probability 1 - W is, up to O(e^4),

    f + e^2 (h - S)/D f_T + e^2 B/D^2 T f_TT - e^3 kappa_3/D d_w f_T,

f that of a Brownian motion of variance 2 D T between lower - e kappa and upper + e kappa, and d_w
the derivative for moving both outwards: it decays at the rate D k^2 - e^2 B k^4 in waves of the
wave number k, whose zero is at e (kappa + e^2 kappa_3 k^2) beyond the threshold, and the dipole S,
which the start of time leaves at either threshold, adds S times its flux. A start with u, h, r
instead of 0, h, 0 moves to e u, h becomes h - u^2/2, and e^3 (r - u h + u^3/3) f_xxx is added.
The orders 1, 2 and 3 have errors of the order p^(-1), p^(-3/2), p^(-2).

The corrections are applied to the clock of f: W = 1 - f(T exp X), X their sum over T times the
density of passage, the same up to O(e^4). So W is a probability and grows with T wherever the clock
does. X is to be small: it is multiplied by

    exp(-2 Z - (3 e kappa / (2 b))^4),

Z the sum of the sizes of its terms, b the threshold. This is 1 + O(e^4), and gives back order 1
where pT is not long against the memory of the state, or where the layer at the threshold is as
thick as the interval. At order 2 there is another factor exp(-Y/Z), Y the size of the terms of
order e^3, which mostly oppose those of order e^2, for kappa_3 < 0.

The error is what W changes as the clock moves forth and back by what the next order may change in
X: Z at order 1, Y + Z (Z + K) at order 2, Z (Z + K) at order 3, where K is Z with kappa^2 for h - S
and B/D, and what the factors took off. Constants of order 2 that are not known are taken as
2 kappa^2.
Not in the error are large excursions of a g that grows faster than the theorems allow, of which the
scene warns: they make early crossings likelier than any of this.

Without symmetry of g each threshold has its kappa, and the third cumulant of int g, 6 C t, enters
at the order 1, too: f_s = D f_xx + e C f_xxx, whose solution is that of C = 0 with the times of
passage to a threshold b earlier by e C b / (2 D^2): - C x f_s / (2 D^2) solves the equation, and
the rates of passage, which are solutions, make it vanish at the thresholds from the start.
"""

from dataclasses import replace

import numpy as np

from nonsmooth import milne_plane
from nonsmooth.brownian import (
    brownian_crossing,
    brownian_exit,
    brownian_first_passage_density,
)
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.half_space import Walls, walls
from nonsmooth.milne import expansion
from nonsmooth.overshoot import sampled_length, sampled_poisson
from nonsmooth.spectral import applies
from nonsmooth.streams import labelled
from nonsmooth.variance import limit_variance

_FADING, _LAYER = 2.0, 1.5  # of the factor that limits X
_SAFETY = 1.5  # of the doubt about X; as measured on one-dimensional scenes, 1.2 would do
_LONGEST = 1.5, 2.0  # the doubt is at most the first, and the second times log(1 + 2 e kappa / b)
_UNKNOWN = 2.0  # h - S and B/D over kappa^2, where these are not known
_TINY = 1e-300  # against 0/0
_DEEPEST = 300.0  # no slopes are taken where W or 1 - W is below exp(-300)
_STEP = 1e-4  # relative, of difference quotients; their error is of the order of its square


def corrected_crossing(scene, lower, upper, horizons, p, order, tol=None, seed=0, threads=None):
    """P(int_0^t g leaves (sqrt(p) lower, sqrt(p) upper) before p T), corrected for a finite p.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise; odd g for the orders 2 and 3. For order 1 also two
        variables with finite n and odd g, or any other with odd g.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite, "1".
    horizons : numpy.ndarray, shape (k,)
        T > 0, "1".
    p : float
    order : {1, 2, 3}
    tol : float, optional
        Largest absolute error that is returned; any, unless given.
    seed, threads
        Of the constants that are sampled.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
        The error is a bound of the distance to the probability at the finite p, from the size of
        the next corrections, and what the formula inherits from its constants.

    Raises
    ------
    SceneError
        If the scene has no such formula.
    ToleranceError
        If an error is above `tol`; the message has the value and its error.
    """
    if order not in (1, 2, 3):
        raise SceneError(
            f"the corrected formula has the orders 1, 2 and 3, not {order!r}; choose one"
        )
    constants, errors = _constants(scene, order, seed, threads)
    problem = lower, upper, np.asarray(horizons, dtype=float), p, order
    value, error = _evaluate(constants, *problem)
    error = error + 1e-15
    for name, size in vars(errors).items():
        if size > 0:
            shifted = replace(constants, **{name: getattr(constants, name) + size})
            error += np.abs(_evaluate(shifted, *problem)[0] - value)
    error = np.minimum(error, 1.0)
    worst = int(np.argmax(error))
    if tol is not None and not error[worst] <= tol:
        raise ToleranceError(
            f"the corrected formula of order {order} has W = {value[worst]:.7g} at T = "
            f"{horizons[worst]:g} with an error of {error[worst]:.1e}, above tol = {tol:g}; raise "
            "the order or p, loosen tol, or use method='spectral' or 'monte_carlo'"
        )
    return value, error


def _constants(scene, order, seed, threads):
    """Return the constants of the formula, Expansion or Walls, and their errors."""
    if applies(scene) and scene.is_odd():
        return expansion(scene)
    if order > 1:
        raise SceneError(
            f"the corrected formula of order {order} needs the state (y), white noise and odd g, "
            f"not ({', '.join(scene.state)}) with {scene.noise.title} and g = "
            f"{scene.observable!r}; use order=1 or method='monte_carlo'"
        )
    if applies(scene):
        return walls(scene)
    if milne_plane.applies(scene):
        return tuple(
            Walls(c.diffusion, c.length, c.length, 0.0, c.poisson)
            for c in milne_plane.leading(scene)
        )
    length = sampled_length(scene, seed=labelled(seed, "length"), threads=threads)
    gamma2 = limit_variance(scene, labelled(seed, "variance"), threads)
    start = sampled_poisson(scene, labelled(seed, "start"), threads)
    return (
        Walls(gamma2.value / 2, length.value, length.value, 0.0, start.value),
        Walls(gamma2.error / 2, length.error, length.error, 0.0, start.error),
    )


def _evaluate(constants, lower, upper, horizons, p, order):
    """Return the formula and a bound of its distance to the probability."""
    scale = 1 / np.sqrt(p)
    c = constants
    first = c if isinstance(c, Walls) else Walls(c.diffusion, c.length, c.length, 0.0, c.poisson)
    above = upper + scale * (first.upper - first.poisson)
    below = lower - scale * (first.lower + first.poisson)
    if not below < 0 < above:  # e u(start) is beyond a threshold: nothing is known
        return np.ones(horizons.shape), np.ones(horizons.shape)
    layer = (max(first.lower, first.upper) + abs(first.poisson)) * scale / min(upper, -lower)
    slopes = _slopes(above, below, 2 * first.diffusion, horizons)
    if isinstance(c, Walls):
        clocks = [(np.zeros(horizons.shape), _unknown(c, scale, slopes))]
    else:
        clocks = _clocks(c, scale, slopes, layer)[:order]
    longest = _LONGEST[0] + _LONGEST[1] * np.log1p(2 * layer)

    def crossed(times):
        if first.skewness == 0:
            return brownian_crossing(above, 2 * first.diffusion * times, below)
        shift = scale * first.skewness / first.diffusion  # of the variance, per unit of length
        variance = 2 * first.diffusion * times
        value = np.zeros(times.shape)
        if np.isfinite(upper):
            value += brownian_exit(above, variance + shift * upper, below)
        if np.isfinite(lower):
            value += brownian_exit(-below, variance + shift * lower, -above)
        return np.clip(value, 0.0, 1.0)

    found = []
    for change, doubt in clocks:
        doubt = np.minimum(_SAFETY * doubt + layer**4, longest)
        value, earlier, later = (
            crossed(horizons * np.exp(change + sign * doubt)) for sign in (0, -1, 1)
        )
        distance = np.maximum(np.abs(later - value), np.abs(value - earlier))
        if found:  # no farther than the order before
            distance = np.minimum(distance, found[-1][1] + np.abs(value - found[-1][0]))
        found.append((value, distance))
    return found[-1]


def _slopes(above, below, rate, times):
    """Return T and the logarithmic derivatives of the density of passage, f_T.

    In T, for moving both levels outwards, and for moving the start to the right.
    """
    near, width = min(above, -below), above - below
    times = np.clip(
        times, near**2 / (2 * rate * _DEEPEST), 2 * width**2 / (np.pi**2 * rate) * _DEEPEST
    )

    def log_density(times, outwards=0.0, right=0.0):
        return np.log(
            brownian_first_passage_density(
                above + outwards - right, rate * times, below - outwards - right
            )
        )

    step = _STEP * near
    return (
        times,
        (log_density(times * (1 + _STEP)) - log_density(times * (1 - _STEP))) / (2 * _STEP * times),
        (log_density(times, outwards=step) - log_density(times, outwards=-step)) / (2 * step),
        (log_density(times, right=step) - log_density(times, right=-step)) / (2 * step),
    )


def _clocks(constants, scale, slopes, layer):
    """Return X and the doubt about it for every order."""
    c, (times, late, outwards, right) = constants, slopes
    delay = scale**2 * (c.start - c.poisson**2 / 2 - c.corner) / (c.diffusion * times)
    spread = scale**2 * c.dispersion / c.diffusion**2 * late
    jump = c.third - c.poisson * c.start + c.poisson**3 / 3
    unit = scale**3 / (c.diffusion * times)
    wall, start = -unit * c.stretch * outwards, unit * jump * right
    size, next_size = np.abs(delay) + np.abs(spread), np.abs(wall) + np.abs(start)
    factor = np.exp(-_FADING * (size + next_size) - (_LAYER * layer) ** 4)
    second, third = delay + spread, delay + spread + wall + start
    at_two = factor * np.exp(-next_size / (size + _TINY)) * second
    own = scale**2 * c.length**2 / c.diffusion * (1 / times + np.abs(late))
    fourth = (own + size + next_size) * (size + next_size)
    return [
        (np.zeros(times.shape), size + next_size),
        (at_two, next_size + np.abs(second - at_two) + fourth),
        (factor * third, np.abs(third - factor * third) + fourth),
    ]


def _unknown(constants, scale, slopes):
    """Size of the terms of the next order, from the lengths that are known."""
    c, (times, late, _, _) = constants, slopes
    square = (
        _UNKNOWN / 2 * (c.lower**2 + c.upper**2) + c.poisson**2 + (c.skewness / c.diffusion) ** 2
    )
    return scale**2 * square / c.diffusion * (1 / times + np.abs(late))
