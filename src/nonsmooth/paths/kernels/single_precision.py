"""Elementary functions in single precision: the polynomials of S. L. Moshier's Cephes library."""

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


@inlined
def _power_of_two(k):
    """2^k for a small integer held as a float, through its bits."""
    return from_bits(_U(_U(_I(k) + _I(127)) << _U(23)))


@inlined
def _exp_parts(x):
    """Split e^x into 2^k and e^f; return k and e^f - 1."""
    k = np.rint(x * _F(1.44269504))
    f = fma(k, _F(2.12194440e-4), fma(k, _F(-0.693359375), x))
    return k, fma(f * f, polynomial(_EXP, f), f)


@inlined
def exp(x):
    """e^x; 0 below e^-86."""
    k, rest = _exp_parts(minimum(maximum(x, _F(-86.0)), _F(89.0)))
    half = _power_of_two(k - _F(1.0))  # 2^128 is infinite, and not all that it is a factor of
    return where(x < _F(-86.0), _F(0.0), _F(2.0) * fma(half, rest, half))


@inlined
def expm1(x):
    """e^x - 1 for x <= 0; to two ulps."""
    k, rest = _exp_parts(maximum(x, _F(-87.0)))
    power = _power_of_two(k)
    return fma(power, rest, power - _F(1.0))


@inlined
def decay(x):
    """e^-x for x >= 0, as a power of two times an exponential; to an ulp of 1."""
    x = maximum(x * _F(-1.44269504), _F(-126.0))
    # adding 1.5 * 2^23 rounds to an integer and leaves it in the lowest bits
    shifted = x + _F(12582912.0)
    f = (x - (shifted - _F(12582912.0))) * _F(0.693147181)
    power = fma(fma(f, polynomial(_EXP, f), _F(1.0)), f, _F(1.0))
    return from_bits(_U(bits(power) + _U(bits(shifted) << _U(23))))


@inlined
def _split(x):
    """Split x > 0 into 2^k (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)); return k and f."""
    shifted = _U(bits(x) - _SQRT_HALF)
    mantissa = from_bits(_U(_U(shifted & _U(0x007FFFFF)) + _SQRT_HALF))
    return _F(_I(_I(shifted) >> _I(23))), mantissa - _F(1.0)


@inlined
def log(x):
    """Return the natural logarithm of x > 0."""
    k, f = _split(x)
    return fma(k, _F(0.693147181), fma(f * f, polynomial(_LOG, f), f))


@inlined
def log1p(x):
    """Return log(1 + x) for x >= 0."""
    u = _F(1.0) + x
    k, f = _split(u)
    # the rounding error of u = 1 + x, divided by u; where u > 2 it does not matter
    lost = where(u < _F(2.0), (x - (u - _F(1.0))) * (_F(1.5) - _F(0.5) * u), _F(0.0))
    return fma(k, _F(0.693147181), fma(f * f, polynomial(_LOG, f), f + lost))


@inlined
def reduced(x):
    """Return the integer k nearest to 2 x / pi, and x - k pi/2."""
    k = np.rint(x * _F(0.636619772))
    angle = fma(k, _F(-7.54978995e-8), fma(k, _F(-4.83751297e-4), fma(k, _F(-1.5703125), x)))
    return _U(_I(k)), angle


@inlined
def short_sincos(angle):
    """Sine and cosine of |angle| <= pi/4."""
    square = angle * angle
    sine = fma(polynomial(_SIN, square) * square, angle, angle)
    return sine, fma(polynomial(_COS, square), square, _F(1.0))


@inlined
def short_arctan(z):
    """Angle of (1, z) for |z| <= tan(pi/8)."""
    square = z * z
    return fma(polynomial(_ATAN, square) * square, z, z)


@inlined
def negated(x, quadrant):
    """-x if the number of a quadrant is 2 or 3, up to multiples of 4, else x."""
    return from_bits(_U(bits(x) ^ _U(_U(_U(quadrant) & _U(2)) << _U(30))))
