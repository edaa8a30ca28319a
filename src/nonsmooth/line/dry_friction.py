"""gamma^2 of dry friction with white noise and g(y) = y, in closed form but for one integral."""

import math

import numpy as np
import scipy

from nonsmooth.line import tuning


def friction_variance(n: float, damping: float = 1.0) -> tuple[float, float]:
    """Return gamma_n^2, the limit of Var(int_0^t Y_s ds) / t, and its error.

    This is Theorem 6 of the paper for g(y) = y. With m(y) = exp(-C_b y^2 - 2 a_n(y)) the Poisson
    equation reads (m u')' = -2 y m, so that u' = 2/m int_y^inf s m(s) ds is elementary up to one
    scaled complementary error function, and gamma^2 = int u'^2 m / int m.

    Parameters
    ----------
    n : float
        Penalization, > 0 or inf, "1".
    damping : float
        C_b > 0, "1".

    Returns
    -------
    value, error : float
        The error is the quadrature's own estimate plus rounding. Rounding grows as C_b -> 0, where
        u' is the small difference of two terms.
    """
    settings = tuning.DRY_FRICTION
    knot = 0.0 if math.isinf(n) else 1 / n
    root = math.sqrt(damping)

    def slope_outside(y):
        # a_n(y) = |y| - knot/2, and int_y^inf exp(-C s^2 - 2 s) ds is an erfc
        return (1 - math.sqrt(math.pi) / root * scipy.special.erfcx(root * y + 1 / root)) / damping

    def density_outside(y):
        return math.exp(-damping * y**2 - 2 * y + knot)

    at_knot = slope_outside(knot) * density_outside(knot)

    def density_inside(y):
        return math.exp(-(damping + n) * y**2)

    def slope_inside(y):
        inner = (density_inside(y) - density_inside(knot)) / (damping + n)
        return (inner + at_knot) / density_inside(y)

    end = knot + min(settings.reach / root, settings.farthest)
    moments = np.zeros((2, 2))
    pieces = [(knot, end, slope_outside, density_outside)]
    if knot > 0:
        pieces.append(
            (0.0, min(knot, settings.reach / math.sqrt(damping + n)), slope_inside, density_inside)
        )
    for left, right, slope, density in pieces:

        def spread(y, slope=slope, density=density):
            return slope(y) ** 2 * density(y)

        for row, integrand in enumerate((spread, density)):
            # with its full output it does not warn of an error that is returned anyway
            moments[row] += scipy.integrate.quad(
                integrand,
                left,
                right,
                epsabs=0,
                epsrel=settings.tolerance,
                limit=200,
                full_output=True,
            )[:2]
    (square, square_error), (mass, mass_error) = moments
    value = square / mass
    return value, value * (
        square_error / square
        + mass_error / mass
        + settings.rounding * np.finfo(float).eps * (1 + 1 / damping)
    )
