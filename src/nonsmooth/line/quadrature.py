"""gamma^2, invariant density and Poisson solution of one-dimensional scenes by quadrature.

With m = exp(-depth)/Z, depth = 2 energy / sigma^2, the Poisson equation -A u = g - E g reads
(m u')' = -(2/sigma^2) (g - E g) m, so that

    u' = 2/(sigma^2 m) int_y^inf (g - E g) m,    gamma^2 = sigma^2 int u'^2 m  (Theorem thm3):

sums over composite Gauss-Legendre elements, no linear algebra. Elements have their edges on the
kinks of the drift and of g, and are halved until g m is a polynomial on each to within rounding.
Every integral is taken from the nearer end, where the summands are smallest.
"""

import functools
from collections.abc import Callable
from dataclasses import dataclass, fields
from itertools import combinations

import mpmath
import numpy as np
import sympy
from numpy.polynomial import legendre
from scipy.optimize import brentq

from nonsmooth.errors import SceneError
from nonsmooth.estimate import require
from nonsmooth.grids.grading import distinct
from nonsmooth.line.eigenfunctions import potential
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene

_EPS = np.finfo(float).eps
_DEEPEST = 690.0  # where the elements end: exp(-690) = 1e-300 is still a normal number
# exp(-2 x) on [-1, 1], to which four units of depth amount, has Legendre coefficients below
# 1e-17 from degree 18 on
_STEEPEST, _POINTS = 4.0, 20
_RESOLVED = 1e-13  # relative effect on gamma^2 at which an element is left alone, some 500 eps
_NOISE = 100 * _EPS  # relative size of the last Legendre coefficients that may be rounding of g
_PAIRWISE = 32  # additions in a row in numpy's sums of up to 1e6 numbers
_ROUNDS, _MOST = 120, 3000  # halvings and elements after which a formula is given up
_SAMPLED = 60  # elements on which g is evaluated to many digits

_NODES, _WEIGHTS = legendre.leggauss(_POINTS)
_MODES = legendre.legvander(_NODES, _POINTS - 1).T * _WEIGHTS * (np.arange(_POINTS)[:, None] + 0.5)
_FROM_LEFT = legendre.legval(_NODES, legendre.legint(np.eye(_POINTS), lbnd=-1)).T @ _MODES
_FROM_RIGHT = _WEIGHTS - _FROM_LEFT
_SLOPES = legendre.legval(_NODES, legendre.legder(np.eye(_POINTS))).T @ _MODES


@dataclass(frozen=True)
class _Problem:
    """A scene as functions of y; g is without its additive `constant`."""

    scene: Scene
    depth: Callable
    knot: float
    constant: float
    varying: sympy.Expr

    def g(self, y):
        with np.errstate(all="ignore"):  # of the branches that are not taken
            value = vectorised(self.varying, (symbols.y,))(y)
        if not np.all(np.isfinite(value)):
            place = np.asarray(y)[~np.isfinite(value)][0]
            raise SceneError(
                f"g = {self.scene.observable!r} is not finite at y = {place:g}; "
                "choose one that is, or write it so that it does not overflow"
            )
        return value

    def elements(self, left, right):
        """Evaluate depth and g on intervals."""
        points = left[:, None] + (right - left)[:, None] / 2 * (_NODES + 1)
        return _Elements(left, right, points, self.depth(points), self.g(points))

    def halved(self, elements, marked):
        """Halve the marked elements."""
        left, right = elements.left[marked], elements.right[marked]
        middle = (left + right) / 2
        new = self.elements(np.append(left, middle), np.append(middle, right))
        order = np.argsort(np.append(elements.left[~marked], new.left))
        return _Elements(
            *(
                np.concatenate([getattr(elements, f.name)[~marked], getattr(new, f.name)])[order]
                for f in fields(_Elements)
            )
        )


@dataclass(frozen=True)
class _Elements:
    """Intervals, increasing, with an edge at 0; depth and g at their Gauss points."""

    left: np.ndarray  # (k,)
    right: np.ndarray
    points: np.ndarray  # (k, _POINTS)
    depth: np.ndarray
    g: np.ndarray

    @property
    def half(self):
        """Half the lengths, shape (k, 1)."""
        return (self.right - self.left)[:, None] / 2

    @property
    def mass(self):
        """Quadrature weights times exp(-depth)."""
        return self.half * _WEIGHTS * np.exp(-self.depth)


@dataclass(frozen=True)
class _Solution:
    """Integrals over the elements."""

    elements: _Elements
    total: float  # Z
    mean: float
    variance: float  # gamma^2
    flux: np.ndarray  # int_y^inf (g - E g) exp(-depth) at the outer edge of each element
    influence: np.ndarray  # of a change of g at a Gauss point on gamma^2, to first order
    missed: np.ndarray  # of int |g - E g| m by the polynomial on each element
    misfit: np.ndarray  # its effect on gamma^2
    tail: float  # what the two outermost elements contribute to gamma^2
    rounding: float  # of gamma^2, but for the formula of g


@dataclass(frozen=True)
class _Result:
    """The finer of two solutions, and its absolute errors; that of the density is relative."""

    problem: _Problem
    solution: _Solution
    variance_error: float
    mean_error: float
    density_error: float


def asymptotic_variance(scene, tol=1e-10):
    """gamma_g^2, the growth rate of the variance of int_0^t g (Theorem thm3).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    tol : float
        Requested relative error, "1".

    Returns
    -------
    value, error : float
        The error is the difference of two solutions, the second on elements half as wide, and
        the rounding error to first order: of the exponentials, of the formula of g, measured
        against an evaluation to 40 digits, and of the sums. Neither solution sees a feature of
        g that is narrower than the distance of its points, unless it is at a sign change of the
        argument of an absolute value, maximum, logarithm, ... of the formula.

    Raises
    ------
    SceneError
        If the scene has another state or noise, g is not finite, or not square-integrable.
    ToleranceError
        If `tol` cannot be met; the message has the best value and its error.
    """
    result = _solved(scene)
    value, error = float(result.solution.variance), float(result.variance_error)
    require(error <= tol * value, value, error, tol)
    return value, error


def mean(scene):
    """Stationary mean of the observable.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.

    Returns
    -------
    value, error : float

    Raises
    ------
    SceneError
        As for `asymptotic_variance`.
    """
    result = _solved(scene)
    return float(result.problem.constant + result.solution.mean), float(result.mean_error)


def density(scene, y):
    """Invariant density m of the state (section 5 of the paper).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    y : array_like
        "1".

    Returns
    -------
    value, error : numpy.ndarray, shape of `y`

    Raises
    ------
    SceneError
        As for `asymptotic_variance`.
    """
    result = _solved(scene)
    depth = result.problem.depth(np.asarray(y, dtype=float))
    value = np.exp(-depth) / result.solution.total
    return value, value * (_exponential_rounding(depth) + result.density_error)


def poisson_slope(scene, y):
    """u', the slope of the Poisson solution -A u = g - E g.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    y : array_like
        Where the density is above 1e-300 of its maximum, "1".

    Returns
    -------
    numpy.ndarray, shape of `y`

    Raises
    ------
    SceneError
        As for `asymptotic_variance`, or if a point is too far out.
    """
    result = _solved(scene)
    s, y = result.solution, np.asarray(y, dtype=float)
    left, right = s.elements.left, s.elements.right
    if not np.all((left[0] <= y) & (y <= right[-1])):
        raise SceneError(
            f"u' is computed where the density is above 1e-300 of its maximum; "
            f"choose points between {left[0]:g} and {right[-1]:g}"
        )
    depth, g = result.problem.depth, result.problem.g
    k = np.clip(np.searchsorted(left, y, side="right") - 1, 0, len(left) - 1)
    half = (np.where(y < 0, left[k], right[k]) - y)[..., None] / 2  # < 0 on the left
    points = y[..., None] + half * (_NODES + 1)
    inside = np.sum(half * _WEIGHTS * (g(points) - s.mean) * np.exp(-depth(points)), axis=-1)
    return 2 / scene.noise.sigma**2 * (inside + s.flux[k]) * np.exp(depth(y))


@functools.lru_cache(maxsize=64)
def _solved(scene):
    """Refine, halve once more, compare."""
    problem = _problem(scene)
    edges = _edges(problem)
    elements = problem.elements(edges[:-1], edges[1:])
    sigma = scene.noise.sigma
    for _ in range(_ROUNDS):
        coarse = _solve(elements, sigma)
        rough = coarse.misfit > _RESOLVED * coarse.variance
        # halving does not help against the rounding of g
        hopeful = rough & (coarse.missed > _NOISE * np.sum(elements.mass * np.abs(elements.g), 1))
        if not hopeful.any() or len(hopeful) > _MOST:
            break
        elements = problem.halved(elements, hopeful)
    fine = _solve(problem.halved(elements, np.full(len(elements.left), True)), sigma)
    if not fine.tail <= _EPS * fine.variance:
        raise SceneError(
            f"g = {scene.observable!r} is not square-integrable, so that gamma^2 may be infinite; "
            "choose one that grows less"
        )
    formula = _formula_error(problem.varying, fine)
    mass = fine.elements.mass / fine.total
    exponential = _exponential_rounding(fine.elements.depth)
    spread = np.abs(fine.elements.g - fine.mean)
    return _Result(
        problem,
        fine,
        abs(fine.variance - coarse.variance)
        + np.sum(coarse.misfit[rough])
        + fine.tail
        + fine.rounding
        + np.sum(fine.influence * formula),
        abs(fine.mean - coarse.mean)
        + np.sum(coarse.missed[rough])
        + np.sum(mass * (exponential * spread + formula))
        + _EPS * (abs(problem.constant) + abs(fine.mean)),
        abs(fine.total / coarse.total - 1) + np.sum(mass * exponential),
    )


def _problem(scene):
    energy, knot = potential(scene)
    constant, varying = scene.numerical_observable().as_independent(symbols.y, as_Add=True)
    return _Problem(scene, vectorised(energy, (symbols.y,)), knot, float(constant), varying)


def _edges(problem):
    """Edges at 0 and on the kinks, between which the density falls by exp(-4) at most."""
    # the damping alone puts the end here, friction nearer
    end = problem.scene.noise.sigma * np.sqrt(_DEEPEST / problem.scene.damping)
    if problem.depth(end) > _DEEPEST:
        end = brentq(lambda y: problem.depth(y) - _DEEPEST, 0.0, end)
    edges = _apart([-end, -problem.knot, 0.0, problem.knot, end], end)
    functions = [vectorised(f, (symbols.y,)) for f in switches(problem.varying)]
    while True:  # edges may bring to light kinks that were too close together
        while np.any(steep := np.abs(np.diff(problem.depth(edges))) > _STEEPEST):
            edges = np.sort(np.append(edges, (edges[:-1] + edges[1:])[steep] / 2))
        grown = _apart(np.concatenate([edges, *(sign_changes(f, edges) for f in functions)]), end)
        if len(grown) == len(edges) or len(grown) > _MOST:
            return edges
        edges = grown


def _apart(edges, end):
    """Sort edges within [-end, end]; of those that only rounding keeps apart, keep the first."""
    return distinct(np.clip(edges, -end, end), relative=8 * _EPS)


def switches(expression):
    """Expressions at whose sign changes g may have a kink, a jump or a pole."""
    differences = [f.lhs - f.rhs for f in expression.atoms(sympy.core.relational.Relational)]
    for f in expression.atoms(sympy.Max, sympy.Min):
        differences += [a - b for a, b in combinations(f.args, 2)]
    differences += [f.args[0] for f in expression.atoms(sympy.Abs, sympy.sign, sympy.log)]
    differences += [f.base for f in expression.atoms(sympy.Pow) if not f.exp.is_nonnegative]
    return [f for f in dict.fromkeys(differences) if f.free_symbols == {symbols.y}]


def sign_changes(function, edges):
    """Bisect all sign changes between neighbours of the edges and Gauss points at once."""
    half = np.diff(edges)[:, None] / 2
    points = np.sort(np.append(edges, edges[:-1, None] + half * (_NODES + 1)))
    with np.errstate(all="ignore"):
        sign = np.sign(function(points))
        change = np.flatnonzero(sign[:-1] * sign[1:] < 0)
        low, high, before = points[change], points[change + 1], sign[change]
        while np.any((low < (middle := (low + high) / 2)) & (middle < high)):
            below = np.sign(function(middle)) == before
            low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.concatenate([points[sign == 0], high])


def _running(values, backward):
    """Integrals from the left end, or to the right end, at the Gauss points and at the edges.

    Parameters
    ----------
    values : numpy.ndarray, shape (k, _POINTS)
        Times half the length of the element.
    """
    whole = values @ _WEIGHTS
    if backward:
        edge = np.append(np.cumsum(whole[:0:-1])[::-1], 0.0)
        return values @ _FROM_RIGHT.T + edge[:, None], edge
    edge = np.append(0.0, np.cumsum(whole[:-1]))
    return values @ _FROM_LEFT.T + edge[:, None], edge


def _from_ends(elements, values):
    """int_y^end for y > 0, int_-end^y for y < 0: at the Gauss points, at the outer edges."""
    zero = np.searchsorted(elements.left, 0.0)
    left, right = _running(values[:zero], False), _running(values[zero:], True)
    return tuple(np.concatenate(pair) for pair in zip(left, right, strict=True))


def _from_middle(elements, values):
    """int_0^y for y > 0, int_y^0 for y < 0, at the Gauss points."""
    zero = np.searchsorted(elements.left, 0.0)
    return np.concatenate([_running(values[:zero], True)[0], _running(values[zero:], False)[0]])


@np.errstate(over="ignore", invalid="ignore")  # integrals that diverge are refused
def _solve(e, sigma):
    """Integrate over the elements."""
    mass, side = e.mass, np.where(e.left < 0, -1.0, 1.0)
    total = mass.sum()
    mean = np.sum(mass * e.g) / total
    mean += np.sum(mass * (e.g - mean)) / total  # what rounding of a large mean has left
    centred = e.g - mean
    source = e.half * np.exp(-e.depth) * centred
    flux, flux_outside = _from_ends(e, source)
    flux, flux_outside = side[:, None] * flux, side * flux_outside
    slope = 2 / sigma**2 * flux * np.exp(e.depth)
    u = side[:, None] * _from_middle(e, e.half * slope)
    u -= np.sum(mass * u) / total
    mass = mass / total
    variance = sigma**2 * np.sum(slope * (mass * slope))
    # gamma^2 is the maximum over v of 4 <g, v> - sigma^2 <v'^2>, attained by u: to first order
    # in errors of g and m only these expressions change, not u
    influence = 4 * mass * np.abs(u)
    by_density = mass * (4 * np.abs(centred * u) + sigma**2 * slope**2 + variance)
    missed = np.abs(source @ _MODES[-3:].T).sum(axis=1) * 2 / total
    # rounding of the flux: within the element, of the partial sums over elements, of the mean
    moduli, partial = _from_ends(e, np.abs(source))
    beyond, _ = _from_ends(e, e.half * np.exp(-e.depth))
    zero = np.searchsorted(e.left, 0.0)
    partial = np.append(np.cumsum(partial[:zero]), np.cumsum(partial[zero:][::-1])[::-1])
    flux_error = _POINTS * moduli + partial[:, None]
    flux_error += _PAIRWISE * beyond * np.sum(mass * np.abs(centred))
    sums = 4 * np.sum(e.half * _WEIGHTS * np.abs(slope) * flux_error) / total
    sums += 2 * _PAIRWISE * variance
    return _Solution(
        e,
        total,
        mean,
        variance,
        flux_outside,
        influence,
        missed,
        4 * np.abs(u).max(axis=1) * missed,
        by_density[[0, -1]].sum(),
        np.sum(by_density * _exponential_rounding(e.depth)) + _EPS * sums,
    )


def _exponential_rounding(depth):
    """Relative error of exp(-depth): depth is rounded, and so is the point, four times in all."""
    return _EPS * (4 + 4 * depth)


def _formula_error(varying, solution):
    """Bound the rounding error of g at the Gauss points.

    It is that of the point, by way of the slope of g, that of the result, and that of the
    formula, which may cancel: it is measured on the elements that matter most, at three points
    of each, and the largest of the three taken for the element.
    """
    e = solution.elements
    slope = e.g @ _SLOPES.T / e.half
    error = _EPS * (np.abs(e.points * slope) + np.abs(e.g))
    weight = solution.influence.sum(axis=1)
    chosen = np.argsort(weight)[-_SAMPLED:]
    exact = sympy.lambdify(symbols.y, varying, "mpmath")
    with mpmath.workdps(40):
        for k in chosen:
            error[k] += max(
                abs(float(exact(mpmath.mpf(e.points[k, i])) - e.g[k, i]))
                for i in (1, _POINTS // 2, _POINTS - 2)
            )
    return error
