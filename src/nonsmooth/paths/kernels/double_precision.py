"""Elementary functions in double precision: power series of numbers that are small enough."""

import math

import numpy as np

from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.instructions import (
    bits,
    fma,
    from_bits,
    maximum,
    minimum,
    polynomial,
    where,
)

_U = np.uint64
_LOG2E, _LN2, _LN2_LOW = 1.4426950408889634, 0.6931471805599453, 2.3190468138462996e-17
_HALF_PI, _HALF_PI_LOW = 1.5707963267948966, 6.123233995736766e-17
_SQRT_HALF = _U(0x3FE6A09E667F3BCD)  # the bits of sqrt(1/2)
_ROUNDING = 6755399441055744.0  # 1.5 * 2^52: adding it leaves an integer in the lowest bits
_MANTISSA = _U(0x000FFFFFFFFFFFFF)

# Series, highest power first, each up to what is below 1e-17 in the range that its argument has:
# (e^f - 1 - f) / f^2 for |f| <= log(2)/2, sin and cos up to pi/4, atan up to tan(pi/8), and
# atanh(s) for log(1 + f), s = f / (2 + f), up to 0.172.
_EXP = tuple(1 / math.factorial(j + 2) for j in reversed(range(13)))
_SIN = tuple((-1) ** (j + 1) / math.factorial(2 * j + 3) for j in reversed(range(8)))
_COS = tuple((-1) ** (j + 1) / math.factorial(2 * j + 2) for j in reversed(range(9)))
_ATAN = tuple((-1) ** (j + 1) / (2 * j + 3) for j in reversed(range(21)))
_ATANH = tuple(2 / (2 * j + 3) for j in reversed(range(11)))


@inlined
def _integer(x):
    """Round to an integer, returned as it is and in the lowest bits of a word."""
    shifted = x + _ROUNDING
    return shifted - _ROUNDING, bits(shifted)


@inlined
def _power_of_two(word, more):
    """2^(k + more) for the integer k in the lowest bits of a word."""
    return from_bits(_U(_U(word + _U(1023 + more)) << _U(52)))


@inlined
def _exp_parts(x):
    """Split e^x into 2^k and e^f; return k, in the lowest bits of a word, and e^f - 1."""
    k, word = _integer(x * _LOG2E)
    f = fma(k, -_LN2_LOW, fma(k, -_LN2, x))
    return word, fma(f * f, polynomial(_EXP, f), f)


@inlined
def exp(x):
    """e^x; 0 below e^-708."""
    word, rest = _exp_parts(minimum(maximum(x, -708.0), 710.0))
    half = _power_of_two(word, -1)  # 2^1024 is infinite, and not all that it is a factor of
    return where(x < -708.0, 0.0, 2.0 * fma(half, rest, half))


@inlined
def expm1(x):
    """e^x - 1 for x <= 0; to two ulps."""
    word, rest = _exp_parts(maximum(x, -700.0))
    power = _power_of_two(word, 0)
    return fma(power, rest, power - 1.0)


@inlined
def decay(x):
    """e^-x for x >= 0; to an ulp of 1."""
    word, rest = _exp_parts(-minimum(x, 700.0))
    power = _power_of_two(word, 0)
    return fma(power, rest, power)


@inlined
def _split(x):
    """Split x > 0 into 2^k (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)); return k and f."""
    shifted = _U(bits(x) - _SQRT_HALF)
    mantissa = from_bits(_U(_U(shifted & _MANTISSA) + _SQRT_HALF))
    # the exponent is below 0 if the first bit is set: 2^11 is added, and taken away from the number
    exponent = _U(_U(_U(shifted >> _U(52)) + _U(2048)) & _U(4095))
    return from_bits(_U(exponent + bits(_ROUNDING))) - _ROUNDING - 2048.0, mantissa - 1.0


@inlined
def _log_of(k, f, lost):
    """Return k log 2 + log(1 + f) + lost."""
    s = f / (2.0 + f)
    square, half = s * s, 0.5 * f * f
    rest = square * polynomial(_ATANH, square)
    small = fma(k, _LN2_LOW, lost) - (half - s * (half + rest))
    return fma(k, _LN2, f + small)


@inlined
def log(x):
    """Return the natural logarithm of x > 0."""
    k, f = _split(x)
    return _log_of(k, f, 0.0)


@inlined
def log1p(x):
    """Return log(1 + x) for x >= 0."""
    u = 1.0 + x
    k, f = _split(u)
    # the rounding error of u = 1 + x, divided by u; where u > 2 it does not matter
    return _log_of(k, f, where(u < 2.0, (x - (u - 1.0)) / u, 0.0))


@inlined
def reduced(x):
    """Return the integer k nearest to 2 x / pi, and x - k pi/2."""
    k, word = _integer(x * (1 / _HALF_PI))
    return word, fma(k, -_HALF_PI_LOW, fma(k, -_HALF_PI, x))


@inlined
def short_sincos(angle):
    """Sine and cosine of |angle| <= pi/4."""
    square = angle * angle
    sine = fma(polynomial(_SIN, square) * square, angle, angle)
    return sine, fma(polynomial(_COS, square), square, 1.0)


@inlined
def short_arctan(z):
    """Angle of (1, z) for |z| <= tan(pi/8)."""
    square = z * z
    return fma(polynomial(_ATAN, square) * square, z, z)


@inlined
def negated(x, quadrant):
    """-x if the number of a quadrant is 2 or 3, up to multiples of 4, else x."""
    return from_bits(_U(bits(x) ^ _U(_U(_U(quadrant) & _U(2)) << _U(62))))
