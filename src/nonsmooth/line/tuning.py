"""Numbers that were chosen for scenes with one state variable, a record for each method.

Each line says what the number is and where it comes from.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class DryFriction:
    """The one integral that the closed form of gamma^2 leaves."""

    reach: float = 8.5  # derived: beyond y = reach / sqrt(C_b), exp(-C_b y^2) is below 1e-31
    farthest: float = 40.0  # derived: beyond this y, exp(-2 y) is below 1e-31, too
    tolerance: float = 1e-13  # chosen: relative error asked of the quadrature, near rounding
    rounding: float = 8.0  # chosen: rounding error in eps, some for each factor of the integrand


@dataclass(frozen=True)
class SpectralElements:
    """Mesh of the Galerkin method in L^2(m)."""

    depth: float = 80.0  # chosen: the mesh ends where m has fallen by exp(-80) = 2e-35
    finest: float = 2.0**-7  # chosen: least width of the elements next to a kink; narrower ones
    #                          lose digits by rounding
    per_knot: float = 4.0  # chosen: they are not narrower than the kink's distance from 0 over this
    fewest: float = 8.0  # chosen: elements on half of the axis, at least
    step: float = 1.25  # chosen: factor up to which the end of the mesh is found
    past_start: float = 1.5  # chosen: the mesh ends at so many times the start, or farther out
    degree_of_mean: int = 12  # chosen: converged for every n, tests/.../test_eigenfunctions.py
    extra_points: int = 16  # chosen: Gauss points beyond the degree, for exp(-Phi) in an element
    least_nu: float = 1e-13  # derived: modes with a smaller 1/(1 + lambda/s) consist of rounding
    rounding: float = 4.0  # fitted: twice the largest error seen against the closed form, over
    #                        n = 100 ... 1e6 and C_b = 0.2 ... 5, relative to eps degree^2 / width


@dataclass(frozen=True)
class FiniteDifferences:
    """The domain of the paper's scheme."""

    # chosen: share of the stationary law that may be outside; there the error of the domain is at
    # most a sixth of the estimate by halving it (C_b = 0.02 ... 10), and at a share of a third it
    # is half of it
    outside: float = 0.05
    steady: float = 1e-10  # chosen: v is taken to grow linearly once its gain of a step differs by
    #                        less between all nodes; far below the error of any affordable grid
    look: int = 100  # chosen: steps between two looks, which cost half a step


@dataclass(frozen=True)
class Quadrature:
    """Adaptive composite Gauss-Legendre quadrature."""

    depth: float = 690.0  # derived: the axis ends where m has fallen by exp(-690) = 1e-300, close
    #                       to the smallest number with full precision
    steepest: float = 4.0  # derived: change of Phi over an element, at most; exp(-2x) on [-1, 1]
    #                        has Legendre coefficients below 1e-17 from degree 18 on
    resolved: float = 1e-13  # chosen: relative effect on gamma^2 below which an element is not
    #                          halved; 500 eps
    noise: float = 100.0  # chosen: last Legendre coefficients below so many eps may be rounding
    rounds: int = 120  # chosen: halvings after which a formula is given up, as at a pole
    most_elements: int = 3000  # chosen: a formula that needs more has a pole
    sampled: int = 60  # chosen: elements on which g is also evaluated to many digits
    digits: int = 40  # chosen: decimal digits of these evaluations, more than cancellation takes
    pairwise: int = 32  # derived: roundings that add up in numpy's pairwise sum of 1e6 numbers


DRY_FRICTION = DryFriction()
SPECTRAL_ELEMENTS = SpectralElements()
FINITE_DIFFERENCES = FiniteDifferences()
QUADRATURE = Quadrature()
