"""Numbers of this package that are chosen rather than given by the mathematics.

Each line says what the number is and why it has its size.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class FarOut:
    """Where, and how strictly, the growth of a formula at infinity is read from its values."""

    # chosen: distances from 0 at which formulas are evaluated, far enough for the leading term of a
    # reasonable formula to dominate, near enough for its powers not to overflow
    distances: tuple[float, ...] = (1e2, 1e3, 1e4, 1e6)
    directions: int = 16  # chosen: rays along which a Hamiltonian is examined
    # chosen: a ratio whose value at the last distance is below this part of its value at the first
    # is taken to vanish at infinity; powers of the distance below -3/4 are
    kept: float = 1e-3
    # chosen: a ratio that rises above so many times its value at the first distance is taken to
    # grow without bound; powers of the distance above 1/4 are
    grown: float = 10.0


@dataclass(frozen=True)
class LinearDrift:
    """Where the drift is taken to be linear, so that it gives the rate of relaxation."""

    # chosen: distances from 0 between which slopes are measured, far beyond the kinks of every
    # penalty, near enough for slopes to keep 8 digits
    distances: tuple[float, ...] = (1e5, 1e6, 1e7)
    mismatch: float = 1e-6  # chosen: relative difference of slopes that rounding may cause


@dataclass(frozen=True)
class Formula:
    """How large a formula may be, so that it is read within a second and has sensible values."""

    # chosen: several times what a polynomial of degree four in four variables takes
    length: int = 2000
    operations: int = 200  # measured: such formulas take sympy up to 0.5 s
    depth: int = 30  # measured: sympy descends some ten calls a level; Python allows 1000 in all
    # measured: max and min compare all their arguments with one another, 3 ms for each pair
    compared: int = 12
    # chosen: the range of double precision, less some digits for sums and products
    largest: float = 1e300
    smallest: float = 1e-300
    # chosen: x**100 is beyond double precision at x = 1300; numbers to this power have at most
    # 30,000 digits, which sympy computes at once
    exponent: int = 100


@dataclass(frozen=True)
class Near:
    """States at which formulas must be numbers of a moderate size."""

    # chosen: values of each variable, of the size of the yield limit, within which every path is
    # for some of its time
    places: tuple[float, ...] = (-1.0, -0.5, -0.1, 0.0, 0.1, 0.5, 1.0)
    # chosen: the sizes a formula may have there; its square is in single precision then
    sizes: tuple[float, float] = (1e-15, 1e15)


FAR_OUT = FarOut()
FORMULA = Formula()
NEAR = Near()
LINEAR_DRIFT = LinearDrift()
