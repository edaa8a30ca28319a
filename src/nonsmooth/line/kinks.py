"""Where a formula in y may have a kink, a jump or a pole, and where it vanishes.

Quadrature and discrete ordinates put the edges of their elements there.
"""

from collections.abc import Callable
from itertools import combinations

import numpy as np
import sympy
from numpy.typing import ArrayLike

from nonsmooth.line.gauss_elements import NODES
from nonsmooth.scenes import symbols


def switches(expression: sympy.Expr) -> list[sympy.Expr]:
    """List the expressions at whose sign changes a formula may have a kink, a jump or a pole.

    They are the arguments of absolute values, signs and logarithms, the differences between the
    arguments of minima, maxima and comparisons, and the bases of fractional or negative powers.
    """
    differences = [f.lhs - f.rhs for f in expression.atoms(sympy.core.relational.Relational)]
    for f in expression.atoms(sympy.Max, sympy.Min):
        differences += [a - b for a, b in combinations(f.args, 2)]
    differences += [f.args[0] for f in expression.atoms(sympy.Abs, sympy.sign, sympy.log)]
    differences += [f.base for f in expression.atoms(sympy.Pow) if not f.exp.is_nonnegative]
    return [f for f in dict.fromkeys(differences) if f.free_symbols == {symbols.y}]


def sign_changes(function: Callable, edges: np.ndarray) -> np.ndarray:
    """Find the sign changes of a function to the last digit, by bisection of all at once.

    Parameters
    ----------
    function : callable
        Of arrays.
    edges : numpy.ndarray, shape (k,)
        Increasing. The function is looked at there and at the Gauss points between; two sign
        changes between neighbours of these are not seen.

    Returns
    -------
    numpy.ndarray
        Zeros among the points, then sign changes, each group increasing.
    """
    half = np.diff(edges)[:, None] / 2
    points = np.sort(np.append(edges, edges[:-1, None] + half * (NODES + 1)))
    with np.errstate(all="ignore"):
        sign = np.sign(function(points))
        change = np.flatnonzero(sign[:-1] * sign[1:] < 0)
        low, high, before = points[change], points[change + 1], sign[change]
        while np.any((low < (middle := (low + high) / 2)) & (middle < high)):
            below = np.sign(function(middle)) == before
            low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.concatenate([points[sign == 0], high])


def isolated_zeros(g: Callable, places: ArrayLike, end: float) -> np.ndarray:
    """Return those of the places at which g vanishes, unless it vanishes on both sides, too.

    So places inside an interval on which g = 0 are left out; the ends of the interval remain.

    Parameters
    ----------
    g : callable
        Of arrays.
    places : array_like
        Candidates, as `sign_changes` returns them: exact up to rounding.
    end : float
        Half width of the axis, the scale on which "beside" is meant.
    """
    places = np.unique(places)
    beside = np.abs(g(places[:, None] + np.array([-1e-9, 1e-9]) * end))
    # A zero found by bisection is not exact, but g is not larger there than beside it. At a pole,
    # where g changes its sign too, it is.
    vanishes = np.abs(g(places)) <= np.max(beside, axis=1)
    return places[vanishes & np.any(beside > 0, axis=1)]
