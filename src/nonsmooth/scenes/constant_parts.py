"""The constant parts of a formula, which must be numbers that double precision can hold.

sympy computes with numbers of any size, exactly, and has complex ones and infinity. A formula is
evaluated in double precision in the end, so that what does not fit there is refused before sympy
takes it as an argument of the next operation: without this, a few characters ask for numbers with
more digits than there is memory.
"""

import math
from collections.abc import Callable

import sympy

from nonsmooth.errors import ExpressionError
from nonsmooth.scenes import tuning

_DOUBLE: dict[Callable, Callable[..., float]] = {
    sympy.Abs: abs,
    sympy.Add: lambda *terms: math.fsum(terms),
    sympy.Max: max,
    sympy.Min: min,
    sympy.Mul: lambda *factors: math.prod(factors),
    sympy.Pow: math.pow,
    sympy.atan: math.atan,
    sympy.cos: math.cos,
    sympy.cosh: math.cosh,
    sympy.exp: math.exp,
    sympy.log: math.log,
    sympy.sign: lambda value: (value > 0) - (value < 0),
    sympy.sin: math.sin,
    sympy.sinh: math.sinh,
    sympy.sqrt: math.sqrt,
    sympy.tanh: math.tanh,
}
_NOT_ZERO = (sympy.Mul, sympy.Pow, sympy.exp)  # their values are not 0 if no argument is
_MAY_BE_COMPLEX = (sympy.Pow, sympy.log)  # at real arguments
_INFINITE = (sympy.zoo, sympy.nan, sympy.oo, -sympy.oo)
NOT_REAL = "it is not real; write arithmetic of real numbers"


def in_range(value: float) -> float:
    """Return a number, having checked that it is 0 or of a size that double precision can hold.

    Raises
    ------
    ExpressionError
        If it is not.
    """
    limits = tuning.FORMULA
    if value != 0 and not limits.smallest <= abs(value) <= limits.largest:
        raise ExpressionError(
            f"a number in it is not between {limits.smallest:g} and {limits.largest:g} in size; "
            "choose other units"
        )
    return value


def require_small_numbers(exponent: sympy.Expr, base: sympy.Expr | None = None) -> None:
    """Check that no number in an exponent is so large that powers explode.

    Raises
    ------
    ExpressionError
        If one is.
    """
    sums = base is not None and base.has(sympy.Add)
    largest = tuning.FORMULA.exponent_of_sums if sums else tuning.FORMULA.exponent
    for number in exponent.atoms(sympy.Number):
        size = max(abs(number.p), number.q) if number.is_Rational else abs(number)
        if not size <= largest:
            raise ExpressionError(f"an exponent is beyond {largest}; use smaller powers")


class ConstantParts:
    """Values of the constant parts of expressions, each computed once.

    Expressions are checked as they are put together, each before it becomes part of another one.
    """

    def __init__(self) -> None:
        self._known: dict[sympy.Expr, float | None] = {}

    def value(self, expression: sympy.Expr) -> float | None:
        """Evaluate an expression without variables, and check the constant parts of any other.

        Parameters
        ----------
        expression : sympy.Expr

        Returns
        -------
        float or None
            None if it contains variables.

        Raises
        ------
        ExpressionError
            If a part of it is not real or not finite, or if a number or an exponent is out of
            range.
        """
        if expression not in self._known:
            self._known[expression] = self._new_value(expression)
        return self._known[expression]

    def _new_value(self, expression):
        if expression.is_Symbol:
            return None
        if expression.is_Rational:
            return in_range(in_range(expression.p) * (1 / in_range(expression.q)))
        if expression.is_Float or expression.is_NumberSymbol:
            return _not_lost(float(expression), expression != 0)
        if expression in _INFINITE:
            raise ExpressionError("it is infinite everywhere; write arithmetic of real numbers")
        head = expression.func
        if head not in _DOUBLE or (
            head in _MAY_BE_COMPLEX and expression.is_extended_real is False
        ):
            raise ExpressionError(NOT_REAL)
        if head is sympy.Pow:
            require_small_numbers(expression.exp, expression.base)
        values = [self.value(part) for part in expression.args]
        return None if None in values else evaluated(head, values)


def evaluated(head: Callable, values: list[float]) -> float:
    """Evaluate a function or operation of sympy at numbers of double precision.

    Raises
    ------
    ExpressionError
        If the value is not real or out of range.
    """
    try:
        value = float(_DOUBLE[head](*values))
    except OverflowError:
        value = math.inf
    except ValueError:
        raise ExpressionError(NOT_REAL) from None
    return _not_lost(value, head in _NOT_ZERO and 0 not in values)


def _not_lost(value, known_not_zero):
    """Refuse the value 0 of a number that is not 0."""
    return in_range(math.inf if value == 0 and known_not_zero else value)
