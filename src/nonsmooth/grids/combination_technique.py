"""The dimension-adaptive combination technique for a functional that is computed on tensor grids.

Each variable has a level; an index is a tuple of levels, one for each variable. The surplus of an
index is what its grid adds to all coarser grids: the alternating sum over the neighbours below.
Surpluses are small where several variables are fine at once. A sum over grids, each of them
fine in a few variables only, is therefore as accurate as a single grid that is fine in all of them,
and much cheaper. The set of indices grows where most accuracy is gained for the cost.

Gerstner & Griebel, Computing 71 (2003) 65-87.
"""

import itertools
import math
from collections.abc import Callable

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.grids import tuning
from nonsmooth.progress import counter
from nonsmooth.refine import further_terms

Index = tuple[int, ...]
# one number, or several that share a tolerance
Functional = float | np.ndarray


def combined(
    lowest: Index,
    evaluate: Callable[[Index], Functional],
    cost: Callable[[Index], float],
    met: Callable[[Functional, Functional], bool],
    work: float,
    mixed: float,
    alone: float = 1.0,
) -> tuple[Functional, Functional, bool]:
    """Add grids to a combination until its error is small enough.

    Parameters
    ----------
    lowest : tuple of int
        Level of each variable on the coarsest grid.
    evaluate : callable
        Takes an index to the functional on its grid. If it raises a `ToleranceError` on another
        grid than the coarsest, that grid and all above it are left out.
    cost : callable
        Takes an index to the cost of its grid; above 1 it is too large.
    met : callable
        Takes a value and its error; returns whether the error is small enough.
    work : float
        Cost of all grids together, at most.
    mixed, alone : float
        As for `Combination`.

    Returns
    -------
    value, error : float or numpy.ndarray
    complete : bool
        Whether no grid had to be left out because of a `ToleranceError`.
    """
    failed = set()

    def evaluated(index):
        try:
            return evaluate(index)
        except ToleranceError:
            failed.add(index)
            raise

    combination = Combination(
        lowest,
        evaluate(lowest),
        evaluated,
        lambda index: math.inf if index in failed else cost(index),
        mixed,
        alone,
    )
    with counter("grids") as advance:
        while not met(combination.value, combination.error):
            try:
                spent = combination.refine(min(work, 1.0))
            except ToleranceError:
                continue
            if not spent:
                break
            work -= spent
            advance(1)
    return combination.value, combination.error, not failed


class Combination:
    """A sum of surpluses over a downward closed set of indices.

    Parameters
    ----------
    lowest : tuple of int
        Level of each variable on the coarsest grid.
    coarsest : float or numpy.ndarray
        The functional there.
    evaluate : callable
        Takes an index to the functional on its grid.
    cost : callable
        Takes an index to the cost of its grid.
    mixed : float, optional
        By how much surpluses are expected to be smaller than those of their parents where two or
        more variables are raised.
    alone : float, optional
        How many times the first surplus of a variable counts, as long as no other tells how they
        fall; it may be small by chance.

    Attributes
    ----------
    value : float or numpy.ndarray
        The functional.
    """

    def __init__(
        self,
        lowest: Index,
        coarsest: Functional,
        evaluate: Callable[[Index], Functional],
        cost: Callable[[Index], float],
        mixed: float = tuning.COMBINATION_TECHNIQUE.mixed,
        alone: float = 1.0,
    ):
        self._lowest, self._evaluate, self._cost = lowest, evaluate, cost
        self._mixed, self._alone = mixed, alone
        self._values: dict[Index, Functional] = {}
        self._surplus: dict[Index, Functional] = {}
        self._missing: dict[Index, Functional] = {}
        self.value: Functional = 0.0
        self._add(lowest, coarsest)

    def _add(self, index, functional):
        self._values[index] = functional
        below = itertools.product(*((0, 1) if self._parent(index, k) else (0,) for k in self._axes))
        self._surplus[index] = sum(
            (-1) ** sum(step) * self._values[tuple(i - s for i, s in zip(index, step, strict=True))]
            for step in below
        )
        self.value = self.value + self._surplus[index]
        self._missing.pop(index, None)
        for k in self._axes:
            above = _moved(index, k, 1)
            parents = [p for p in (self._parent(above, j) for j in self._axes) if p]
            if all(parent in self._values for parent in parents):
                self._missing[above] = self._expected(above)

    @property
    def _axes(self):
        return range(len(self._lowest))

    def _parent(self, index, k):
        return _moved(index, k, -1) if index[k] > self._lowest[k] else None

    def _expected(self, index):
        """Estimate a surplus by those of its parents, on the safe side: as if they hardly decayed.

        A parent's surplus may be small by chance, so that the one before it counts as well. Where
        one variable is raised alone, and surpluses shrink more slowly than to a half, those of all
        finer grids are added.
        """
        raised = [k for k in self._axes if index[k] > self._lowest[k]]
        bounds = []
        for k in raised:
            parent = self._parent(index, k)
            if parent == self._lowest:
                return math.inf
            surplus = self._surplus[parent]
            before = self._parent(parent, k)
            if before is None or before == self._lowest:
                bounds.append(abs(surplus) * (1.0 if len(raised) > 1 else self._alone))
                continue
            earlier = self._surplus[before]
            bounds.append(tuning.COMBINATION_TECHNIQUE.relapse * abs(earlier))
            bounds.append(abs(surplus) if len(raised) > 1 else _rest(earlier, surplus))
        return np.max(bounds, axis=0) * (1.0 if len(raised) == 1 else self._mixed)

    @property
    def error(self) -> Functional:
        """Estimated sum of the surpluses of all indices outside the set, by those next to it."""
        return sum(self._missing.values())

    def refine(self, most: float) -> float:
        """Add the index that is expected to add most for its cost, unless it costs too much.

        Returns
        -------
        cost : float
            0 if there is no index whose cost is at most `most`.
        """
        costs = {index: self._cost(index) for index in self._missing}
        within = [index for index in costs if costs[index] <= most]
        if not within:
            return 0.0
        best = max(
            within, key=lambda index: (np.max(self._missing[index]) / costs[index], -costs[index])
        )
        self._add(best, self._evaluate(best))
        return costs[best]

    def dearest(self) -> tuple[Index, Functional]:
        """Return the index in the set with the most expensive grid, and the functional there."""
        index = max(self._values, key=self._cost)
        return index, self._values[index]


def _rest(earlier, last):
    """Estimate the sum of all surpluses after two of them."""
    shrinking = np.abs(earlier) > np.abs(last)
    ratio = np.where(shrinking, last, 1.0) / np.where(shrinking, earlier, 1.0)
    return np.abs(last) * further_terms(ratio)


def _moved(index, k, by):
    return (*index[:k], index[k] + by, *index[k + 1 :])
