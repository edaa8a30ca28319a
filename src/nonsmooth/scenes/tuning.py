"""Numbers of this package that are chosen rather than given by the mathematics."""

from dataclasses import dataclass


@dataclass(frozen=True)
class FarOut:
    """Where, and how strictly, the growth of a formula at infinity is read from its values."""

    # chosen: far enough for the leading term of a reasonable formula to dominate, near enough
    # for its fourth power not to overflow
    distances: tuple[float, ...] = (1e2, 1e3, 1e4, 1e6)
    directions: int = 16  # chosen: rays along which a Hamiltonian is examined
    # chosen: over the four decades between the distances, a power -3/4 or less of the distance
    # falls below `kept`, and a power of 1/4 or more rises above `grown`
    kept: float = 1e-3
    grown: float = 10.0


@dataclass(frozen=True)
class LinearDrift:
    """Where the drift is taken to be linear, so that it gives the rate of relaxation."""

    # chosen: far beyond the kinks of every penalty, near enough for slopes to keep 8 digits
    distances: tuple[float, ...] = (1e5, 1e6, 1e7)
    mismatch: float = 1e-6  # chosen: its slopes may differ by so much; more than rounding does


FAR_OUT = FarOut()
LINEAR_DRIFT = LinearDrift()
