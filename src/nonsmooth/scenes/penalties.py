"""The non-smooth convex functions of the paper and their Moreau-Yosida regularisations.

Both functions, |y| and the indicator chi_K of K = [-1, 1], are even. The derivative of their
regularisation is odd and piecewise linear: its slope is `inner` up to `knot` and `outer` beyond.
These three quantities, functions of n, define a penalty. The regularised potential, its derivative
(the penalty force), the exact flows of the simulation, the meshes of the solvers on grids and the
typeset tables are all derived from them.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import sympy

n = sympy.Symbol("n", positive=True)


@dataclass(frozen=True)
class Penalty:
    """Moreau-Yosida regularisation of an even convex function of one variable.

    Attributes
    ----------
    name : str
        LaTeX name of the regularised potential.
    limit : str
        LaTeX of the convex function itself, with ``%s`` for its argument.
    knot, inner, outer : sympy.Expr
        Position of the kink and slopes of the penalty force, functions of `n`.
    """

    name: str
    limit: str
    knot: sympy.Expr
    inner: sympy.Expr
    outer: sympy.Expr

    def potential(self, z: sympy.Symbol) -> sympy.Expr:
        """Return the regularised potential phi_n(z), a sympy expression."""
        beyond = sympy.Abs(z) - self.knot
        linear = sympy.expand(self.inner * self.knot**2 / 2 + self.inner * self.knot * beyond)
        return sympy.Piecewise(
            (self.inner * z**2 / 2, sympy.Abs(z) <= self.knot),
            (linear + self.outer * beyond**2 / 2, True),
        )

    def force(self, z: sympy.Symbol) -> sympy.Expr:
        """Return phi_n'(z), a sympy expression."""
        tail = self.inner * self.knot + self.outer * (sympy.Abs(z) - self.knot)
        return sympy.Piecewise(
            (self.inner * z, sympy.Abs(z) <= self.knot), (sympy.sign(z) * tail, True)
        )

    def potential_at(self, z: sympy.Symbol, stiffness: float) -> sympy.Expr:
        """Return phi_n(z) for n = `stiffness`, which may be inf if its limit is finite."""
        if stiffness < float("inf"):
            return self.potential(z).subs(n, sympy.Float(stiffness))
        knot, force, outer = (
            sympy.limit(f, n, sympy.oo) for f in (self.knot, self.inner * self.knot, self.outer)
        )
        if knot == 0:
            return force * sympy.Abs(z) + outer * z**2 / 2
        return replace(self, knot=knot, inner=force / knot, outer=outer).potential(z)

    def at(self, stiffness: float) -> tuple[float, float, float]:
        """Return (knot, inner, outer) as floats for n = `stiffness`, which may be inf."""
        return _at(self, float(stiffness))


ABSOLUTE_VALUE = Penalty(
    name="a_n", limit=r"\left|%s\right|", knot=1 / n, inner=n, outer=sympy.Integer(0)
)
BARRIER = Penalty(
    name=r"\chi_n", limit=r"\chi_K(%s)", knot=sympy.Integer(1), inner=sympy.Integer(0), outer=n
)


@lru_cache(maxsize=1024)
def _at(penalty, stiffness):
    value = sympy.oo if stiffness == float("inf") else stiffness
    return tuple(
        float(sympy.limit(quantity, n, value))
        for quantity in (penalty.knot, penalty.inner, penalty.outer)
    )
