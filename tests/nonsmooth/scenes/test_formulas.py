"""Formulas are read without eval: arithmetic passes, everything else is refused in one line."""

import numba
import numpy as np
import pytest

from nonsmooth.errors import ExpressionError
from nonsmooth.paths.kernels.compiled_formulas import compiled, evaluate
from nonsmooth.scenes.formulas import parse, vectorised
from nonsmooth.scenes.symbols import STATE_VARIABLES, x


@numba.njit
def call_on(address, out, state):
    """Evaluate a compiled formula over the columns of a state."""
    evaluate(address, out.ctypes, state.ctypes, state.shape[1], len(out))


def test_formula_means_what_python_means():
    """The parsed formula agrees with plain numpy, vectorised and compiled."""
    formula = parse("x**2/2 + 0.3*cos(3*x) - max(x, 0)", (x,))
    points = np.linspace(-2, 2, 9)
    expected = points**2 / 2 + 0.3 * np.cos(3 * points) - np.maximum(points, 0)
    assert np.allclose(vectorised(formula, (x,))(points), expected, rtol=1e-14)
    state, out = np.zeros((4, 9)), np.empty(9)
    state[3] = points
    address = compiled(formula, STATE_VARIABLES).address

    call_on(address, out, state)
    assert np.allclose(out, expected, rtol=1e-14)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')",
        "x.__class__",
        "(lambda: x)()",
        "[x, x]",
        "x < 1",
        "x = 2",
        "open('/etc/passwd')",
        "print(x)",
        "foo(x)",
        "y + x",
        "x +",
        "",
        "log(-1)",
        "1/0",
        "'x'",
    ],
)
def test_anything_but_arithmetic_is_refused(text):
    """The error is one line that quotes the formula."""
    with pytest.raises(ExpressionError) as error:
        parse(text, (x,))
    assert repr(text) in str(error.value)
    assert "\n" not in str(error.value)
