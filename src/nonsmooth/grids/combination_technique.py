"""The dimension-adaptive combination technique for a functional that is computed on tensor grids.

Each variable has a level. The surplus of an index, one level for each variable, is what it adds to
all lower ones: the alternating sum over its neighbours below. Surpluses of indices high in several
variables are small, so that the sum over a set of indices of which none is high in all of them has
the accuracy of a grid that is. The set grows where much is missing for its cost.

Gerstner & Griebel, Computing 71 (2003) 65-87.
"""

import itertools
import math

_RELAPSE = 0.25  # of the surplus before the last, if the last is small by chance
_MIXED = 0.25  # of a surplus is left if another variable is raised too


class Combination:
    """A sum of surpluses over a downward closed set of indices.

    Parameters
    ----------
    lowest : tuple of int
        Level of each variable on the coarsest grid.
    coarsest : float
        The functional there.
    evaluate : callable
        Takes an index to the functional on its grid.
    cost : callable
        Takes an index to the cost of its grid.

    Attributes
    ----------
    value : float
        The functional.
    """

    def __init__(self, lowest, coarsest, evaluate, cost):
        self._lowest, self._evaluate, self._cost = lowest, evaluate, cost
        self._values, self._surplus = {}, {}
        self.value, self._missing = 0.0, {}
        self._add(lowest, coarsest)

    def _add(self, index, functional):
        self._values[index] = functional
        below = itertools.product(*((0, 1) if self._parent(index, k) else (0,) for k in self._axes))
        self._surplus[index] = sum(
            (-1) ** sum(step) * self._values[tuple(i - s for i, s in zip(index, step, strict=True))]
            for step in below
        )
        self.value += self._surplus[index]
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
        """Bound a surplus by those of its parents, as if surpluses hardly decayed.

        A single one of them may be small by chance.
        """
        raised = [k for k in self._axes if index[k] > self._lowest[k]]
        bounds = []
        for k in raised:
            parent = self._parent(index, k)
            if parent == self._lowest:
                return math.inf
            bounds.append(abs(self._surplus[parent]))
            before = self._parent(parent, k)
            if before is not None and before != self._lowest:
                bounds.append(_RELAPSE * abs(self._surplus[before]))
        return max(bounds) * (1.0 if len(raised) == 1 else _MIXED)

    @property
    def error(self):
        """What the indices that are next to the set may add, and with them all beyond."""
        return sum(self._missing.values())

    def refine(self, most):
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
        best = max(within, key=lambda index: (self._missing[index] / costs[index], -costs[index]))
        self._add(best, self._evaluate(best))
        return costs[best]

    def dearest(self):
        """Return the index in the set whose grid costs most."""
        return max(self._values, key=self._cost)


def _moved(index, k, by):
    return (*index[:k], index[k] + by, *index[k + 1 :])
