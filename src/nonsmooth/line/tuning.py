"""Numbers that were chosen for scenes with one state variable, a record for each method."""

from dataclasses import dataclass


@dataclass(frozen=True)
class DryFriction:
    """The one integral that the closed form of gamma^2 leaves."""

    reach: float = 8.5  # derived: exp(-C_b y^2) at y = reach / sqrt(C_b) is below 1e-31
    farthest: float = 40.0  # derived: and so is exp(-2 y) there
    tolerance: float = 1e-13  # chosen: relative error asked of the quadrature, near rounding
    rounding: float = 8.0  # chosen: eps per factor of the integrand, with some to spare


@dataclass(frozen=True)
class SpectralElements:
    """Mesh of the Galerkin method in L^2(m)."""

    depth: float = 80.0  # chosen: the mesh ends where m has fallen by exp(-80) = 2e-35
    finest: float = 2.0**-7  # chosen: width of the elements next to a kink, ...
    per_knot: float = 4.0  # chosen: ... or the distance of the kink from 0 over it, if larger
    fewest: float = 8.0  # chosen: elements on half of the axis, at least
    step: float = 1.25  # chosen: the end of the mesh is found up to this factor
    past_start: float = 1.5  # chosen: the mesh ends at so many times the start, or farther
    degree_of_mean: int = 12  # chosen: converged for every n, tests/.../test_eigenfunctions.py
    extra_points: int = 16  # chosen: Gauss points beyond the degree, for exp(-Phi) in an element
    least_nu: float = 1e-13  # derived: 1/(1 + lambda/C_b) of a mode below it is rounding
    rounding: float = 4.0  # fitted: twice the largest error seen against the closed form, over
    #                        n = 100 ... 1e6 and C_b = 0.2 ... 5, relative to eps degree^2 / width


@dataclass(frozen=True)
class Quadrature:
    """Adaptive composite Gauss-Legendre quadrature."""

    depth: float = 690.0  # derived: exp(-690) = 1e-300 is about the smallest normal number
    steepest: float = 4.0  # derived: exp(-2x) on [-1, 1], which four units of depth amount to,
    #                        has Legendre coefficients below 1e-17 from degree 18 on
    resolved: float = 1e-13  # chosen: effect on gamma^2 at which an element is left: 500 eps
    noise: float = 100.0  # chosen: last Legendre coefficients below so many eps may be rounding
    rounds: int = 120  # chosen: halvings after which a formula is given up, as at a pole
    most_elements: int = 3000  # chosen: a formula that needs more has a pole
    sampled: int = 60  # chosen: elements on which g is also evaluated to many digits
    digits: int = 40  # chosen: decimal digits of these evaluations, more than cancellation takes
    pairwise: int = 32  # derived: additions in a row in numpy's pairwise sums of 1e6 numbers


DRY_FRICTION = DryFriction()
SPECTRAL_ELEMENTS = SpectralElements()
QUADRATURE = Quadrature()
