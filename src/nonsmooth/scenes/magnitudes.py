"""Formulas must be of a size that double precision can compute with."""

import itertools

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
    values = vectorised(expression, used)(*places)
    if np.any(np.isnan(values)):
        place = ", ".join(
            f"{symbol} = {value:g}"
            for symbol, value in zip(used, places[:, np.argmax(np.isnan(values))], strict=True)
        )
        raise ExpressionError(
            f"{name} = {quoted(text)} is not a number at {place}; choose a formula that is"
        )
    least, most = tuning.NEAR.sizes
    largest = np.max(np.abs(values[np.isfinite(values)]), initial=0.0)
    if largest > most or 0 < largest < least:
        raise ExpressionError(
            f"{name} = {quoted(text)} is of the size {largest:.0e} at states of the size 1; give "
            f"one between {least:g} and {most:g}"
        )
