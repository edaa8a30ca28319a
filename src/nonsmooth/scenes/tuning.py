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
    # chosen: accuracy of the direction in which it grows least, ten times what the search reaches;
    # H changes by its square there
    direction: float = 1e-7
    converged: float = 1e-9  # chosen: change of the direction at which that search ends
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
    depth: int = 12  # measured: deeper formulas keep sympy busy with signs, some for minutes
    # measured: at every function and power sympy asks for the signs of its arguments, and of
    # theirs; of a thousand formulas of this size none takes longer than 0.6 s, with one function
    # and five operations more one in 500 takes minutes
    nested: int = 4
    operations_nested: int = 20
    # measured: max and min compare all their arguments with one another, 3 ms for each pair
    compared: int = 12
    # measured: to compare them sympy asks for the signs of their differences, which takes up to
    # 0.3 s here and may take minutes with 60
    operations_compared: int = 20
    # chosen: the range of double precision, less some digits for sums and products
    largest: float = 1e300
    smallest: float = 1e-300
    # chosen: x**100 is beyond double precision at x = 1300; numbers to this power have at most
    # 30,000 digits, which sympy computes at once
    exponent: int = 100
    exponent_of_sums: int = 10  # measured: sympy multiplies out powers when it looks for signs


@dataclass(frozen=True)
class Near:
    """States at which formulas must be numbers of a moderate size.

    A formula that is too small there may have a peak elsewhere; it is looked for as far as
    `Regularity.near`.
    """

    # chosen: values of each variable, of the size of the yield limit, within which every path is
    # for some of its time
    places: tuple[float, ...] = (-1.0, -0.5, -0.1, 0.0, 0.1, 0.5, 1.0)
    # chosen: the sizes a formula may have there; its square is in single precision then
    sizes: tuple[float, float] = (1e-15, 1e15)


@dataclass(frozen=True)
class Regularity:
    """Where formulas are looked at for poles, and for more oscillations than can be resolved."""

    # chosen: values of a variable, a few standard deviations, that are looked at closely, how far
    # it is looked at roughly, and the number of values
    near: float = 5.0
    far: float = 1e3
    points: int = 4001
    others: tuple[float, ...] = (0.0, 0.37)  # chosen: values of the other variables meanwhile
    halvings: int = 80  # derived: after which an interval is as short as rounding allows
    # derived: a function that touches zero is as small as this there, relative to its size, because
    # the place is known to the root of the rounding error
    touching: float = 1e-14
    # chosen: distances from a zero between which g must not grow like a pole; the last ones show a
    # weak pole on a large background, the first ones a pole whose place is not known as well
    distances: tuple[float, ...] = (1e-4, 1e-6, 1e-8, 1e-10)
    # derived: the square of the distance to the power -1/2 has no integral; less for the error of
    # the power
    steepest: float = 0.45
    apart: float = 1e-7  # chosen: of values whose difference is g's slope; keeps nine digits
    # fitted: with more sweeps no method answers within minutes
    sweeps: float = 1e4


FAR_OUT = FarOut()
FORMULA = Formula()
NEAR = Near()
LINEAR_DRIFT = LinearDrift()
REGULARITY = Regularity()
