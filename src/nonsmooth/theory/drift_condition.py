"""Search for points at which the drift condition (HV2) or the bounds of its proof fail."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from sympy import Symbol

from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES, eta, x, y, zeta
from nonsmooth.theory import drift_bounds, lyapunov, tuning


@dataclass(frozen=True)
class Margins:
    """How far the inequalities are from failing; margins are at most 1, negative if one fails.

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
        boxed bound, of the lower bound of (HV1), of Claims 7 and 8, of Claim 9 or 10, and of the
        latter as printed. 1 where there is no such claim.
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


def variables(scene: Scene) -> tuple[Symbol, ...]:
    """Return the variables of V_n: all of the state, without x where that is not confined."""
    confined = lyapunov.constants(scene).confinement is not None
    return tuple(s for s in scene.variables if s != x or confined)


def grid(
    scene: Scene, names: tuple[Symbol, ...], points: int, reach: float
) -> dict[Symbol, np.ndarray]:
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
    kink, _, _ = scene.mechanics.penalty.at(scene.n)
    axes = []
    for s in names:
        positive = np.geomspace(tuning.DRIFT_CONDITION.smallest, reach, half)
        if s == scene.mechanics.argument:
            positive = np.append(positive, kink)
        axes.append(np.unique(np.concatenate([-positive, [0.0], positive])))
    mesh = np.meshgrid(*axes, indexing="ij")
    return {s: values.ravel() for s, values in zip(names, mesh, strict=True)}


def margins(scene: Scene, points: int = 20_000, reach: float = 1e6) -> Margins:
    """Search the state space for the smallest margins.

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
    boxed, below = drift_bounds.bound(scene), drift_bounds.lower_bound(scene)
    top, spread = _supremum(scene, names, z, value, magnitude)
    mechanical, forcing, forcing_printed = _margins_of_claims(scene, names, points, reach)
    V, terms = lyapunov.evaluate(scene, z, "value")
    unit = np.finfo(float).eps
    operations = 4 * len(STATE_VARIABLES) + 8  # products within and sums over the terms
    return Margins(
        supremum=top,
        supremum_error=operations * unit * spread,
        constant=boxed.supremum,
        drift=1 - top / boxed.supremum,
        boxed=_smallest(boxed.evaluate(z), (value, magnitude)),
        lower=_smallest(below.evaluate(z), (-V, terms)),
        mechanical=mechanical,
        forcing=forcing,
        forcing_printed=forcing_printed,
        coefficient=min(below.quadratic.values()),
        rounding=2 * operations * unit,
    )


def _supremum(scene, names, z, value, magnitude):
    """Largest A_n V_n + epsilon V_n on a grid and near its best point, and its terms' size.

    Powell's method needs no derivatives, so that kinks do not matter.
    """
    best = int(np.argmax(value))
    found = [(float(value[best]), float(magnitude[best]))]
    start = np.array([z[s][best] for s in names])
    scale = np.where(start == 0, tuning.DRIFT_CONDITION.smallest, np.abs(start))

    def negative(w):
        at = {s: np.array([v]) for s, v in zip(names, w * scale, strict=True)}
        total, terms = lyapunov.evaluate(scene, at)
        found.append((float(total[0]), float(terms[0])))
        return -float(total[0])

    limits = {"maxfev": tuning.DRIFT_CONDITION.evaluations * len(names)}
    minimize(negative, start / scale, method="Powell", options=limits)
    return max(found, key=lambda pair: pair[0])


def _margins_of_claims(scene, names, points, reach):
    """Margins of Claims 7 and 8, of Claim 9 or 10, and of the latter as printed; 1 without one."""
    mechanical = forcing = forcing_printed = 1.0
    if scene.noise.kind != "white":
        w = grid(scene, tuple(s for s in (zeta, eta) if s in names), points, reach)
        drift = drift_bounds.noise_drift(scene, w)
        forcing, forcing_printed = (
            _smallest(drift_bounds.noise_bound(scene, printed).evaluate(w), drift)
            for printed in (False, True)
        )
    if x in names:
        w = grid(scene, (y, x), points, reach)
        mechanical = min(
            _smallest(bound, value) for value, bound in drift_bounds.mechanical_claims(scene, w)
        )
    return mechanical, forcing, forcing_printed


def _smallest(bound, value):
    """Return the smallest distance of a value from its bound, relative to the size of all terms."""
    (upper, large), (lower, small) = bound, value
    terms = large + small
    room = np.divide(upper - lower, terms, out=np.ones_like(terms), where=terms > 0)
    return float(np.min(np.where(terms > 0, room, 0.0)))
