"""Loops over formulas are vector instructions, and as accurate as numbers of the state allow."""

import re

import numba
import numpy as np
import pytest

from nonsmooth.paths.kernels.compiled_formulas import compiled, evaluate
from nonsmooth.paths.kernels.vector_math import ELEMENTARY
from nonsmooth.scenes.formulas import FUNCTIONS, parse, vectorised
from nonsmooth.scenes.symbols import STATE_VARIABLES, x


@pytest.mark.parametrize(("argument", "number"), [(x, "float"), (3 * x, "double")])
@pytest.mark.parametrize("name", ELEMENTARY)
def test_vectorised(name, argument, number):
    """There are no calls of the C library, which take several times as long."""
    code = compiled(FUNCTIONS[name](argument), STATE_VARIABLES, "float32").inspect_llvm()
    assert re.search(rf"fmul <\d+ x {number}>", code)
    assert not re.search(rf"call [^\n]*@(llvm\.)?{name}f?\b", code)


@numba.njit
def call_on(address, out, state):
    """Evaluate a compiled formula over the columns of a state."""
    evaluate(address, out.ctypes, state.ctypes, state.shape[1], len(out))


@pytest.mark.parametrize(
    "formula",
    [
        "log(1 + exp(100*x))/100",
        "log(cosh(100*x))/100",
        "-log(exp(-100*x) + exp(-100*x**2))/100",
        "x**2 + 0.3*log(x**2 + 1e-50)",
        "1e6*(exp(1e-6*x) - 1)",
        "x**2*cos(2) + sinh(3*x)/cosh(3*x)",
        "tanh(1e3*x) + atan(x/1e3)*1e3",
        "1/(1 + exp(100*x))",
    ],
)
def test_range_and_digits_of_formulas(formula):
    """Formulas and their slopes have the range of double precision, and the digits of the state."""
    points = np.append(np.linspace(-1.5, 2.5, 41), 7.05).astype("float32")
    state, out = np.zeros((4, 42), "float32"), np.empty(42, "float32")
    state[3] = points
    expression = parse(formula, (x,))
    for wanted in (expression, expression.diff(x)):
        call_on(compiled(wanted, STATE_VARIABLES, "float32").address, out, state)
        exact = vectorised(wanted, (x,))(points.astype(float))
        # a rounding of the result in single precision, and of sums of terms of its size
        assert np.allclose(out, exact, rtol=4 * np.finfo("float32").eps, atol=1e-6, equal_nan=True)
