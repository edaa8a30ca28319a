"""Two state variables: the backward equation on a tensor grid that ends at the levels.

The probability q(t, z) that a path from z stays inside until t solves q_t = A q, q = 1 at t = 0. At
a level of the variable that noise drives q = 0. At a level of one that is only transported, q = 0
where the flow leaves and nothing is asked where it enters. There q is singular at the point where
the flow turns, towards which the elements crowd. Steps in time are those of a rational
approximation of the exponential that damps what the grid does not resolve; they grow with time.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import make_interp_spline, pade
from scipy.optimize import brentq
from sympy import Symbol

from nonsmooth.crossing.first_passage.each_part import refine_each_part
from nonsmooth.crossing.state import tuning
from nonsmooth.crossing.state.problem import StateCrossing
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.direct_solver import SparseFactors
from nonsmooth.grids.elements import Axis, continuous, discontinuous
from nonsmooth.grids.generator import assemble, start_row
from nonsmooth.grids.grading import distinct, geometric
from nonsmooth.grids.mesh.axes import variables
from nonsmooth.grids.mesh.box import half_widths, is_known
from nonsmooth.grids.mesh.edges import element_edges
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.symbols import x, y


def applies(asked: StateCrossing) -> bool:
    """Whether the variable has one companion in its state, at a finite n, and a known box."""
    scene = asked.scene
    held = asked.variable != x or math.isfinite(asked.lower + asked.upper) or scene.is_confined
    return scene.dimension == 2 and math.isfinite(scene.n) and is_known(scene) and held


@dataclass(frozen=True)
class _Level:
    """Resolution of the grid and of the steps, and the box.

    `layers` tells how far the elements crowd. The box has a depth, and is enlarged by a margin.
    """

    degree: int
    layers: int
    steps: int
    depth: float
    margin: float = 0.0


def solved(asked: StateCrossing, times: np.ndarray, tol: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the probability to have left the interval, and its error.

    Parameters
    ----------
    asked : StateCrossing
        To which this module `applies`.
    times : numpy.ndarray, shape (t,)
        Increasing, positive.
    tol : float
        Absolute error wanted.

    Returns
    -------
    probability, error : numpy.ndarray, shape (t,)
        The error is the sum of what the degree, the layers and the steps change if each alone is
        made coarser by one, plus what a larger box changes. Changes may pass through zero; that of
        a time is the largest at it and at some earlier ones.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    settings = tuning.PLANE
    depth = math.log(1 / tol) + settings.spare
    also = np.multiply.outer(settings.earlier, times)

    @cache
    def solve(at, margin=0.0):
        return _probabilities(asked, also, _Level(*at, depth, margin))

    coarsest = tuple(part.first + part.step for part in tuning.PLANE_PARTS)
    box = 2 * np.abs(solve(coarsest, settings.margin) - solve(coarsest)).max(axis=0)

    def error(found):
        return found.change.max(axis=0) + box + settings.least

    found = refine_each_part(
        tuning.PLANE_PARTS, lambda at, count: solve(at), lambda found: error(found) <= tol, tol
    )
    value, total = np.clip(found.value[-1], 0.0, 1.0), error(found)
    if not np.all(total <= tol):
        raise ToleranceError(
            f"W = {value[-1]:.7g} has an error of {total.max():.1e}, above tol = {tol:g}; "
            "loosen tol or use method='monte_carlo'",
            (value, total),
        )
    return value, total


def _probabilities(asked, times, level):
    """Solve on one level."""
    axes, inside = _axes(asked, level)
    generator = assemble(asked.scene, axes)
    keep = np.ones(1, dtype=bool)
    for symbol, axis in axes.items():
        whole = np.ones(len(axis.nodes), dtype=bool)
        keep = np.outer(keep, inside if symbol == asked.variable else whole).ravel()
    generator = generator[keep][:, keep].tocsc()
    row = start_row(asked.scene, axes)[keep]
    at, survival = _stepped(generator, row, times[-1], tuning.PLANE.refined[level.steps])
    return 1 - make_interp_spline(at, survival, k=5)(times)


def _axes(asked: StateCrossing, level: _Level) -> tuple[dict[Symbol, Axis], np.ndarray]:
    """Return the axes, and which nodes of the crossing variable are inside.

    Beyond a level of a transported variable there is one element more, whose nodes are left out
    again: q = 0 there flows in through the face.
    """
    scene, ends = asked.scene, _box(asked, level.depth)
    walls = np.isfinite([asked.lower, asked.upper])
    made: dict[Symbol, Axis] = {}
    for symbol in variables(scene):
        edges, free = _edges(asked, symbol, ends, level.layers), np.full(2, True)
        if symbol == asked.variable:
            free = ~walls
        beyond = edges[[0, -1]] + level.margin * ends[symbol] * np.array([-1, 1])
        if symbol == asked.variable and not asked.driven:
            beyond[walls] = (2 * edges[[0, -1]] - edges[[1, -2]])[walls]
            free = np.full(2, True)
        edges = np.concatenate([beyond[:1][free[:1]], edges, beyond[1:][free[1:]]])
        axis = continuous if symbol == scene.noise.driven else discontinuous
        made[symbol] = axis(np.unique(edges), level.degree)
    outside = walls * (1 if asked.driven else level.degree + 1)
    inside = np.arange(len(made[asked.variable].nodes))
    return made, (inside >= outside[0]) & (inside[::-1] >= outside[1])


def _box(asked: StateCrossing, depth: float) -> dict[Symbol, float]:
    """Half widths of the variables, where no level ends them."""
    scene = asked.scene
    if asked.variable == x and math.isfinite(asked.lower + asked.upper):
        # the velocity that noise feeds, and what the potential between the levels may add
        potential = scene.potential_expression + scene.mechanics.added_potential.subs(
            penalization, scene.n
        )
        within = np.linspace(asked.lower, asked.upper, tuning.PLANE.samples)
        height = np.ptp(vectorised(potential, (x,))(within))
        speed = math.sqrt(scene.noise.sigma**2 * depth / scene.damping + 2 * height)
        ends = {y: speed, x: max(-asked.lower, asked.upper)}
    else:
        ends = dict(half_widths(scene, depth))
        # a level is where it is, unless so far away that no path comes there
        far = half_widths(scene, depth + tuning.PLANE.beyond)[asked.variable]
        levels = [abs(b) for b in (asked.lower, asked.upper) if math.isfinite(b)]
        ends[asked.variable] = max(ends[asked.variable], min(max(levels), far))
    room = tuning.PLANE.around
    return {s: max(ends[s], room * abs(scene.start.get(s.name, 0.0))) for s in variables(scene)}


def _edges(asked: StateCrossing, symbol: Symbol, ends: Mapping, number: int) -> np.ndarray:
    """Edges of the elements of a variable."""
    settings, end = tuning.PLANE, ends[symbol]
    edges = element_edges(asked.scene, symbol, end, settings.layers + number)
    parts = np.linspace(-end, end, settings.elements + 1)
    layers = settings.crowded + 2 * number
    if symbol == asked.variable:
        lower, upper = max(asked.lower, -end), min(asked.upper, end)
        more = [edges, parts, np.array([lower, upper])]
        for level, side in ((asked.lower, 1), (asked.upper, -1)):
            if math.isfinite(level):
                here = (settings.rough_ratio, layers) if asked.driven else settings.fronts[number]
                more.append(level + side * geometric((upper - lower) / 2, *here))
        edges = np.concatenate(more)
        edges = edges[(edges >= lower) & (edges <= upper)]
        return _apart(edges, np.array([lower, upper]), upper - lower)
    turns = _turning_points(asked, symbol, end)
    grown = [
        turn + side * geometric(end, settings.turn_ratio, layers)
        for turn in turns
        for side in (1, -1)
    ]
    edges = np.concatenate([edges, parts, turns, *grown])
    return _apart(edges[np.abs(edges) <= end], np.array([-end, end, *turns]), end)


def _apart(edges, kept, scale):
    """Sort edges; leave out those that are too close to others, but keep some of them."""
    least = tuning.PLANE.closest * scale
    kept = distinct(kept)
    free = edges[np.min(np.abs(edges[:, None] - kept), axis=1) > least]
    return np.unique(np.concatenate([kept, distinct(free, least)]))


def _turning_points(asked, symbol, end):
    """Values of the other variable at which the flow through a level turns."""
    if asked.driven:
        return np.empty(0)
    rate = asked.scene.numerical_drift()[asked.variable]
    found = []
    for level in (asked.lower, asked.upper):
        if math.isfinite(level):
            speed = vectorised(rate.subs(asked.variable, level), (symbol,))
            through = [float(speed(np.array(side * end))) for side in (-1, 1)]
            if through[0] * through[1] < 0:
                found.append(brentq(lambda z, speed=speed: float(speed(np.array(z))), -end, end))
    return distinct(found, tuning.PLANE.closest * end) if found else np.empty(0)


def _stepped(generator, row, times, refined):
    """Survival probability from the start, at the times of the steps."""
    settings = tuning.PLANE
    poles, weights = _partial_fractions()
    step = times[0] * settings.first
    longest = settings.longest / refined * max(times[0], 1.0)
    identity = sp.eye_array(generator.shape[0], format="csc")
    q, at, survival = np.ones(generator.shape[0]), [0.0], [1.0]
    factors: list[SparseFactors] = []
    while at[-1] < times[-1]:
        per_length = settings.per_length if 2 * step <= longest else settings.late
        if at[-1] >= per_length * refined * step:
            step, factors = 2 * step, []
        factors = factors or [SparseFactors(pole * identity - step * generator) for pole in poles]
        q = sum(
            2 * (weight * factor.solve(q.astype(complex))).real
            for weight, factor in zip(weights, factors, strict=True)
        )
        at.append(at[-1] + step)
        survival.append(row @ q)
    return np.array(at), np.array(survival)


def _partial_fractions():
    """Poles in the upper half plane, and weights, of the approximation (3, 4) of exp."""
    series = [1 / math.factorial(k) for k in range(8)]
    above, below = pade(series, 4)
    poles = below.roots[below.roots.imag > 0]
    return poles, [-above(pole) / below.deriv()(pole) for pole in poles]
