"""Search for points at which the drift condition (HV2) or the bounds of its proof fail."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from nonsmooth.scenes.symbols import STATE_VARIABLES, eta, x, y, zeta
from nonsmooth.theory import drift_bounds, lyapunov

_SMALLEST = 1e-6  # least non-zero value on each axis, besides the kinks
_EVALUATIONS = 60  # of the refinement, for each variable


@dataclass(frozen=True)
class Margins:
    """How far the inequalities are from failing; all are at most 1 and negative where they fail.

    Attributes
    ----------
    supremum, supremum_error : float
        Largest value found of A_n V_n + epsilon V_n, and its rounding error, "1".
    constant : float
        C of (HV2), the supremum of the paper's bound.
    drift : float
        (C - supremum) / C.
    boxed, lower, mechanical, forcing, forcing_printed : float
        Smallest (bound - value) / (sum of the absolute values of all terms) over the grid: of the
        boxed bound, of the lower bound of (HV1), of claims S_1 and S_2, of claim S_3 or S_4, and of
        the latter as printed. 1 where there is no such claim.
    coefficient : float
        c > 0 in V_n >= c |z|^2 + 1.
    rounding : float
        Bound on the rounding error of these ratios.
    """

    supremum: float
    supremum_error: float
    constant: float
    drift: float
    boxed: float
    lower: float
    mechanical: float
    forcing: float
    forcing_printed: float
    coefficient: float
    rounding: float


def variables(scene):
    """Return the variables of V_n: all of the state, without x where that is not confined."""
    confined = lyapunov.constants(scene).confinement is not None
    return tuple(s for s in scene.variables if s != x or confined)


def grid(scene, names, points, reach):
    """Return points of a product grid: 0, the kinks, and log-spaced values of both signs.

    Parameters
    ----------
    scene : Scene
    names : tuple of sympy.Symbol
    points : int
        Number of points in all, about.
    reach : float
        Largest absolute value, "1".

    Returns
    -------
    dict
        Symbol -> array of shape (k,).
    """
    half = max(3, round((points ** (1 / len(names)) - 1) / 2))
    knot, _, _ = scene.mechanics.penalty.at(scene.n)
    axes = []
    for s in names:
        positive = np.geomspace(_SMALLEST, reach, half)
        if s == scene.mechanics.argument:
            positive = np.append(positive, knot)
        axes.append(np.unique(np.concatenate([-positive, [0.0], positive])))
    mesh = np.meshgrid(*axes, indexing="ij")
    return {s: values.ravel() for s, values in zip(names, mesh, strict=True)}


def _smallest(bound, value):
    (upper, large), (lower, small) = bound, value
    terms = large + small
    room = np.divide(upper - lower, terms, out=np.ones_like(terms), where=terms > 0)
    return float(np.min(np.where(terms > 0, room, 0.0)))


def margins(scene, points=20_000, reach=1e6):
    """Search the state space for the smallest margins.

    The largest value on the grid is refined by Powell's method, which needs no derivatives and so
    does not mind the kinks.

    Parameters
    ----------
    scene : Scene
    points : int
        Number of points of the grid.
    reach : float
        Largest absolute value of each variable, "1".

    Returns
    -------
    Margins

    Raises
    ------
    SceneError
        If the scene is outside the paper's assumptions.
    """
    names = variables(scene)
    z = grid(scene, names, points, reach)
    value, magnitude = lyapunov.evaluate(scene, z)
    boxed = drift_bounds.bound(scene)
    best = int(np.argmax(value))
    top, spread = float(value[best]), float(magnitude[best])
    start = np.array([z[s][best] for s in names])
    scale = np.where(start == 0, _SMALLEST, np.abs(start))

    def negative(w):
        at = {s: np.array([v]) for s, v in zip(names, w * scale, strict=True)}
        total, terms = lyapunov.evaluate(scene, at)
        nonlocal top, spread
        if total[0] > top:
            top, spread = float(total[0]), float(terms[0])
        return -float(total[0])

    limits = {"maxfev": _EVALUATIONS * len(names)}
    minimize(negative, start / scale, method="Powell", options=limits)
    constant = boxed.supremum
    forcing = forcing_printed = 1.0
    if scene.noise.kind != "white":
        own = tuple(s for s in (zeta, eta) if s in names)
        w = grid(scene, own, points, reach)
        drift = drift_bounds.noise_drift(scene, w)
        forcing = _smallest(drift_bounds.noise_bound(scene).evaluate(w), drift)
        forcing_printed = _smallest(
            drift_bounds.noise_bound(scene, printed=True).evaluate(w), drift
        )
    mechanical = 1.0
    if x in names:
        w = grid(scene, (y, x), points, reach)
        mechanical = min(
            _smallest(bound, value) for value, bound in drift_bounds.mechanical_claims(scene, w)
        )
    V, terms = lyapunov.evaluate(scene, z, "value")
    below = drift_bounds.lower_bound(scene)
    unit = np.finfo(float).eps
    operations = 4 * len(STATE_VARIABLES) + 8  # products within and sums over the terms
    return Margins(
        supremum=top,
        supremum_error=operations * unit * spread,
        constant=constant,
        drift=1 - top / constant,
        boxed=_smallest(boxed.evaluate(z), (value, magnitude)),
        lower=_smallest(below.evaluate(z), (-V, terms)),
        mechanical=mechanical,
        forcing=forcing,
        forcing_printed=forcing_printed,
        coefficient=min(below.quadratic.values()),
        rounding=2 * operations * unit,
    )
