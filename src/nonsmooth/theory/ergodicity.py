"""V-uniform ergodicity and the bound of Poisson solutions, Theorems 4 and 5 of the paper, measured.

The semigroup is stepped in time, so that the rate of decay is found without eigenvalues. Norms are
weighted with the paper's own Lyapunov function V_n. They are taken on a box, and do not tell how
long a path from infinity takes to come back. Far from 0 the drift is linear, and
`scenes.relaxation.rate_at_infinity` has the rate there.
"""

import math
import time
from dataclasses import dataclass

import numpy as np

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.scenes.scene import Scene
from nonsmooth.theory import lyapunov, tuning

_GAMMA = 1 - math.sqrt(0.5)  # of the L-stable, singly diagonal Runge-Kutta scheme of order two


@dataclass(frozen=True)
class Bound:
    """The smallest C with |u| <= C (V_n + 1) on a box, for the Poisson solution u of mean zero.

    Attributes
    ----------
    constant, error : float
        The error is the sum of the changes by a coarser grid and by a narrower box, and rounding.
    edge : float
        The same C on the surface of the box; below `constant` unless C grows with the box.
    """

    constant: float
    error: float
    edge: float


def decay_rate(scene: Scene, step: float = 0.1) -> Estimate:
    """Rate at which sup |P_t f - m(f)| / (V_n + 1) decays on a box, the slower of f = g and V_n.

    Parameters
    ----------
    scene : Scene
        With one or two state variables, a finite n, and covered by the paper's theorems.
    step : float
        Time step, "1".

    Returns
    -------
    Estimate
        The error is the sum of the changes by twice the step, by a coarser grid, and by an earlier
        window of time.

    Raises
    ------
    SceneError
        If the scene has more variables or no Lyapunov function.
    ToleranceError
        If the decay is too slow for the step, or is no exponential yet.
    """
    _require_grid(scene)
    began = time.perf_counter()
    chosen = tuning.ERGODICITY
    slow, _ = _rate(scene, chosen.coarse, 2 * step)
    coarse, _ = _rate(scene, chosen.coarse, step)
    value, earlier = _rate(scene, chosen.fine, step)
    error = abs(slow - coarse) + abs(value - coarse) + chosen.unsettled * abs(value - earlier)
    if not error < value / 2:
        raise ToleranceError(
            f"P_t f decays at the rate {value:.3g} with an error of {error:.1g}: the step is too "
            "long, or eigenvalues nearly coincide; take a shorter step or another scene"
        )
    return Estimate(value, error, "time stepping", time.perf_counter() - began)


def poisson_bound(scene: Scene, enlargement: float = 2.0) -> Bound:
    """Find the constant C of |u| <= C (V_n + 1), u the Poisson solution of g - E g.

    Parameters
    ----------
    scene : Scene
        As for `decay_rate`.
    enlargement : float
        Width of the box relative to that which holds the invariant density, above 1.

    Returns
    -------
    Bound

    Raises
    ------
    SceneError
        If the scene has more variables or no Lyapunov function.
    ToleranceError
        If the grid does not resolve where |u| / (V_n + 1) is large.
    """
    _require_grid(scene)
    chosen = tuning.ERGODICITY
    narrow, _ = largest_ratio(scene, chosen.fine, (enlargement - 1) / 2)
    coarse, _ = largest_ratio(scene, chosen.coarse, enlargement - 1)
    constant, edge = largest_ratio(scene, chosen.fine, enlargement - 1)
    error = abs(constant - coarse) + abs(constant - narrow) + chosen.rounding * constant
    if not error < constant / 2:
        raise ToleranceError(
            f"|u| / (V + 1) = {constant:.3g} has an error of {error:.1g}: the grid does not "
            "resolve the narrow valley of V; choose a smaller n"
        )
    return Bound(constant, error, edge)


def _require_grid(scene):
    if scene.dimension > 2 or math.isinf(scene.n):
        raise SceneError(
            "the decay in the V-norm is computed for one or two state variables and a finite n, "
            f"not for ({', '.join(scene.state)}) at n = {scene.n:g}; choose another scene"
        )


def _discretised(scene, level, margin=0.0):
    chosen = tuning.ERGODICITY
    grid = tensor_grid.fitted(scene, chosen.depth, chosen.coarse)
    axes, solver = tensor_grid.direct_solver(scene, grid.at_level(level, margin))
    return axes, solver, evaluate(scene.numerical_observable(), axes)


def _lyapunov(scene, axes, points=None):
    values = {symbol: evaluate(symbol, axes, points) for symbol in axes}
    return lyapunov.evaluate(scene, values, "value")[0]


def largest_ratio(scene: Scene, level: int, margin: float = 0.0) -> tuple[float, float]:
    """Find the largest |u| / (V_n + 1) on one grid, u the Poisson solution of g - E g.

    Parameters
    ----------
    scene : Scene
        As for `decay_rate`.
    level : int
        Of the grid.
    margin : float
        Width that is added to the box, relative to its half width.

    Returns
    -------
    largest, edge : float
        In the part of the box that is far from its corners, and on the surface of that part.
    """
    chosen = tuning.ERGODICITY
    axes, solver, g = _discretised(scene, level, margin)
    u = solver.unfold(solver.solve(solver.fold(g), ODD)[0], ODD)
    u -= solver.stationary() @ u
    u = u.reshape([len(axis.nodes) for axis in axes.values()])

    def ratio(points):
        values = u
        for place, (symbol, axis) in enumerate(axes.items()):
            at = axis.interpolation(points[symbol]).toarray()
            values = np.moveaxis(np.tensordot(at, values, (1, place)), 0, place)
        return np.abs(values) / (_lyapunov(scene, axes, points).reshape(values.shape) + 1)

    points = {}
    for symbol, axis in axes.items():  # V_n has a narrow valley at 0
        positive = np.geomspace(
            chosen.nearest,
            chosen.trusted * axis.edges[-1],
            chosen.points,
        )
        points[symbol] = np.concatenate([-positive[::-1], [0.0], positive])
    found = ratio(points)
    inner = np.pad(np.ones([k - 2 for k in found.shape]), 1)
    largest, edge = np.max(found), np.max(found[inner == 0])
    for _ in range(chosen.rounds):
        best = np.unravel_index(np.argmax(found), found.shape)
        for (symbol, values), place in zip(points.items(), map(int, best), strict=True):
            ends = values[max(place - 1, 0)], values[min(place + 1, len(values) - 1)]
            points[symbol] = np.linspace(*ends, chosen.near)
        found = ratio(points)
        largest = max(largest, np.max(found))
    return float(largest), float(edge)


def _rate(scene, level, step):
    """Rate of decay in the second half of the window in which it is taken, and in all of it."""
    norm = np.max([part / part[0] for part in _norms(scene, level, step)], axis=0)
    window = np.log(norm[np.argmax(norm < tuning.ERGODICITY.settled) :])

    def slope(values):
        # a complex pair of eigenvalues makes the norm oscillate, which the weights suppress
        place = np.arange(len(values))
        weights = np.sin(np.pi * (place + 0.5) / len(values))  # squared by polyfit
        return -float(np.polyfit(place * step, values, 1, w=weights)[0])

    return slope(window[len(window) // 2 :]), slope(window)


def _norms(scene, level, step):
    """Norms of P_t f - m(f) for f = g and V_n, at multiples of the step until both are small."""
    chosen = tuning.ERGODICITY
    axes, solver, g = _discretised(scene, level)
    V = _lyapunov(scene, axes)
    masses, shift = solver.stationary(), 1 / (_GAMMA * step)
    weight = solver.fold(V + 1)
    parts = [(solver.fold(f - masses @ f), parity) for f, parity in ((g, ODD), (V, EVEN))]
    masses = solver.fold(masses) / np.sum(solver.fold(masses))
    norms = [[np.max(np.abs(f) / weight)] for f, _ in parts]
    while any(norm[-1] > chosen.floor * norm[0] for norm in norms):
        if len(norms[0]) > chosen.longest:
            raise ToleranceError(
                f"P_t f has not decayed in {chosen.longest} steps of {step:g}; take a longer step"
            )
        for k, (f, parity) in enumerate(parts):
            stage = shift * solver.resolvent(f, parity, shift)
            f = f + (1 / _GAMMA - 1) * (stage - f)
            f = shift * solver.resolvent(f, parity, shift)
            if parity == EVEN or not solver.mirrored:
                f -= masses @ f  # is 0 but for rounding, which would add up
            parts[k] = f, parity
            norms[k].append(np.max(np.abs(f) / weight))
    return np.array(norms)
