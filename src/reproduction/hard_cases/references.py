"""Independent references of the cases.

Each function returns a `Result`; a case calls it when it is examined.
"""

import math
from collections.abc import Callable

import mpmath
import numpy as np
import scipy.linalg
from scipy.integrate import quad

from reproduction.hard_cases.record import Result


def gamma2_to_40_digits(n: float, C_b: float) -> Result:
    """Return gamma^2 of dry friction, computed with 40 digits.

    The derivative of the Poisson solution u is a scaled complementary error function.
    """
    with mpmath.workdps(40):
        C, N = mpmath.mpf(C_b), mpmath.mpf(n)
        kink = 1 / N

        def outside(s):  # m and m u', beyond the kink
            m = mpmath.exp(-C * s**2 - 2 * s + kink)
            tail = mpmath.exp(kink + 1 / C) * mpmath.sqrt(mpmath.pi / C)
            return m, (m - tail * mpmath.erfc(mpmath.sqrt(C) * s + 1 / mpmath.sqrt(C))) / C

        at_kink, flux_at_kink = outside(kink)

        def inside(s):
            m = mpmath.exp(-(C + N) * s**2)
            return m, flux_at_kink + (m - at_kink) / (C + N)

        far = kink + min(12 / mpmath.sqrt(C), mpmath.mpf(60))
        pieces = [
            (inside, [0, kink]),
            (outside, [kink, *(far * mpmath.mpf(k) / 16 for k in range(1, 17))]),
        ]
        square = mass = mpmath.mpf(0)
        for piece, interval in pieces:
            square += mpmath.quad(lambda s, f=piece: f(s)[1] ** 2 / f(s)[0], interval)
            mass += mpmath.quad(lambda s, f=piece: f(s)[0], interval)
        value = float(square / mass)
    return Result(value, 1e-15 * value)


def gamma2_by_nested_quadrature(g: Callable[[float], float]) -> Result:
    """Return gamma^2 of dry friction at n = inf, C_b = 1, by adaptive quadrature, twice nested."""

    def m(s):
        return math.exp(-s * s - 2 * abs(s))

    def integral(f, a, b):
        return quad(
            f,
            a,
            b,
            points=[0.0] if a < 0 < b else None,
            epsabs=1e-12,
            epsrel=1e-10,
            limit=2000,
        )[0]

    end = 5.5
    total = integral(m, -end, end)
    mean = integral(lambda s: g(s) * m(s), -end, end) / total

    def flux(s):
        near, far = (s, end) if s > 0 else (-end, s)
        return math.copysign(2.0, s) * integral(lambda r: (g(r) - mean) * m(r), near, far)

    value = integral(lambda s: flux(s) ** 2 / m(s), -end, end) / total
    return Result(value, 1e-7 * value)


def integrated_ornstein_uhlenbeck(rate: float, time: float) -> Result:
    """Return the variance of the integral of Y, dY = -rate Y dt + dW.

    Under dry friction it is the same as long as Y stays in the layer |y| < 1/n, where the penalty
    is linear, or far outside of it, where the force is constant.
    """
    with mpmath.workdps(40):
        z = mpmath.mpf(rate) * time
        value = (z - 2 * (1 - mpmath.exp(-z)) + (1 - mpmath.exp(-2 * z)) / 2) / mpmath.mpf(
            rate
        ) ** 3
    return Result(float(value), 1e-15 * float(value))


def kanai_tajimi_variance(k: float, c: float, time: float) -> Result:
    """Return the variance of the integral of eta from rest, by Van Loan's formula (1978)."""
    matrix = np.array([[-c, -k, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    block = np.zeros((6, 6))
    block[:3, :3], block[3:, 3:], block[0, 3] = -matrix, matrix.T, 1.0
    grown = scipy.linalg.expm(block * time)
    value = (grown[3:, 3:].T @ grown[:3, 3:])[2, 2]
    return Result(value, 1e-9 * value)


def obstacle_mean_square(n: float) -> Result:
    """Return the stationary mean of x^2 of the obstacle with U = x^2/2, C_b = 1."""

    def density(s):
        return math.exp(-(s * s) - n * max(s - 1, 0.0) ** 2)

    def integral(f):
        return sum(quad(f, a, b, epsabs=1e-13)[0] for a, b in ((0, 1), (1, 1 + 10 / math.sqrt(n))))

    value = integral(lambda s: s * s * density(s)) / integral(density)
    return Result(value, 1e-9)


def friction_mean_square(n: float) -> Result:
    """Return the stationary mean of y^2 of dry friction, C_b = 1."""

    def density(s):
        return math.exp(-s * s - (n * s * s if s < 1 / n else 2 * s - 1 / n))

    def integral(f):
        return sum(quad(f, a, b, epsabs=1e-13)[0] for a, b in ((0, 1 / n), (1 / n, 6)))

    value = integral(lambda s: s * s * density(s)) / integral(density)
    return Result(value, 1e-9)


def brownian_by_images(b: float, T: float) -> Result:
    """Return W_star(b, T) as a sum over images, computed with 50 digits."""
    with mpmath.workdps(50):
        r = mpmath.sqrt(2 * mpmath.mpf(T))
        images = [(-1) ** k * mpmath.erfc((2 * k + 1) * mpmath.mpf(b) / r) for k in range(40)]
        value = float(2 * mpmath.fsum(images))
    return Result(value, 1e-15 * value)


def other_method(evaluate: Callable[[int | None], Result], relative: float = 0.0) -> Result:
    """Return the result of another method, with its own error or a relative one if larger."""
    found = evaluate(None)
    return Result(found.value, max(found.error, relative * abs(found.value)))
