"""gamma^2 of scenes with several variables, on tensor grids that are refined until it settles.

Many grids, of which none is fine in all variables, are combined (`combination`); what the grids
beyond would add is the error.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from nonsmooth import mesh
from nonsmooth.combination import Combination
from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import require
from nonsmooth.generator import evaluate
from nonsmooth.models import x, y
from nonsmooth.poisson import EVEN, ODD, Direct, Split

MARGIN = 0.15  # of the box, to see whether it matters
_SHIFTS = (12.0, 5.0, 30.0, 2.0)  # in the order in which they are likely to be the best
_FITS = 4
_ACCURACY = 0.02  # residual of the iteration, relative to the tolerance, to begin with
_ITERATION = 0.1  # what a tenth of the residual may change, relative to the tolerance
SPARE = 10.0  # the density outside the box is exp(-SPARE) smaller than the tolerance
_NORMAL_TAIL = 3.29  # standard deviations outside which a normal variable has the mass _TAIL
_TAIL = 1e-3  # mass outside a box, from which the box of the wanted depth is extrapolated
# levels by the number of variables: of the grids for box and shift, of the coarsest for gamma^2
_FITTED, _COARSE = {2: 2, 3: 1, 4: 0}, {2: 2, 3: 1, 4: 1}
_STIFF = {True: 1e12, False: 1e7}  # n that stands for inf, for elastic walls and otherwise
_LONG = 100.0  # correlation time of a slow scene, relative to that of its damping
_LARGEST = {2: 120_000, 3: 600_000, 4: 2_500_000}  # grid points
_WORK = 8  # largest grids that may be spent on one value


@dataclass(frozen=True)
class Grid:
    """Resolution of a scene's state.

    Attributes
    ----------
    ends : dict
        Half widths of the box.
    levels : dict
        Resolution level of each variable.
    margin : float
        Elements outside the box, see `mesh.axes`.
    shift : float
        Of `poisson.Split`.
    """

    ends: dict
    levels: dict
    margin: float = 0.0
    shift: float = 8.0

    def raised(self, symbol, by=1):
        """Return the grid with one variable resolved better."""
        return replace(self, levels=self.levels | {symbol: self.levels[symbol] + by})


def solver(scene, grid):
    """Discretise a scene; returns the axes and the solver of its Poisson equation."""
    axes = mesh.axes(scene, grid.ends, grid.levels, grid.margin)
    nodes = math.prod(len(axis.nodes) for axis in axes.values())
    mirrored = scene.is_odd() and nodes % 2 == 0  # no node is its own mirror image
    if len(axes) <= 2:
        return axes, Direct(scene, axes, mirrored)
    return axes, Split(scene, axes, mirrored, grid.shift)


def growth_rate(scene, grid, accuracy):
    """gamma^2 = 2 E[g u] on one grid, u the Poisson solution of g (Theorem thm3)."""
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    u, mean = solve.solve(g, ODD, accuracy)
    _, half = solve.solve((g - mean) * u, EVEN, accuracy)
    return 2 * half


def correlation_time(scene, grid, growth, accuracy):
    """Integral over time of the correlation of g, gamma^2 / (2 Var g), given gamma^2 = growth."""
    axes, solve = solver(scene, grid)
    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    _, mean = solve.solve(g, ODD, accuracy)
    _, variance = solve.solve((g - mean) ** 2, EVEN, accuracy)
    return growth / (2 * variance)


def fitted(scene, depth, level):
    """Choose the box and the shift on coarse grids.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    depth : float
        Outside the box, the invariant density is of the order exp(-depth) of its maximum.
    level : int
        Of every variable.

    Returns
    -------
    Grid
    """
    grid = Grid(mesh.box(scene, depth), dict.fromkeys(mesh.variables(scene), level))
    for _ in range(_FITS):
        axes, solve = solver(scene, grid)
        masses = solve.stationary(1e-2).reshape([len(axis.nodes) for axis in axes.values()])
        found = {
            symbol: _extrapolated(
                axis.nodes,
                masses.sum(axis=tuple(k for k in range(len(axes)) if k != place)),
                depth,
            )
            for place, (symbol, axis) in enumerate(axes.items())
        }
        ends = mesh.narrowed(scene, grid.ends, found)
        change = max(abs(math.log(ends[symbol] / grid.ends[symbol])) for symbol in ends)
        grid = replace(grid, ends=ends)
        if change < 0.15:
            break
    return _with_best_shift(scene, grid) if len(grid.levels) > 2 else grid


def _extrapolated(nodes, masses, depth):
    """Half width for a depth, as if the tails beyond what coarse grids resolve were normal."""
    far = np.argsort(-np.abs(nodes))
    outside = np.cumsum(np.maximum(masses[far], 0.0))
    edge = np.interp(_TAIL, outside, np.abs(nodes[far]))
    return min(float(edge * math.sqrt(2 * depth) / _NORMAL_TAIL), 1.5 * nodes[-1])


def _with_best_shift(scene, grid):
    """Try which shift needs the fewest iterations."""
    count = {}
    for shift in _SHIFTS:
        axes, solve = solver(scene, replace(grid, shift=shift))
        solve.most = min(count.values(), default=solve.most)
        try:
            solve.solve(solve.fold(evaluate(scene.numerical_observable(), axes)), ODD, 1e-5)
        except ToleranceError:
            continue
        count[shift] = solve.iterations
    if not count:
        raise ToleranceError(
            "the iteration converges on no coarse grid, as in scenes that mix slowly; "
            "use Monte Carlo"
        )
    return replace(grid, shift=min(count, key=count.get))


def growth_to(scene, tol):
    """Compute gamma^2 to a relative tolerance.

    Parameters
    ----------
    scene : Scene
        n = inf is approached by a large n and the known rate of convergence.
    tol : float

    Returns
    -------
    value, error : float
        The error is what grids beyond those combined may add, see `Combination.error`; to it come
        the box, the residuals and n.

    Raises
    ------
    ToleranceError
        If the grid becomes too large; the message has the best value, its error and, where rare
        transitions make the equation ill-conditioned, their time scale.
    """
    if not math.isinf(scene.n):
        return _refined(scene, tol)[:2]
    # ASSUME: METHODS' empirical rates, n^(-1/2) where a wall is hit elastically, else 1/n
    elastic = scene.mechanics.in_potential
    stiff, softer = _STIFF[elastic], 1e-2 * _STIFF[elastic]
    value, error, below, accuracy = _refined(scene.with_n(stiff), tol / 2)
    fitted_below = replace(below, ends=mesh.narrowed(scene.with_n(softer), below.ends, below.ends))
    gap = growth_rate(scene.with_n(stiff), below, accuracy) - growth_rate(
        scene.with_n(softer), fitted_below, accuracy
    )
    rest = gap / ((10 if elastic else 100) - 1)
    value, error = value + rest, error + (0.2 if elastic else 1.0) * abs(rest)
    require(error <= tol * abs(value), value, error, tol)
    return value, error


def _refined(scene, tol):
    """gamma^2, its error, the dearest of the combined grids, and the residual."""
    count = len(scene.state)
    coarse = fitted(scene, math.log(1 / tol) + SPARE, _FITTED[count])
    coarse = raised(coarse, _COARSE[count] - _FITTED[count])
    base, accuracy, residual = _iterated(scene, coarse, tol)
    larger = growth_rate(scene, replace(coarse, margin=MARGIN), accuracy)
    directions = _directions(coarse)

    def grid(index):
        levels = {s: level for part, level in zip(directions, index, strict=True) for s in part}
        return replace(coarse, levels=levels)

    combination = Combination(
        tuple(coarse.levels[part[0]] for part in directions),
        base,
        lambda index: growth_rate(scene, grid(index), accuracy),
        lambda index: points(scene, grid(index)),
    )
    largest = _LARGEST[count]
    left = _WORK * largest
    while True:
        value = combination.value
        error = combination.error + 2 * abs(larger - base) + residual * abs(value)
        if error <= tol * abs(value):
            break
        try:
            cost = combination.refine(min(largest, left))
        except ToleranceError:  # a finer grid on which the iteration does not converge
            break
        left -= cost
        if not cost:
            break
    best = grid(combination.dearest())
    if error > tol * abs(value):
        time = abs(correlation_time(scene, best, value, accuracy))
        slow = time > _LONG * max(scene.damping, 1 / scene.damping)
        cure = f"the scene mixes slowly, g stays correlated for some {time:.0e}; loosen tol"
        require(False, value, error, tol, cure if slow else "loosen tol")
    return value, error, best, accuracy


def _directions(grid):
    """Group the variables that are refined together.

    Those of the oscillator are, beside noise of its own: transport mixes them, so that what they
    change together is no smaller than what one of them changes.
    """
    noise = [(symbol,) for symbol in grid.levels if symbol not in (y, x)]
    return [*noise, tuple(symbol for symbol in grid.levels if symbol in (y, x))]


def _iterated(scene, grid, tol):
    """gamma^2 on a grid, the residual that it needs, and what that leaves of relative error.

    The norm of a residual says little: it is largest where there is no mass, and may stagnate
    there.
    """
    accuracy = tol * _ACCURACY
    value = growth_rate(scene, grid, accuracy)
    if len(grid.levels) <= 2:
        return value, accuracy, accuracy
    while True:
        finer = growth_rate(scene, grid, accuracy / 10)
        change = abs(finer - value) / abs(finer)
        if change <= _ITERATION * tol:
            return value, accuracy, max(2 * change, accuracy)
        value, accuracy = finer, accuracy / 10


def raised(grid, by=1):
    """Return the grid with all variables resolved better."""
    for symbol in grid.levels:
        grid = grid.raised(symbol, by)
    return grid


def points(scene, grid):
    """Return the number of nodes of a grid."""
    axes = mesh.axes(scene, grid.ends, grid.levels)
    return math.prod(len(axis.nodes) for axis in axes.values())


def affordable(scene, grid):
    """Whether a grid is small enough to be solved on."""
    return points(scene, grid) <= _LARGEST[len(grid.levels)]
