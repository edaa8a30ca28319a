"""Numbers that were chosen for derivatives, a record for each method."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Gamma2:
    """The derivative of gamma^2."""

    # chosen: errors of the elasticity for one to four variables unless the user asks for others
    tolerance: tuple[float, ...] = (1e-8, 1e-5, 2e-3, 2e-2)


@dataclass(frozen=True)
class Line:
    """Elements of one variable."""

    degrees: tuple[int, ...] = (5, 8, 11, 15, 20)  # chosen: of the elements, coarse to fine
    safety: float = 2.0  # chosen: the error is so many times the change of the last two degrees
    rounding: float = 1e-10  # fitted: to differences of closed forms, n up to 1e6
    extra_points: int = 16  # chosen: Gauss points beyond the degree, for m in an element


@dataclass(frozen=True)
class Grids:
    """Tensor grids."""

    rounding: float = 1e-9  # chosen: of the elasticity; sparse factors lose some digits


GAMMA2 = Gamma2()
LINE = Line()
GRIDS = Grids()
