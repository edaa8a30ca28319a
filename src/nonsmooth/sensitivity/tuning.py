"""Numbers that were chosen for derivatives, a record for each method."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Gamma2:
    """The derivative of gamma^2."""

    # chosen: errors relative to gamma^2 for one to four variables unless the user asks for others
    tolerance: tuple[float, ...] = (1e-8, 1e-5, 2e-3, 2e-2)


@dataclass(frozen=True)
class Line:
    """Elements of one variable."""

    degrees: tuple[int, ...] = (5, 8, 11, 15, 20)  # chosen: of the elements, coarse to fine
    safety: float = 2.0  # chosen: the error is so many times the change of the last two degrees
    rounding: float = 1e-10  # fitted: to differences of closed forms, n up to 1e6


@dataclass(frozen=True)
class Grids:
    """Tensor grids."""

    rounding: float = 1e-9  # chosen: relative to gamma^2; sparse factors lose some digits
    roughly: float = 0.1  # chosen: relative error of the gamma^2 that a tolerance is relative to


@dataclass(frozen=True)
class Crossing:
    """The derivative of crossing probabilities, times the parameter."""

    # chosen: errors by the deterministic method for one and two variables unless asked for others
    solved: tuple[float, ...] = (1e-4, 1e-2)
    # chosen: the same by Monte Carlo, and the tolerance from which on it is faster, some seconds
    sampled: float = 3e-2


@dataclass(frozen=True)
class Adjoint:
    """The differentiated transform of one variable."""

    negligible: float = 1e-2  # chosen: a share of F below so much of the accuracy counts as none
    # chosen: with fits so many times worse than the tolerance, differences are the faster way
    misfit: float = 100.0
    falls: float = 0.03  # chosen: least change of two levels, over the change before, for an error
    # fitted: to differences of probabilities that are solved to 1e-11
    rounding: float = 1e-12
    # derived: probabilities that are taken to be 0 are below 1e-14, and derivatives at most some
    # times the logarithm as large
    nothing: float = 1e-12


@dataclass(frozen=True)
class Differences:
    """Central differences of solved probabilities."""

    steps: tuple[float, ...] = (
        0.06,
        0.03,
        0.015,
    )  # chosen: parts of the parameter, long ones first
    share: float = 0.2  # chosen: part of the tolerance that the errors of the solutions may have


@dataclass(frozen=True)
class CommonNoise:
    """Central differences of paths that share their noise."""

    apart: float = 0.1  # chosen: first part of the parameter by which it is changed
    nearest: float = 0.01  # chosen: smallest part; few paths tell smaller ones apart
    # chosen: part of the tolerance for which paths are counted: the two biases are known to half a
    # standard error each, which takes most of the rest
    aim: float = 0.8


GAMMA2 = Gamma2()
CROSSING = Crossing()
ADJOINT = Adjoint()
DIFFERENCES = Differences()
COMMON_NOISE = CommonNoise()
LINE = Line()
GRIDS = Grids()
