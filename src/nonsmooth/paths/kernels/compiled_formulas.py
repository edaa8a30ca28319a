"""Formulas compiled to C functions that kernels call by their addresses."""

from functools import cache
from typing import Any

import numba
import sympy
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from nonsmooth.paths.kernels.vector_math import ELEMENTARY
from nonsmooth.scenes.formulas import compilable


@cache  # without a limit: a dropped function would leave kernels with an invalid address
def compiled(
    expression: sympy.Expr, variables: tuple[sympy.Symbol, ...], precision: str = "float64"
) -> Any:
    """Compile an expression to a C function over the lanes of a panel (see `kernels.panel`).

    Kernels are given its address, an integer. Their types do not depend on the formula then, so
    that they are compiled once for all formulas and cached on disk.

    Parameters
    ----------
    expression : sympy.Expr
    variables : tuple of sympy.Symbol
        The rows of the panel's state, in order.
    precision : {"float64", "float32"}
        Type of the values.

    Returns
    -------
    numba cfunc
        void(out, state, width, lanes): writes out[i] for each of the `lanes` columns of the
        state, whose rows are `width` long.
    """
    value = numba.njit(
        sympy.lambdify(variables, compilable(expression), modules=[ELEMENTARY, "math"], cse=True),
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
