"""Corrected asymptotic formulas for threshold crossing, with a bound of their error.

The order k has an error of the order p^(-(k+1)/2), see `resummed` for the formulas. Order 1 moves
the thresholds outwards by the extrapolation length; order 2 takes the state y with white noise, and
order 3 odd g, too. Without symmetry of g each threshold has its own constants, and the third
cumulant of int g counts at the order 1.

The error of an order is its distance to the last one that is known, k, and what that one changes as
the time is multiplied or divided by exp(R),

    R = a x^((k+1)/2) / (1 + c x^((k-1)/2)),  x = s^2 z / D,

what the next order may do to the clock: with s^2 = |S| + |h - u^2/2| + |B|/D + (C/D)^2 order 2
changes it by about x, z being the frequency that matters at T, 1/T and the logarithmic derivative
of the rate of passage. s = m of `resummed` where order 2 is not known. The start sees the layer's
end, of the relative size (m/b) exp(-b/m), which is added. Where the layer is so thick
that order 1 is left, R grows with m over the threshold b instead. It is at most the time that the
layer can explain.
Not in the error are large excursions of a g that grows faster than the theorems allow, of which the
scene warns: they make early crossings likelier than any of this.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from nonsmooth.boundary_layer import two_variables
from nonsmooth.boundary_layer.asymmetric_line import walls
from nonsmooth.boundary_layer.sampled import sampled_length, sampled_poisson
from nonsmooth.boundary_layer.symmetric_line import expansion
from nonsmooth.crossing.expansion import Constants, Formula
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.statistics.asymptotic_variance import limit_variance

# a and c for every k, as measured on a hundred one-dimensional scenes and intervals, with a margin
_DOUBT = {1: (1.0, 0.0), 2: (0.3, 2.0), 3: (0.6, 2.0)}
_THICK = 1.3  # R over (m / b) y / (1 + y), y = m^2 z / D, where order 1 is left, as measured
_LONGEST = 1.5, 2.0  # R is at most the first, and the second times log(1 + 2 m / b)
_LEADING = ("diffusion", "lower", "upper", "poisson", "skewness")


def corrected_crossing(scene, lower, upper, horizons, p, order, tol=None, seed=0, threads=None):
    """P(int_0^t g leaves (sqrt(p) lower, sqrt(p) upper) before p T), corrected for a finite p.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise; odd g for the order 3. For order 1 also two
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
        The error is a bound of the distance to the probability at the finite p, from the next
        orders, and what the formula inherits from its constants.

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
    known = _highest_order(scene)
    if order > known:
        need = "the state (y) and white noise" if known == 1 else "odd g"
        raise SceneError(
            f"the corrected formula of order {order} needs {need}, not ({', '.join(scene.state)}) "
            f"with {scene.noise.title} and g = {scene.observable!r}; use order={known} or "
            "method='monte_carlo'"
        )
    constants, errors = _constants(scene, seed, threads)
    times = p * np.asarray(horizons, dtype=float)
    formula = Formula(constants, known, np.sqrt(p) * lower, np.sqrt(p) * upper)
    if not formula.below < 0 < formula.above:  # e u(start) is beyond a threshold: nothing is known
        value, error = np.ones(times.shape), np.ones(times.shape)
    else:
        found = formula.orders(times)
        value = found[order - 1]
        error = np.abs(found[-1] - value) + _doubt(formula, errors, times, found[-1])
    worst = int(np.argmax(error))
    if tol is not None and not error[worst] <= tol:
        raise ToleranceError(
            f"the corrected formula of order {order} has W = {value[worst]:.7g} at T = "
            f"{horizons[worst]:g} with an error of {error[worst]:.1e}, above tol = {tol:g}; raise "
            "the order or p, loosen tol, or use method='deterministic' or 'monte_carlo'"
        )
    return value, error


def _highest_order(scene):
    if not scene.is_line:
        return 1
    return 3 if scene.is_odd() else 2


@lru_cache(maxsize=16)  # the same for every p and interval
def _constants(scene, seed, threads):
    """Return the constants of the formula, and their errors."""
    if scene.is_line and scene.is_odd():
        return tuple(
            Constants(
                diffusion=c.diffusion,
                lower=c.length,
                upper=c.length,
                poisson=c.poisson,
                dispersion=c.dispersion,
                lower_corner=c.corner,
                upper_corner=c.corner,
                start=c.start,
                stretch=c.stretch,
                third=c.third,
            )
            for c in expansion(scene)
        )
    if scene.is_line:
        return tuple(Constants(**vars(c)) for c in walls(scene))
    if two_variables.applies(scene):
        return tuple(
            Constants(c.diffusion, c.length, c.length, c.poisson)
            for c in two_variables.leading(scene)
        )
    length = sampled_length(scene, seed=labelled(seed, "length"), threads=threads)
    gamma2 = limit_variance(scene, labelled(seed, "variance"), threads)
    start = sampled_poisson(scene, labelled(seed, "start"), threads)
    return (
        Constants(gamma2.value / 2, length.value, length.value, start.value),
        Constants(gamma2.error / 2, length.error, length.error, start.error),
    )


def _doubt(formula, errors, times, last):
    """Bound the distance of the last order to the probability."""
    c, thickness = formula.constants, formula.thickness
    frequency = formula.frequency(times)
    x, thick = (size**2 * frequency / c.diffusion for size in (formula.second, formula.length))
    rising, falling = _DOUBT[formula.known]
    next_order = rising * x ** ((formula.known + 1) / 2)
    next_order /= 1 + falling * x ** ((formula.known - 1) / 2)
    # what the start still sees of the layer, which decays like exp(-1/thickness)
    next_order += thickness * np.exp(-1 / thickness)
    # where the layer is thick, order 1 is left
    change = formula.share * next_order + (1 - formula.share) * _THICK * thickness * thick / (
        1 + thick
    )
    # what the constants of the orders 2 and 3 may do to the clock
    corner = max(errors.lower_corner, errors.upper_corner)
    change += (errors.start + corner) / (c.diffusion * times)
    change += errors.dispersion * frequency / c.diffusion**2
    change += (errors.stretch + errors.third) * np.sqrt(frequency / c.diffusion) / times
    change = np.minimum(change, _LONGEST[0] + _LONGEST[1] * np.log1p(2 * thickness))
    error = np.full(times.shape, 1e-15)
    error += np.max([np.abs(formula.last(times * np.exp(s * change)) - last) for s in (-1, 1)], 0)
    plain = formula.first(times)
    for name in _LEADING:
        if getattr(errors, name) > 0:
            moved = replace(c, **{name: getattr(c, name) + getattr(errors, name)})
            error += np.abs(replace(formula, constants=moved).first(times) - plain)
    return np.minimum(error, 1.0)
