"""Elementary functions for loops that the compiler turns into vector instructions.

They are branch-free polynomials, good to about one unit in the last place, because a loop with
calls of the C library is not vectorised. The type of the number decides on the precision.
"""

from numba import types
from numba.extending import overload

from nonsmooth.paths.kernels import double_precision, single_precision


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


decay = _for_kernels("decay", "e^-x for x >= 0")
expm1 = _for_kernels("expm1", "e^x - 1 for x <= 0")
log = _for_kernels("log", "log x for x > 0")
log1p = _for_kernels("log1p", "log(1 + x) for x >= 0")
sincos = _for_kernels("sincos", "(sin x, cos x)")


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
