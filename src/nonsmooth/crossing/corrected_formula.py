"""Corrected asymptotic formulas for threshold crossing, with a bound of their error.

The order k has an error of the order p^(-(k+1)/2); `expansion` has the formulas. Order 1 is for odd
g, or for the state y with white noise. Orders 2 and 3 are for the latter, and for two variables
with odd g and drift and a finite n.

Let k now be the highest order that is known for the scene. The stated error of an order is its
distance to the order k, plus the change of the order k when the time is multiplied or divided by
exp(R). R estimates the effect of the next order, k + 1, as a relative change of the time:

    R = a x^((k+1)/2) / (1 + c x^((k-1)/2)),  x = s^2 z / D.

Here s^2 = |S| + |h - u^2/2| + |B|/D + (C/D)^2 is the size of the terms of order 2. The frequency z
is the inverse of the time, plus the size of the logarithmic derivative of the rate of passage.
Where S is not known, the square of m stands for it, m being the thickness of the layer; where none
of these terms is known, s is m. With b the distance to the nearer threshold, (m/b) exp(-b/m) is
added to R for the layer's effect at the start. Where the layer is so thick that order 1 replaces
the others, R grows with m/b instead. R never exceeds a limit that grows with log(1 + 2 m/b). The
numbers a and c are fitted, see `tuning`.

With a drift, order 1 has the error W (exp(X) - 1) besides, see `drift`.

Large excursions of a g that grows faster than the theorems allow make early crossings likelier than
the formula says. For such a g, of which the scene warns, nothing is known but that a probability is
between 0 and 1, and the error says so.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from nonsmooth.boundary_layer import two_variables
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.boundary_layer.milne import highest_order, layer_constants
from nonsmooth.crossing import tuning
from nonsmooth.crossing.expansion import Expansion
from nonsmooth.errors import SceneError, ToleranceError, of_another_quantity, quoted
from nonsmooth.scenes.scene import Scene, uncentred


def corrected_crossing(
    scene: Scene,
    threshold: tuple[float, float],
    horizons: np.ndarray,
    p: float,
    order: int,
    tol: float | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
    accuracy: float | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """P(int_0^t g leaves (sqrt(p) lower, sqrt(p) upper) before p T), corrected for a finite p.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise; or with two variables, finite n, odd g and drift. For the
        order 1 any scene with odd g.
    threshold : (float, float)
        lower < 0 < upper, one of them possibly infinite, "1".
    horizons : numpy.ndarray, shape (k,)
        T > 0, "1".
    p : float
    order : {1, 2, 3}
    tol : float, optional
        Largest absolute error that is accepted. Unless given, the error may be anything.
    seed, threads
        For constants that are sampled.
    accuracy : float, optional
        Absolute error wanted of kappa, as for `extrapolation_length`.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
        The error bounds the distance to the probability at the finite p: it estimates the next
        orders, and has what the formula inherits from the errors of its constants.

    Raises
    ------
    SceneError
        If the scene has no such formula, or E g != 0 and the order is not 1.
    ToleranceError
        If an error is above `tol`; with the values and errors as its `result`.
    """
    _require_order(scene, order)
    if accuracy is None and order == 1 and tol is not None and two_variables.applies(scene):
        accuracy = _accuracy_of_kappa(tol, threshold, p)
    with of_another_quantity():
        constants, errors = layer_constants(scene, seed, threads, accuracy, order > 1)
    if order > 1 and constants.mean != 0:
        what = f"the corrected formula of order {order}"
        raise uncentred(what, scene, constants.mean, "use order=1")
    times = p * np.asarray(horizons, dtype=float)
    formula = Expansion(constants, *(np.sqrt(p) * level for level in threshold))
    if formula.says_something:
        found = formula.orders(times)
        value = found[order - 1]
        error = np.abs(found[-1] - value) + _error_of_last(formula, errors, times, found[-1])
    else:
        value, error = np.ones(times.shape), np.ones(times.shape)
    if scene.grows_too_fast:  # single excursions may cross at any time
        error = np.maximum(error, np.maximum(value, 1 - value))
    worst = int(np.argmax(error))
    if tol is not None and not error[worst] <= tol:
        raise ToleranceError(
            f"the corrected formula of order {order} has W = {value[worst]:.7g} at T = "
            f"{horizons[worst]:g} with an error of {error[worst]:.1e}, above tol = {tol:g}; raise "
            "the order or p, loosen tol, or use method='deterministic' or 'monte_carlo'",
            (value, error),
        )
    return value, error


def _require_order(scene, order):
    """Refuse an order that does not exist for this scene."""
    if order > highest_order(scene):
        raise SceneError(
            f"the corrected formula of order {order} needs one variable, or two with odd g and "
            f"drift and finite n, not ({', '.join(scene.state)}) with {scene.noise.title} and g = "
            f"{quoted(scene.observable)}; use order=1 or method='monte_carlo'"
        )


def _accuracy_of_kappa(tol, threshold, p):
    """Return a loose error of kappa if a tolerance allows for it, else None, for the usual one.

    An error d of kappa moves a threshold from b to b + d / sqrt(p), which changes W by at most
    d / (b sqrt(p)).
    """
    settings = tuning.CORRECTED_ERROR
    allowed = settings.share_of_kappa * tol * np.sqrt(p) * np.min(np.abs(threshold))
    return settings.loose_kappa if allowed >= settings.loose_kappa else None


def _error_of_last(
    formula: Expansion, errors: LayerConstants, times: np.ndarray, last: np.ndarray
) -> np.ndarray:
    """Bound the distance of the last order to the probability."""
    change = _next_order(formula, times)
    for inherited in _inherited(formula, errors, times):
        change += inherited
    least, more = tuning.CORRECTED_ERROR.longest
    change = np.minimum(change, least + more * np.log1p(2 * formula.knudsen))
    error = np.full(times.shape, tuning.CORRECTED_ERROR.rounding)
    error += np.max([np.abs(formula.last(times * np.exp(s * change)) - last) for s in (-1, 1)], 0)
    error += _next_order_of_drift(formula, times, last)
    # skewness makes passages earlier, some so much that they come at once: an error, later as well
    settings = tuning.CORRECTED_ERROR
    error += settings.lasting * formula.last(settings.at_once * times[:1])
    plain = formula.first(times)
    for moved in _moved_by_errors(formula.constants, errors):
        error += np.abs(replace(formula, constants=moved).first(times) - plain)
    return np.minimum(error, 1.0)


def _next_order(formula, times):
    """Return R: the next order is taken to multiply or divide the time by exp(R) at most."""
    c, knudsen = formula.constants, formula.knudsen
    frequency = formula.frequency(times)
    x, thick = (
        size**2 * frequency / c.diffusion
        for size in (formula.second_order_scale, formula.layer_thickness)
    )
    rising, falling = tuning.CORRECTED_ERROR.next_order[c.order - 1]
    next_order = rising * x ** ((c.order + 1) / 2)
    next_order /= 1 + falling * x ** ((c.order - 1) / 2)
    # the layer's effect at the start, which decays like exp(-1 / knudsen)
    next_order += knudsen * np.exp(-1 / knudsen)
    # where the layer is thick, order 1 replaces the others
    first_order = (1 - formula.weight) * tuning.CORRECTED_ERROR.thick * knudsen * thick
    return formula.weight * next_order + first_order / (1 + thick)


def _next_order_of_drift(formula, times, last):
    """Bound what a drift changes in the order 2: weights are multiplied by exp(X) at most.

    With the minimum q of Lambda, relative changes of q, of Lambda and of kappa are of the order
    (q m)^2, m being the thickness of the layer. X is so much of the exponents that have them.
    """
    tilt, nearer = formula.tilt, min(formula.upper, -formula.lower)
    exponents = 1 + abs(tilt.exponent) * nearer - tilt.rate * times
    relative = (tilt.exponent * formula.layer_thickness) ** 2
    change = tuning.CORRECTED_ERROR.drift * relative * exponents
    return last * np.expm1(np.minimum(change, 1.0))


def _inherited(formula, errors, times):
    """Yield what the errors of the constants of the orders 2 and 3 add to R."""
    D, frequency = formula.constants.diffusion, formula.frequency(times)
    if errors.order > 1:
        yield (errors.h + max(errors.dipole)) / (D * times)
        yield errors.dispersion * frequency / D**2
    if errors.order > 2:
        yield (max(errors.kappa3) + errors.r) * np.sqrt(frequency / D) / (D * times)
        farther = max(w for w in (-formula.moved_lower, formula.moved_upper) if np.isfinite(w))
        yield errors.fifth * farther * frequency / (2 * D**3 * times)


def _moved_by_errors(c: LayerConstants, errors: LayerConstants) -> Iterator[LayerConstants]:
    """Move each constant of order 1 by its error, one at a time."""
    lower, upper = c.kappa
    for moved in (
        replace(c, diffusion=c.diffusion + errors.diffusion),
        replace(c, kappa=(lower + errors.kappa[0], upper)),
        replace(c, kappa=(lower, upper + errors.kappa[1])),
        replace(c, u=c.u + errors.u),
        replace(c, skewness=c.skewness + errors.skewness),
    ):
        if moved != c:
            yield moved
