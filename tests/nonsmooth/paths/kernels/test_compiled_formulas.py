"""Loops over formulas are vector instructions."""

import re

import pytest

from nonsmooth.paths.kernels.compiled_formulas import compiled
from nonsmooth.paths.kernels.single_precision import ELEMENTARY
from nonsmooth.scenes.formulas import FUNCTIONS
from nonsmooth.scenes.symbols import STATE_VARIABLES, x


@pytest.mark.parametrize("name", ELEMENTARY)
def test_vectorised(name):
    """In single precision there are no calls of the C library, which take several times as long."""
    code = compiled(FUNCTIONS[name](3 * x), STATE_VARIABLES, "float32").inspect_llvm()
    assert re.search(r"<\d+ x float>", code)
    assert not re.search(rf"call [^\n]*@(llvm\.)?{name}f?\b", code)
