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
reduced = _for_kernels("reduced", "x less multiples of pi/2")
_short_sincos = _for_kernels("short_sincos", "(sin x, cos x)")
_short_arctan = _for_kernels("short_arctan", "arctan x")


def _negated(x, quadrant):
    raise TypeError("signs of quadrants are for kernels")


@overload(_negated)
def _choose_negated(x, quadrant):
    chosen = _precision(x).negated
    return lambda x, quadrant: chosen(x, quadrant)


@inlined
def sincos_in_quadrant(quadrant, angle):
    """Sine and cosine of quadrant * pi/2 + angle, for |angle| <= pi/4."""
    sine, cosine = _short_sincos(angle)
    odd = like(quadrant, quadrant & like(quadrant, 1)) != like(quadrant, 0)
    first = where(odd, cosine, sine)
    second = where(odd, sine, cosine)
    return _negated(first, quadrant), _negated(second, quadrant + like(quadrant, 1))


@inlined
def sincos(x):
    """Sine and cosine."""
    quadrant, angle = reduced(x)
    return sincos_in_quadrant(quadrant, angle)


@inlined
def arctan2(y, x):
    """Angle of (x, y) for y >= 0, in [0, pi]."""
    along, pi = abs(x), like(x, math.pi)
    low, high = minimum(along, y), maximum(maximum(along, y), like(x, 1e-37))
    steep = low > like(x, math.sqrt(2) - 1) * high
    # tan(angle - pi/4) is used where the angle is steep
    angle = _short_arctan(where(steep, low - high, low) / where(steep, low + high, high))
    angle = where(steep, angle + like(x, math.pi / 4), angle)
    angle = where(y > along, like(x, math.pi / 2) - angle, angle)
    return where(x < like(x, 0.0), pi - angle, angle)


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
