"""One state variable: eigenfunctions of the generator that is killed at the ends of the interval.

The variable q solves dq = -(sigma^2/2) Phi'(q) dt + sigma dW. With m = exp(-Phi) the generator
A f = (sigma^2/2) (m f')' / m is self-adjoint in L^2(m) also for functions that vanish at finite
ends of the interval. With its eigenpairs (lambda_k, phi_k) the survival probability is

    S(t) = sum_k <1, phi_k> phi_k(start) exp(-lambda_k t).

An infinite end is replaced by one so far out that it is hardly ever reached; being killed there can
only add to the probability.
"""

import math
from itertools import pairwise

import numpy as np

from nonsmooth.crossing.state import tuning
from nonsmooth.crossing.state.problem import StateCrossing
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.elements import continuous
from nonsmooth.grids.grading import distinct, growing
from nonsmooth.line import potential as line_potential
from nonsmooth.line import spectral_elements
from nonsmooth.line.eigenfunctions import modes
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.formulas import vectorised


def applies(asked: StateCrossing) -> bool:
    """Whether the variable is the only one of its state, with a known potential."""
    one = asked.scene.state == (asked.scene.observable,)
    return one and (asked.scene.is_line or asked.scene.noise.kind == "langevin")


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
        The error is three times the change by raising the polynomial degree, which is far above the
        error of the higher degree, plus rounding.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    settings = tuning.LINE
    phi, knot = _potential(asked)
    if not phi(np.array(asked.start)) < settings.deepest:
        raise ToleranceError(
            f"the start of {asked.variable} is too far in the tails, where its potential rounds; "
            "start nearer or use method='monte_carlo'"
        )
    edges = _edges(asked, phi, knot, times[0])
    depth = float(phi(np.array(asked.start)) - phi(edges).min())

    def error(found):
        change = settings.safety * np.abs(found[-1][0] - found[-2][0])
        return change + found[-1][1] + settings.least

    def solve(degree):
        value, rate = _probabilities(asked, edges, phi, times, degree)
        narrowest = np.min(np.diff(edges)) / (edges[-1] - edges[0])
        rounding = settings.rounding * np.finfo(float).eps * degree**2 / narrowest
        return value, rounding * (math.exp(depth / 2) + rate * times)

    found = until_agreement(
        settings.degrees, solve, error, lambda _, error: bool(np.all(error <= tol))
    )
    value, error_found = np.clip(found.value[0], 0.0, 1.0), found.error
    if not found.met:
        raise ToleranceError(
            f"W = {value[-1]:.7g} has an error of {error_found.max():.1e}, above tol = {tol:g}; "
            "loosen tol",
            (value, error_found),
        )
    return value, error_found


def _potential(asked):
    """Return Phi and the place of its kinks."""
    scene = asked.scene
    if scene.is_line:
        expression, knot = line_potential.potential(scene)
    else:
        expression, knot = 2 * scene.noise.potential_expression / scene.noise.sigma**2, 0.0
    return vectorised(expression, (asked.variable,)), knot


def _edges(asked, phi, knot, first_time):
    """Element edges: kinks and the start are among them; they crowd towards the levels."""
    settings, sigma = tuning.LINE, asked.scene.noise.sigma
    deepest = settings.depth + float(phi(np.array(asked.start)))
    ends = []
    for level, side in ((asked.lower, -1), (asked.upper, 1)):
        start = side * abs(asked.start)
        reach = start + side * settings.first_reach * sigma
        while phi(np.array(start + (reach - start) / settings.reach_step)) > deepest:
            reach = start + (reach - start) / settings.reach_step
        while phi(np.array(reach)) < deepest and abs(reach) < abs(level):
            reach *= settings.reach_step
        ends.append(side * min(abs(level), abs(reach)))
    lower, upper = ends
    widest = (upper - lower) / settings.fewest
    inside = [point for point in (-knot, 0.0, knot) if lower < point < upper]
    edges = [lower, upper, *inside]
    for level, towards in ((lower, 1), (upper, -1)):
        near = abs(asked.start - level)
        finest = min(near / 2, settings.layer * sigma * math.sqrt(first_time), widest)
        finest = max(finest, settings.finest * (upper - lower))
        outward = growing(0.0, upper - lower, finest, widest)
        edges.extend(level + towards * outward[outward < (upper - lower) / 2])
    edges = distinct(edges, settings.finest / 2 * (upper - lower))
    edges[[0, -1]] = lower, upper
    change = np.abs(np.diff(phi(edges)))
    if change.sum() > settings.steepest * settings.most:
        raise ToleranceError(
            f"the potential of {asked.variable} changes by {change.sum():.1e} between the levels, "
            "which elements do not resolve; use method='monte_carlo'"
        )
    parts = np.maximum(np.ceil(change / settings.steepest), 1).astype(int)
    return np.concatenate(
        [
            np.linspace(left, right, count + 1)[:-1]
            for (left, right), count in zip(pairwise(edges), parts, strict=True)
        ]
        + [[upper]]
    )


def _probabilities(asked, edges, phi, times, degree):
    """Return the probability to have left at some times, and the rate that rounding is relative to.

    The slowest rate may be exp(-60) of the next one. Entries of the matrices are of the size of the
    rates of functions that change within the well, such as the second one; all rates round like it.
    """
    lowest = phi(edges).min()
    elements = spectral_elements.weighted(edges, lambda at: phi(at) - lowest, degree)
    mass, sigma, inner = elements.products(), asked.scene.noise.sigma, slice(1, -1)
    stiffness = sigma**2 / 2 * elements.energies()[inner, inner]
    slow = (sigma / (edges[-1] - edges[0])) ** 2
    rates, vectors = modes(mass[inner, inner], stiffness, slow)
    at = continuous(edges, degree).interpolation(asked.start).toarray()[0, inner]
    weight = (mass[inner].sum(axis=1) @ vectors) * (at @ vectors)
    return 1 - np.exp(-np.outer(times, rates)) @ weight, rates[1]
