"""A functional of the invariant measure or of a Poisson solution, by the combination technique.

It finds out how finely each variable must be resolved. The error is what the grids beyond those
combined would add.
"""

import functools
import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from nonsmooth.errors import ToleranceError
from nonsmooth.grids import tuning as grid_tuning
from nonsmooth.grids.combination_technique import Combination
from nonsmooth.grids.mesh.box import narrowed
from nonsmooth.grids.mesh.box_effect import BoxEffect
from nonsmooth.grids.tensor_grid import Grid, depth_for, fitted, points
from nonsmooth.progress import counter
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import x, y
from nonsmooth.statistics import tuning


@dataclass(frozen=True)
class Combined:
    """A functional on combined grids.

    Attributes
    ----------
    value, error : float
    scene : Scene
        With the n that was solved with.
    grid : Grid
        The costliest of those combined.
    there : float
        The functional on this grid alone.
    accuracy : float
        Residual of the solvers.
    """

    value: float
    error: float
    scene: Scene
    grid: Grid
    there: float
    accuracy: float


def combined(
    scene: Scene,
    tol: float,
    functional: Callable[[Scene, Grid], Callable[[float], float]],
    allowed: Callable[[float, float], float],
    floor: Callable[[Scene, Grid, float], float] = lambda scene, grid, accuracy: 0.0,
    first: Mapping[int, int] = tuning.GAMMA2_ON_GRIDS.coarse,
) -> Combined:
    """Compute a functional to a tolerance, if that is affordable.

    Parameters
    ----------
    scene : Scene
        With two to four state variables. n = inf is approached by a large n and the known rate of
        convergence.
    tol : float
    functional : callable
        Takes a scene with a finite n and a grid; returns what takes the residual of the solver and
        returns a value. It may go on from what it has found with a larger residual.
    allowed : callable
        Takes a value and a tolerance; returns the error that it may have.
    floor : callable, optional
        Takes a scene, a grid and a residual; returns the error that cancelling terms leave. A value
        below its error is not refined further once that is below the floor.
    first : mapping, optional
        Level of the first grid, by the number of variables.

    Returns
    -------
    Combined
        The error is what grids beyond those combined may add (`Combination.error`), plus the
        effects of the finite box, of the residuals and of a finite n. It may be above what is
        allowed, and is infinite if the limit n = inf was not reached from the large n.

    Raises
    ------
    ToleranceError
        If the equations of the coarsest grid cannot be solved.
    """
    if not math.isinf(scene.n):
        return _combined(scene, tol, functional, allowed, floor, first)
    stiff, arguments = with_finite_n(scene), (tol, functional, allowed, floor, first)
    try:
        return _extrapolated(stiff, *arguments)
    except ToleranceError:  # the iteration may converge for a smaller n
        return _extrapolated(_softer(stiff), *arguments)


def with_finite_n(scene: Scene) -> Scene:
    """Return the scene, with a large n in the place of inf."""
    if not math.isinf(scene.n):
        return scene
    chosen = tuning.GAMMA2_ON_GRIDS
    return scene.with_n(chosen.stiff_elastic if scene.mechanics.in_potential else chosen.stiff)


def _softer(scene):
    return scene.with_n(tuning.GAMMA2_ON_GRIDS.softer * scene.n)


def _extrapolated(stiff, tol, functional, allowed, floor, first):
    """Extrapolate the functional to n = inf from a large n and one that is smaller."""
    # the rates of convergence are n^(-1/2) where a wall is hit elastically, else 1/n
    elastic, softer = stiff.mechanics.in_potential, _softer(stiff)
    found = _combined(stiff, tol / 2, functional, allowed, floor, first)
    fitted_below = replace(found.grid, ends=narrowed(softer, found.grid.ends, found.grid.ends))
    try:
        gap = found.there - functional(softer, fitted_below)(found.accuracy)
    except ToleranceError:  # how far the limit is from the value for the large n remains unknown
        return replace(found, error=math.inf)
    rest = gap / ((10 if elastic else 100) - 1)
    error = found.error + (0.2 if elastic else 1.0) * abs(rest)
    return replace(found, value=found.value + rest, error=error)


def _combined(scene, tol, functional, allowed, floor, first):
    """Compute the functional for a finite n."""
    chosen, count = tuning.GAMMA2_ON_GRIDS, scene.dimension
    coarse = fitted(scene, depth_for(tol), chosen.fitted[count])
    coarse = coarse.all_raised(first[count] - chosen.fitted[count])
    on = functools.partial(functional, scene)
    base, accuracy, residual = _on_coarsest(coarse, tol, on, allowed)
    directions = _directions(coarse)

    def grid(index):
        levels = {s: level for part, level in zip(directions, index, strict=True) for s in part}
        return replace(coarse, levels=levels)

    largest = grid_tuning.TENSOR_GRIDS.largest[count]
    box = _box_effect(coarse, base, lambda grid: on(grid)(accuracy))
    finest = _finest(scene, coarse, chosen.boxed * largest)

    def error(combination):
        value = combination.value
        own = combination.error + residual * abs(allowed(value, 1.0))
        most = allowed(value, tol)
        # a finer grid for the box is of use only where its effect alone is too large
        return own + box.below(
            0,
            finest if own <= most else 0,
            lambda effect: effect <= max(most - own, chosen.others * most),
        )

    combination = Combination(
        tuple(coarse.levels[part[0]] for part in directions),
        base,
        lambda index: on(grid(index))(accuracy),
        lambda index: points(scene, grid(index)),
    )

    least = functools.cache(lambda: floor(scene, coarse, accuracy))

    def enough(combination):
        value, bound = combination.value, error(combination)
        return bound <= allowed(value, tol) or (value <= bound < math.inf and bound <= least())

    def no_digit(combination):
        return error(combination) > abs(allowed(combination.value, 1.0))

    def vain(combination):
        return combination.error <= chosen.others * allowed(combination.value, tol)

    value, bound, (index, there) = _enlarge(
        combination, error, enough, no_digit, vain, largest, 1 + len(directions)
    )
    return Combined(value, bound, scene, grid(index), there, accuracy)


def _box_effect(coarse, base, on):
    """Return what a larger box changes on the coarsest grid, whose value is `base`, or a finer."""

    def change(more):
        finer = coarse.all_raised(more)
        try:
            return 2 * abs(on(finer.enlarged()) - (on(finer) if more else base))
        except ToleranceError:  # the iteration may not converge on finer grids
            if more:
                return math.inf
            raise

    return BoxEffect(change, float)


def _finest(scene, coarse, largest):
    """Return by how many levels all variables can be raised within a number of grid points."""
    more = 0
    while points(scene, coarse.all_raised(more + 1)) <= largest:
        more += 1
    return more


def _enlarge(combination, error, enough, no_digit, vain, largest, patience):
    """Add grids to a combination until it is enough, or there is no hope of that.

    There is none if nothing affordable is left, or what is in the way is not the grid, or no digit
    is right and refining every variable has not made the error smaller.

    Return value, error and `Combination.dearest` when it was enough, or else when the error was
    least: on very fine grids rounding may grow.
    """

    def state():
        return combination.value, error(combination), combination.dearest()

    best, stalled = state(), 0
    left = tuning.GAMMA2_ON_GRIDS.work * largest
    with counter("grids") as advance:
        while not (enough(combination) or vain(combination)):
            try:
                cost = combination.refine(min(largest, left))
            except ToleranceError:  # a finer grid on which the iteration does not converge
                return best
            left -= cost
            reached = state()
            better = reached[1] < best[1]
            best, stalled = (reached, 0) if better else (best, stalled + 1)
            if not cost or (stalled >= patience and no_digit(combination)):
                return best
            advance(1)
    return state()


def _directions(grid):
    """Group the variables that are refined together.

    Displacement and velocity are. The motion mixes them: what refining both changes beyond the sum
    of the changes by either is not small, as the combination technique needs it to be. The
    variables of the noise are refined one by one.
    """
    noise = [(symbol,) for symbol in grid.levels if symbol not in (y, x)]
    return [*noise, tuple(symbol for symbol in grid.levels if symbol in (y, x))]


def _on_coarsest(grid, tol, on, allowed):
    """Return the functional on a grid, the residual it needs, and the error this leaves.

    That error is relative to what is allowed for a tolerance of 1. The norm of a residual says
    little about the error: the residual is largest where the invariant measure has hardly any mass,
    and may stagnate there. So it is reduced until the functional no longer changes. One iteration
    may gain more than a digit of it, and then the same iterate meets two residuals. Therefore a
    hundredth of a residual is looked at, besides a tenth.
    """
    chosen = tuning.GAMMA2_ON_GRIDS
    accuracy, there = tol * chosen.residual, on(grid)
    if len(grid.levels) <= 2:
        return there(accuracy), accuracy, accuracy

    def change(found):
        if len(found) < 3:
            return math.inf
        before, *later = (value for value, _ in found[-3:])
        apart = max(abs(value - before) for value in later)
        return apart / max(abs(allowed(before, 1.0)), sys.float_info.min)

    refined = until_agreement(
        _tenths(accuracy),
        lambda accuracy: (there(accuracy), accuracy),
        change,
        met=lambda _, change: change <= chosen.iteration * tol,
    )
    if len(refined.solutions) < 3:
        raise ToleranceError(
            f"the iteration on the coarsest grid ends at a residual of "
            f"{refined.solutions[-1][1]:.0e}, too large to tell its error; loosen tol"
        )
    # smaller residuals changed so little that the one before is good enough
    value, accuracy = refined.solutions[-3]
    return value, accuracy, max(2 * refined.error, accuracy)


def _tenths(number: float) -> Iterator[float]:
    while True:
        yield number
        number = number / 10
