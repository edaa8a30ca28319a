"""Elementary functions for loops that the compiler turns into vector instructions.

They are branch-free polynomials, good to about one unit in the last place, because a loop with
calls of the C library is not vectorised. The type of the number decides on the precision. Functions
for flows are only right in the range that is given; those of formulas (`ELEMENTARY`) are right for
all numbers, except for logarithms of numbers that are not normalised, below 1e-38 or 2e-308, and
for angles of which only the digits before the point are known, above 1e5 or 1e14.
"""

import math

import numpy as np
from numba import types
from numba.extending import overload

from nonsmooth.paths.kernels import double_precision, single_precision
from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.instructions import like, maximum, minimum, where


def _for_kernels(name, documentation):
    """Make a function of one number that runs in the precision of that."""

    def function(x):
        raise TypeError(f"{documentation} is for kernels; outside of them use numpy")

    @overload(function)
    def choose(x):
        chosen = getattr(_precision(x), name)
        return lambda x: chosen(x)

    return function


def _precision(number):
    return single_precision if number == types.float32 else double_precision


exp = _for_kernels("exp", "e^x")
decay = _for_kernels("decay", "e^-x for x >= 0")
expm1 = _for_kernels("expm1", "e^x - 1 for x <= 0")
log = _for_kernels("log", "log x for x > 0")
log1p = _for_kernels("log1p", "log(1 + x) for x >= 0")
sincos = _for_kernels("sincos", "(sin x, cos x)")
reduced = _for_kernels("reduced", "x less multiples of pi/2")


def arctan2(y, x):
    """Angle of the point (x, y) for y >= 0, in [0, pi]."""
    raise TypeError("arctan2 is for kernels; outside of them use numpy")


@overload(arctan2)
def _choose_arctan2(y, x):
    chosen = _precision(y).arctan2
    return lambda y, x: chosen(y, x)


def sincos_in_quadrant(quadrant, angle):
    """(sin, cos) of quadrant * pi/2 + angle, for |angle| <= pi/4."""
    raise TypeError("sincos_in_quadrant is for kernels; outside of them use numpy")


@overload(sincos_in_quadrant)
def _choose_sincos_in_quadrant(quadrant, angle):
    chosen = _precision(angle).sincos_in_quadrant
    return lambda quadrant, angle: chosen(quadrant, angle)


@inlined
def _any_log(x):
    found = where(x < like(x, np.inf), log(x), x)
    special = where(x == like(x, 0.0), like(x, -np.inf), like(x, np.nan))
    return where(x > like(x, 0.0), found, special)


@inlined
def _any_sincos(x):
    """Sine and cosine, numbers from -1 to 1 also where x has no digits after the point."""
    quadrant, angle = reduced(x)
    return sincos_in_quadrant(quadrant, minimum(maximum(angle, like(x, -0.8)), like(x, 0.8)))


@inlined
def _sin(x):
    return _any_sincos(x)[0]


@inlined
def _cos(x):
    return _any_sincos(x)[1]


@inlined
def _atan(x):
    size = arctan2(abs(x), like(x, 1.0))
    return where(x == x, math.copysign(size, x), x)


@inlined
def _tanh(x):
    less = expm1(like(x, -2.0) * abs(x))
    return math.copysign(less / (less + like(x, 2.0)), x)


@inlined
def _cosh(x):
    power = exp(abs(x))
    return like(x, 0.5) * (power + like(x, 1.0) / power)


@inlined
def _sinh(x):
    one, half, size = like(x, 1.0), like(x, 0.5), abs(x)
    power, less = exp(size), expm1(-minimum(size, one))
    small = half * less * (less + like(x, 2.0)) / (less + one)
    return math.copysign(where(size < one, small, half * (power - one / power)), x)


def _of_formulas(compiled):
    """Make a function of any number, also of an integer that a formula has."""

    def function(x):
        raise TypeError("functions of formulas are for kernels; outside of them use numpy")

    @overload(function)
    def choose(x):
        if isinstance(x, types.Float):
            return lambda x: compiled(x)
        return lambda x: compiled(float(x))

    return function


# What formulas may have, by the names that sympy prints.
ELEMENTARY = {
    "exp": _of_formulas(exp),
    "log": _of_formulas(_any_log),
    "sin": _of_formulas(_sin),
    "cos": _of_formulas(_cos),
    "atan": _of_formulas(_atan),
    "sinh": _of_formulas(_sinh),
    "cosh": _of_formulas(_cosh),
    "tanh": _of_formulas(_tanh),
}
