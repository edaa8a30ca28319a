"""Formulas given as text: read without `eval`, kept symbolic, compiled when a kernel needs them."""

from functools import cache, lru_cache

import numba
import numpy as np
import sympy
from asteval import Interpreter
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

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


def parse(text, variables):
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


@cache  # without bound: kernels keep the addresses
def compiled(expression, variables, precision="float64"):
    """Compile an expression to a C function over the lanes of a panel.

    A pointer, rather than a jitted function, keeps the kernels' type independent of the
    formula: they are compiled once and cached on disk for every potential there will ever be.

    Parameters
    ----------
    expression : sympy.Expr
    variables : tuple of sympy.Symbol
        The rows of the panel's state, in order.
    precision : {"float64", "float32"}
        Type of the values; the formula itself is evaluated as written.

    Returns
    -------
    numba cfunc
        void(out, state, width, lanes): writes out[i] for each of the `lanes` columns of the
        state, whose rows are `width` long.
    """
    value = numba.njit(
        sympy.lambdify(variables, expression, modules="math", cse=True),
        error_model="numpy",
        forceinline=True,
    )
    rows = len(variables)

    def sweep(out, state, width, lanes):
        values = numba.carray(out, (lanes,))
        z = numba.carray(state, (rows, width))
        for i in range(lanes):
            values[i] = value(z[0, i], z[1, i], z[2, i], z[3, i])

    pointer = numba.types.CPointer(getattr(numba.types, precision))
    signature = numba.void(pointer, pointer, numba.int64, numba.int64)
    return numba.cfunc(signature, error_model="numpy")(sweep)


@intrinsic
def evaluate(typing, address, out, state, width, lanes):
    """Call the C function of a formula by its address, from within a kernel.

    `out` and `state` are arrays' `.ctypes`.
    """
    pointer = types.CPointer(out.dtype)
    signature = types.void(types.int64, pointer, pointer, types.int64, types.int64)

    def generate(context, builder, call, arguments):
        values = [
            context.cast(builder, argument, given, wanted)
            for argument, given, wanted in zip(
                arguments, (address, out, state, width, lanes), signature.args, strict=True
            )
        ]
        kind = ir.FunctionType(ir.VoidType(), [value.type for value in values[1:]])
        builder.call(builder.inttoptr(values[0], kind.as_pointer()), values[1:])
        return context.get_dummy_value()

    return types.void(address, out, state, width, lanes), generate


@lru_cache(maxsize=256)
def vectorised(expression, variables):
    """Compile an expression to a numpy function of arrays, one argument per variable."""
    function = sympy.lambdify(variables, expression, modules="numpy", cse=True)

    def evaluate(*values):
        shape = np.broadcast_shapes(*(np.shape(value) for value in values))
        return np.broadcast_to(np.asarray(function(*values), dtype=float), shape)

    return evaluate
