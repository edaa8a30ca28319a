"""Formulas given as text: read without `eval`, kept symbolic, evaluated on arrays."""

from collections.abc import Callable, Iterable
from functools import lru_cache

import numpy as np
import sympy
from asteval import Interpreter

from nonsmooth.errors import ExpressionError

FUNCTIONS = {
    "abs": sympy.Abs,
    "atan": sympy.atan,
    "cos": sympy.cos,
    "cosh": sympy.cosh,
    "exp": sympy.exp,
    "log": sympy.log,
    "max": sympy.Max,
    "min": sympy.Min,
    "sign": sympy.sign,
    "sin": sympy.sin,
    "sinh": sympy.sinh,
    "sqrt": sympy.sqrt,
    "tanh": sympy.tanh,
}
_ARITHMETIC_ONLY = dict.fromkeys(
    [
        "assign",
        "attribute",
        "augassign",
        "boolop",
        "compare",
        "delete",
        "dict",
        "dictcomp",
        "for",
        "formattedvalue",
        "functiondef",
        "if",
        "ifexp",
        "import",
        "importfrom",
        "joinedstr",
        "lambda",
        "list",
        "listcomp",
        "print",
        "raise",
        "set",
        "setcomp",
        "slice",
        "subscript",
        "try",
        "tuple",
        "while",
        "with",
    ],
    False,
)


def parse(text: str, variables: Iterable[sympy.Symbol]) -> sympy.Expr:
    """Read a formula.

    Parameters
    ----------
    text : str
        Python arithmetic with the functions of `FUNCTIONS` and the constant ``pi``,
        for example ``"x**2/2 + 0.3*cos(x)"``.
    variables : iterable of sympy.Symbol
        The variables the formula may contain.

    Returns
    -------
    sympy.Expr

    Raises
    ------
    ExpressionError
        If the text is not arithmetic, or uses a name outside the white list.
    """
    names = {symbol.name: symbol for symbol in variables}
    interpreter = Interpreter(
        symtable={"pi": sympy.pi} | FUNCTIONS | names, use_numpy=False, config=_ARITHMETIC_ONLY
    )
    del interpreter.symtable["print"]
    try:
        value = interpreter.eval(text, raise_errors=True, show_errors=False)
    except Exception as error:  # asteval re-raises whatever the formula provoked
        reason = " ".join(str(error).split()) or type(error).__name__
        raise ExpressionError(
            f"cannot read the formula {text!r} ({reason}); use the variables "
            f"{', '.join(sorted(names))} and the functions {', '.join(FUNCTIONS)}"
        ) from None
    # sympify evaluates strings, so it must never see one
    expression = sympy.sympify(value) if isinstance(value, int | float | sympy.Expr) else None
    infinite = (sympy.zoo, sympy.nan, sympy.oo, -sympy.oo)
    if (
        not isinstance(expression, sympy.Expr)
        or expression.is_extended_real is False
        or expression.has(*infinite)
    ):
        raise ExpressionError(f"the formula {text!r} is not a real expression; write arithmetic")
    return expression


@lru_cache(maxsize=256)
def vectorised(
    expression: sympy.Expr, variables: tuple[sympy.Symbol, ...]
) -> Callable[..., np.ndarray]:
    """Compile an expression to a numpy function of arrays, one argument per variable."""
    function = sympy.lambdify(variables, expression, modules="numpy", cse=True)

    def evaluate(*values):
        shape = np.broadcast_shapes(*(np.shape(value) for value in values))
        return np.broadcast_to(np.asarray(function(*values), dtype=float), shape)

    return evaluate
