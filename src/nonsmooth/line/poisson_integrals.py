"""The Poisson equation of a scene with one state variable, integrated on given elements.

From m = exp(-Phi) / Z the Poisson equation -A u = g - E g reads (m u')' = -(2/sigma^2) (g - E g) m.
Hence

    u'(y) = 2 / (sigma^2 m(y)) int_y^inf (g - E g) m,    gamma^2 = sigma^2 int u'^2 m

(Theorem 6 of the paper). The inner integral is taken from the end of the axis on the side of y,
where the summands are smallest, so that nothing cancels. Two errors are estimated besides: what the
polynomials on the elements miss, and rounding.
"""

from dataclasses import dataclass

import mpmath
import numpy as np
import sympy

from nonsmooth.errors import SceneError, quoted
from nonsmooth.line import tuning
from nonsmooth.line.gauss_elements import MODES, POINTS, SLOPES, WEIGHTS, GaussElements
from nonsmooth.scenes import symbols

_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class PoissonIntegrals:
    """Integrals over the elements, with estimates of their errors.

    Attributes
    ----------
    elements : GaussElements
    total : float
        Z, the integral of exp(-Phi).
    mean : float
        E g, without the additive constant of g.
    gamma2 : float
        gamma^2.
    influence : numpy.ndarray, shape (k, POINTS)
        By how much gamma^2 changes, to first order, if g changes by 1 at a Gauss point.
    missed : numpy.ndarray, shape (k,)
        What the polynomial on each element misses of int |g - E g| m.
    misfit : numpy.ndarray, shape (k,)
        The effect of `missed` on gamma^2.
    tail : float
        What the two outermost elements contribute to gamma^2.
    rounding : float
        Rounding error of gamma^2, without that of the formula of g.
    """

    elements: GaussElements
    total: float
    mean: float
    gamma2: float
    influence: np.ndarray
    missed: np.ndarray
    misfit: np.ndarray
    tail: float
    rounding: float


@np.errstate(over="ignore", invalid="ignore")  # `quadrature` refuses integrals that diverge
def integrate(e: GaussElements, sigma: float) -> PoissonIntegrals:
    """Integrate the Poisson equation over elements.

    Parameters
    ----------
    e : GaussElements
    sigma : float
        Intensity of the noise.

    Returns
    -------
    PoissonIntegrals
    """
    mass, side = e.mass, np.where(e.left < 0, -1.0, 1.0)
    total = mass.sum()
    mean = np.sum(mass * e.g) / total
    mean += np.sum(mass * (e.g - mean)) / total  # removes the rounding error of a large mean
    centred = e.g - mean
    source = e.half * np.exp(-e.depth) * centred
    flux = side[:, None] * e.from_ends(source)[0]
    slope = 2 / sigma**2 * flux * np.exp(e.depth)
    u = side[:, None] * e.from_middle(e.half * slope)
    u -= np.sum(mass * u) / total
    mass = mass / total
    gamma2 = sigma**2 * np.sum(slope * (mass * slope))
    # gamma^2 is the maximum over v of 4 <g, v> - sigma^2 <v'^2>, attained by v = u: to first
    # order in errors of g and m only these expressions change, not u
    influence = 4 * mass * np.abs(u)
    by_density = mass * (4 * np.abs(centred * u) + sigma**2 * slope**2 + gamma2)
    missed = np.abs(source @ MODES[-3:].T).sum(axis=1) * 2 / total
    flux_error = _flux_rounding(e, source, np.sum(mass * np.abs(centred)))
    sums = 4 * np.sum(e.half * WEIGHTS * np.abs(slope) * flux_error) / total
    sums += 2 * tuning.QUADRATURE.pairwise * gamma2
    return PoissonIntegrals(
        e,
        total,
        mean,
        gamma2,
        influence,
        missed,
        4 * np.abs(u).max(axis=1) * missed,
        by_density[[0, -1]].sum(),
        np.sum(by_density * exponential_rounding(e.depth)) + _EPS * sums,
    )


def _flux_rounding(e, source, spread):
    """Estimate the rounding error of the flux, in units of eps.

    Its parts are those of the sum in the element, of the sum over the elements, and of the mean.
    """
    moduli, partial = e.from_ends(np.abs(source))
    beyond, _ = e.from_ends(e.half * np.exp(-e.depth))
    zero = e.first_right
    partial = np.append(np.cumsum(partial[:zero]), np.cumsum(partial[zero:][::-1])[::-1])
    error = POINTS * moduli + partial[:, None]
    error += tuning.QUADRATURE.pairwise * beyond * spread
    return error


def exponential_rounding(depth: np.ndarray) -> np.ndarray:
    """Relative error of exp(-depth): four roundings, of depth and of the point it belongs to."""
    return _EPS * (4 + 4 * depth)


def formula_error(varying: sympy.Expr, solution: PoissonIntegrals) -> np.ndarray:
    """Bound the rounding error of g at the Gauss points.

    It has three parts. The value of g is rounded. The point is rounded, too, which matters where g
    is steep. And terms of the formula of g may cancel. The last part
    is measured against an evaluation to many digits, on the elements that matter most, at three
    points of each; the largest of the three is taken for the element.

    Parameters
    ----------
    varying : sympy.Expr
        The formula of g in y.
    solution : PoissonIntegrals

    Returns
    -------
    numpy.ndarray, shape (k, POINTS)

    Raises
    ------
    SceneError
        If a part of the formula is too large for any number of digits.
    """
    e = solution.elements
    slope = e.g @ SLOPES.T / e.half
    error = _EPS * (np.abs(e.points * slope) + np.abs(e.g))
    weight = solution.influence.sum(axis=1)
    chosen = np.argsort(weight)[-tuning.QUADRATURE.sampled :]
    exact = sympy.lambdify(symbols.y, varying, "mpmath")
    with mpmath.workdps(tuning.QUADRATURE.digits):
        try:
            for k in chosen:
                error[k] += max(
                    abs(float(exact(mpmath.mpf(e.points[k, i])) - e.g[k, i]))
                    for i in (1, POINTS // 2, POINTS - 2)
                )
        except (ArithmeticError, ValueError):  # an intermediate result that is too large
            raise SceneError(
                f"g = {quoted(varying)} is too steep to be evaluated with "
                f"{tuning.QUADRATURE.digits} digits; choose a g that grows less"
            ) from None
    return error
