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


FAR_OUT = FarOut()
LINEAR_DRIFT = LinearDrift()
