"""Elementary functions for loops that the compiler turns into vector instructions.

In single precision these are branch-free polynomials (S. L. Moshier's Cephes library, good to
about one unit in the last place), because a loop with calls of the C library is not
vectorised. In double precision they are the C library's own.
"""

import math

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, overload

from nonsmooth.paths.kernels.compilation import inlined

_U, _I, _F = np.uint32, np.int32, np.float32
_EXP = tuple(
    map(
        _F,
        (
            1.9875691500e-4,
            1.3981999507e-3,
            8.3334519073e-3,
            4.1665795894e-2,
            1.6666665459e-1,
            5.0000001201e-1,
        ),
    )
)
_LOG = tuple(
    map(
        _F,
        (
            7.0376836292e-2,
            -1.1514610310e-1,
            1.1676998740e-1,
            -1.2420140846e-1,
            1.4249322787e-1,
            -1.6668057665e-1,
            2.0000714765e-1,
            -2.4999993993e-1,
            3.3333331174e-1,
            -0.5,
        ),
    )
)
_SIN = tuple(map(_F, (-1.9515295891e-4, 8.3321608736e-3, -1.6666654611e-1)))
_COS = tuple(map(_F, (2.443315711809948e-5, -1.388731625493765e-3, 4.166664568298827e-2, -0.5)))
_ATAN = tuple(map(_F, (8.05374449538e-2, -1.38776856032e-1, 1.99777106478e-1, -3.33329491539e-1)))
_SQRT_HALF = _U(0x3F3504F3)  # the bits of sqrt(1/2)


@intrinsic
def like(typing, x, constant):
    """Convert a constant to the type of x, so that it does not widen the arithmetic."""

    def generate(context, builder, signature, arguments):
        return context.cast(builder, arguments[1], signature.args[1], signature.args[0])

    return x(x, constant), generate


@intrinsic
def fma(typing, x, y, z):
    """Return x*y + z, rounded once."""

    def generate(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return x(x, x, x), generate


@intrinsic
def where(typing, condition, x, y):
    """Return x where the condition holds, else y, having computed both."""

    def generate(context, builder, signature, arguments):
        return builder.select(*arguments)

    return x(types.boolean, x, x), generate


def _extremum(comparison, documentation):
    """Make a function of (x, y): y where `y comparison x` holds, else x; a single instruction."""

    @intrinsic
    def extremum(typing, x, y):
        def generate(context, builder, signature, arguments):
            first, second = arguments
            chosen = builder.fcmp_ordered(comparison, second, first)
            return builder.select(chosen, second, first)

        return x(x, x), generate

    extremum.__doc__ = documentation
    return extremum


maximum = _extremum(">", "The larger number; x if either is not a number.")
minimum = _extremum("<", "The smaller number; x if either is not a number.")


def _extreme_number(name, documentation):
    """Make a function of (x, y): the larger or smaller; if one is not a number, the other one.

    `maximum` and `minimum` give x if either is not a number. Unlike these, the function made here
    stays a single instruction also where its result replaces x in memory.
    """

    @intrinsic
    def extreme(typing, x, y):
        def generate(context, builder, signature, arguments):
            kind = arguments[0].type
            signature = ir.FunctionType(kind, [kind, kind])
            function = builder.module.declare_intrinsic(name, [kind], signature)
            return builder.call(function, arguments)

        return x(x, x), generate

    extreme.__doc__ = documentation
    return extreme


larger = _extreme_number("llvm.maxnum", "The larger number, the other if one is not a number.")
smaller = _extreme_number("llvm.minnum", "The smaller number, the other if one is not a number.")


@intrinsic
def bits(typing, x):
    """Return the bits of a single-precision number."""

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(32))

    return types.uint32(types.float32), generate


@intrinsic
def from_bits(typing, x):
    """Return the single-precision number with the given bits."""

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.FloatType())

    return types.float32(types.uint32), generate


@intrinsic
def _polynomial(typing, coefficients, x):
    """Evaluate a polynomial, highest coefficient first, by Estrin's scheme.

    Its terms wait for each other half as long as those of Horner's, which is what takes the time.
    """

    def generate(context, builder, signature, arguments):
        terms, power = cgutils.unpack_tuple(builder, arguments[0])[::-1], arguments[1]
        while len(terms) > 1:
            pairs = zip(terms[::2], terms[1::2], strict=False)
            left_over = terms[len(terms) - len(terms) % 2 :]
            terms = [builder.fma(high, power, low) for low, high in pairs] + left_over
            power = builder.fmul(power, power)
        return terms[0]

    return x(coefficients, x), generate


@inlined
def _power_of_two(k):
    """2^k for a small integer held as a float, through its bits."""
    return from_bits(_U(_U(_I(k) + _I(127)) << _U(23)))


@inlined
def _expm1(x):
    x = maximum(x, _F(-87.0))
    k = np.rint(x * _F(1.44269504))
    f = fma(k, _F(2.12194440e-4), fma(k, _F(-0.693359375), x))
    power = _power_of_two(k)
    return fma(power, fma(f * f, _polynomial(_EXP, f), f), power - _F(1.0))


@inlined
def _decay(x):
    """exp(-x) for x >= 0, as a power of two times an exponential; to an ulp of 1."""
    x = maximum(x * _F(-1.44269504), _F(-126.0))
    # adding 1.5 * 2^23 rounds to an integer and leaves it in the lowest bits
    shifted = x + _F(12582912.0)
    f = (x - (shifted - _F(12582912.0))) * _F(0.693147181)
    power = fma(fma(f, _polynomial(_EXP, f), _F(1.0)), f, _F(1.0))
    return from_bits(_U(bits(power) + _U(bits(shifted) << _U(23))))


@inlined
def _split(x):
    """Split x > 0 into 2^k (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)); return k and f."""
    shifted = _U(bits(x) - _SQRT_HALF)
    mantissa = from_bits(_U(_U(shifted & _U(0x007FFFFF)) + _SQRT_HALF))
    return _F(_I(_I(shifted) >> _I(23))), mantissa - _F(1.0)


@inlined
def _log(x):
    k, f = _split(x)
    return fma(k, _F(0.693147181), fma(f * f, _polynomial(_LOG, f), f))


@inlined
def _log1p(x):
    u = _F(1.0) + x
    k, f = _split(u)
    # the rounding error of u = 1 + x, divided by u; where u > 2 it does not matter
    lost = where(u < _F(2.0), (x - (u - _F(1.0))) * (_F(1.5) - _F(0.5) * u), _F(0.0))
    return fma(k, _F(0.693147181), fma(f * f, _polynomial(_LOG, f), f + lost))


@inlined
def _sincos_in_quadrant(quadrant, angle):
    """Sine and cosine of quadrant * pi/2 + angle, for |angle| <= pi/4."""
    square = angle * angle
    sine = fma(_polynomial(_SIN, square) * square, angle, angle)
    cosine = fma(_polynomial(_COS, square), square, _F(1.0))
    odd = _U(quadrant & _U(1)) != _U(0)
    first = where(odd, cosine, sine)
    second = where(odd, sine, cosine)
    return (
        from_bits(_U(bits(first) ^ _U(_U(quadrant & _U(2)) << _U(30)))),
        from_bits(_U(bits(second) ^ _U(_U(_U(quadrant + _U(1)) & _U(2)) << _U(30)))),
    )


@inlined
def _reduced(x):
    """Return k, as an integer, and x - k pi/2."""
    k = np.rint(x * _F(0.636619772))
    angle = fma(k, _F(-7.54978995e-8), fma(k, _F(-4.83751297e-4), fma(k, _F(-1.5703125), x)))
    return _U(_I(k)), angle


@inlined
def _sincos(x):
    quadrant, angle = _reduced(x)
    return _sincos_in_quadrant(quadrant, angle)


@inlined
def _arctan2(y, x):
    """Angle of (x, y) for y >= 0, in [0, pi]."""
    along = abs(x)
    low, high = minimum(along, y), maximum(maximum(along, y), _F(1e-37))
    steep = low > _F(0.414213562) * high
    # tan(angle - pi/4) is used where the angle is steep
    z = where(steep, low - high, low) / where(steep, low + high, high)
    square = z * z
    angle = fma(_polynomial(_ATAN, square) * square, z, z)
    angle = where(steep, angle + _F(0.785398163), angle)
    angle = where(y > along, _F(1.57079633) - angle, angle)
    return where(x < _F(0.0), _F(3.14159265) - angle, angle)


@inlined
def _exp(x):
    x = minimum(maximum(_F(x), _F(-87.0)), _F(89.0))  # 2^128, from 88.4 on, is infinite
    k = np.rint(x * _F(1.44269504))
    f = fma(k, _F(2.12194440e-4), fma(k, _F(-0.693359375), x))
    power = _power_of_two(k)
    return fma(power, fma(f * f, _polynomial(_EXP, f), f), power)


@inlined
def _with_sign(size, x):
    """Give a number >= 0 the sign of x."""
    return from_bits(_U(bits(size) | _U(bits(x) & _U(0x80000000))))


@inlined
def _tanh(x):
    x = _F(x)
    less = _expm1(_F(-2.0) * abs(x))
    return _with_sign(-less / (less + _F(2.0)), x)


@inlined
def _cosh(x):
    power = _exp(abs(_F(x)))
    return _F(0.5) * (power + _F(1.0) / power)


@inlined
def _sinh(x):
    x = _F(x)
    size, power = abs(x), _exp(abs(x))
    less = _expm1(-minimum(size, _F(1.0)))
    small = _F(-0.5) * less * (less + _F(2.0)) / (less + _F(1.0))
    return _with_sign(where(size < _F(1.0), small, _F(0.5) * (power - _F(1.0) / power)), x)


@inlined
def _sincos_of_any(x):
    """Sine and cosine, numbers from -1 to 1 also where x has no digits after the point."""
    quadrant, angle = _reduced(_F(x))
    return _sincos_in_quadrant(quadrant, minimum(maximum(angle, _F(-0.8)), _F(0.8)))


@inlined
def _sin(x):
    return _sincos_of_any(x)[0]


@inlined
def _cos(x):
    return _sincos_of_any(x)[1]


@inlined
def _atan(x):
    x = _F(x)
    return where(x == x, _with_sign(_arctan2(abs(x), _F(1.0)), x), x)


@inlined
def _any_log(x):
    x = _F(x)
    return where(x > _F(0.0), _log(x), where(x == _F(0.0), _F(-np.inf), _F(np.nan)))


# What formulas may have, in single precision, by the names that sympy prints.
ELEMENTARY = {
    "exp": _exp,
    "log": _any_log,
    "sin": _sin,
    "cos": _cos,
    "atan": _atan,
    "sinh": _sinh,
    "cosh": _cosh,
    "tanh": _tanh,
}


def _for_kernels(single, double, documentation):
    """Make a function of one number that runs `single` on float32 and `double` on float64."""

    def function(x):
        raise TypeError(f"{documentation} is for kernels; outside of them use numpy")

    @overload(function)
    def choose(x):
        chosen = single if x == types.float32 else inlined(double)
        return lambda x: chosen(x)

    return function


decay = _for_kernels(_decay, lambda x: math.exp(-x), "e^-x for x >= 0")
expm1 = _for_kernels(_expm1, lambda x: math.expm1(x), "e^x - 1 for x <= 0")
log = _for_kernels(_log, lambda x: math.log(x), "log x for x > 0")
log1p = _for_kernels(_log1p, lambda x: math.log1p(x), "log(1 + x) for x >= 0")
sincos = _for_kernels(_sincos, lambda x: (math.sin(x), math.cos(x)), "(sin x, cos x)")


def arctan2(y, x):
    """Angle of the point (x, y) for y >= 0, in [0, pi]."""
    raise TypeError("arctan2 is for kernels; outside of them use numpy")


@overload(arctan2)
def _choose_arctan2(y, x):
    if y == types.float32:
        return lambda y, x: _arctan2(y, x)
    return lambda y, x: math.atan2(y, x)


def sincos_in_quadrant(quadrant, angle):
    """(sin, cos) of quadrant * pi/2 + angle, for |angle| <= pi/4."""
    raise TypeError("sincos_in_quadrant is for kernels; outside of them use numpy")


@overload(sincos_in_quadrant)
def _choose_sincos_in_quadrant(quadrant, angle):
    if angle == types.float32:
        return lambda quadrant, angle: _sincos_in_quadrant(quadrant, angle)

    def double(quadrant, angle):
        total = quadrant * (math.pi / 2) + angle
        return math.sin(total), math.cos(total)

    return double
