"""Whether a formula can be computed with: real, of a moderate size, without poles, resolvable.

For poles and oscillations a formula is looked at along straight lines, each with one variable
moving and the others fixed.
"""

import itertools
from collections.abc import Callable, Iterator
from functools import lru_cache

import numpy as np
import sympy

from nonsmooth.errors import ExpressionError, quoted
from nonsmooth.scenes import tuning
from nonsmooth.scenes.formulas import vectorised


def require_moderate(
    name: str, text: str, expression: sympy.Expr, variables: tuple[sympy.Symbol, ...]
) -> None:
    """Refuse a formula that is not a number, far too large or far too small at states near 0.

    Where it is infinite it is not examined: it may have a pole.

    Parameters
    ----------
    name, text : str
        What the formula is called, and the formula, for the message.
    expression : sympy.Expr
    variables : tuple of sympy.Symbol

    Raises
    ------
    ExpressionError
    """
    used = tuple(symbol for symbol in variables if symbol in expression.free_symbols)
    if not used:
        return
    places = np.array(list(itertools.product(tuning.NEAR.places, repeat=len(used)))).T
    f = vectorised(expression, used)
    values = f(*places)
    if np.any(np.isnan(values)):
        place = ", ".join(
            f"{symbol} = {value:g}"
            for symbol, value in zip(used, places[:, np.argmax(np.isnan(values))], strict=True)
        )
        raise ExpressionError(
            f"{name} = {quoted(text)} is not a number at {place}; choose a formula that is"
        )
    least, most = tuning.NEAR.sizes
    largest = _largest(values)
    if 0 < largest < least:  # a peak may be elsewhere
        end, count = tuning.REGULARITY.near, tuning.REGULARITY.points
        largest = _largest(f(*np.random.default_rng(0).uniform(-end, end, (len(used), count))))
    if largest > most or 0 < largest < least:
        raise ExpressionError(
            f"{name} = {quoted(text)} is of the size {largest:.0e} at states of the size 1; give "
            f"one between {least:g} and {most:g}"
        )


def _largest(values: np.ndarray) -> float:
    return float(np.max(np.abs(values[np.isfinite(values)]), initial=0.0))


@lru_cache(maxsize=256)
def fault(expression: sympy.Expr, wall: float = np.inf) -> str | None:
    """Say what is wrong with a formula, if anything is.

    Poles at which the square can be integrated, like that of log(abs(y)), are none.

    Parameters
    ----------
    expression : sympy.Expr
    wall : float
        Largest displacement that the scene can have, "1".

    Returns
    -------
    str or None
        What it does and where, to follow the formula in a sentence.
    """
    variables = tuple(sorted(expression.free_symbols, key=str))
    g = vectorised(expression, variables)
    singular = [vectorised(part, variables) for part in _denominators(expression)]
    with np.errstate(all="ignore"):
        for symbol, at in _lines(variables):
            end = wall if symbol.name == "x" else np.inf
            found = _fault_on_line(at, g, singular, end)
            if found:
                return found.format(name=symbol.name)
    return None


def _denominators(expression: sympy.Expr) -> list[sympy.Expr]:
    """Return the parts of a formula at whose zeros it may have a pole."""
    powers = [p.base for p in expression.atoms(sympy.Pow) if p.exp.could_extract_minus_sign()]
    logarithms = [log.args[0] for log in expression.atoms(sympy.log)]
    return [part for part in powers + logarithms if part.free_symbols]


def _lines(variables: tuple) -> Iterator[tuple[sympy.Symbol, Callable]]:
    """Yield a variable, and a function from its values to the values of all, for each line."""
    for k, symbol in enumerate(variables):
        for others in itertools.product(tuning.REGULARITY.others, repeat=len(variables) - 1):

            def at(value, k=k, others=others):
                fixed = [np.full_like(value, other) for other in others]
                return [*fixed[:k], value, *fixed[k:]]

            yield symbol, at


def _fault_on_line(at, g, singular, end):
    chosen = tuning.REGULARITY
    near = np.linspace(-min(chosen.near, end), min(chosen.near, end), chosen.points)
    missing = np.isnan(g(*at(near)))
    if np.any(missing[1:] & missing[:-1]):
        place = near[1:][missing[1:] & missing[:-1]]
        return f"is not a real number at {{name}} = {place[np.argmin(np.abs(place))]:.3g}"
    far = np.geomspace(chosen.near, chosen.far, chosen.points // 10)[1:]
    reach = np.concatenate([-far[::-1], near, far])
    reach = reach[np.abs(reach) <= end]
    for part in singular:
        for zero in _zeros(lambda value, part=part: part(*at(value)), reach):
            if _grows(lambda value: g(*at(value)), zero):
                return f"has a pole at {{name}} = {zero:.3g}"
    sweeps = _sweeps(lambda value: g(*at(value)), min(chosen.near, end))
    if sweeps > chosen.sweeps:
        return f"goes up and down some {sweeps:.0e} times along {{name}}"
    return None


def _zeros(f: Callable, reach: np.ndarray) -> np.ndarray:
    """Find where a function is zero, changes its sign or touches zero."""
    values = f(reach)
    exact = reach[values == 0]
    if len(exact) > len(reach) / 2:  # the line lies within the zeros, and other lines cross them
        return reach[:0]
    changes = np.flatnonzero(values[:-1] * values[1:] < 0)
    left, right = reach[changes], reach[changes + 1]
    for _ in range(tuning.REGULARITY.halvings):
        middle = (left + right) / 2
        same = np.sign(f(middle)) == np.sign(f(left))
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    size = np.abs(values)
    lowest = 1 + np.flatnonzero((size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]))
    low, high = reach[lowest - 1], reach[lowest + 1]
    for _ in range(tuning.REGULARITY.halvings):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        falls = np.abs(f(a)) > np.abs(f(b))
        low, high = np.where(falls, a, low), np.where(falls, high, b)
    touching = (low + high) / 2
    touching = touching[np.abs(f(touching)) <= tuning.REGULARITY.touching * np.nanmedian(size)]
    found = np.concatenate([exact, left, touching])
    return found[np.argsort(np.abs(found))]


def _grows(g: Callable, zero: float) -> bool:
    """Whether a function grows so fast towards a place that its square has no integral."""
    chosen = tuning.REGULARITY
    distances = np.array(chosen.distances)[:, None]
    size = np.abs(g(np.ravel(zero + distances * np.array([-1, 1])))).reshape(-1, 2)
    slope = -np.diff(np.log(size), axis=0) / np.diff(np.log(distances), axis=0)
    return bool(np.any(slope > chosen.steepest) or np.any(np.isposinf(size)))


def _sweeps(g: Callable, end: float) -> float:
    """Estimate how often a function goes through the range of its values."""
    chosen = tuning.REGULARITY
    place = end * np.random.default_rng(0).uniform(-1, 1, chosen.points)
    values, change = g(place), g(place + chosen.apart) - g(place)
    finite = np.isfinite(values) & np.isfinite(change)
    if not finite.any() or np.ptp(values[finite]) == 0:
        return 0.0
    share = np.abs(change[finite]) / np.ptp(values[finite])  # first, so that sums do not overflow
    return float(np.mean(share) / chosen.apart * 2 * end)
