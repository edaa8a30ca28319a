"""Numbers that were chosen to test the theorems, one record for each method.

Each line says what the number is and where it comes from.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Assumptions:
    """How the constants of the standing assumptions are computed."""

    nearest: float = 1e-6  # chosen: first point of the grid on which suprema are taken, besides 0
    farthest: float = 1e6  # chosen: last point of it; stands for infinity
    logarithmic: int = 1201  # chosen: points in equal ratios, a hundred for each factor of ten
    equidistant: tuple[float, int] = (20.0, 801)  # chosen: end and number of points where U varies
    positive: float = 1e-3  # chosen: added to each beta, which must be positive; larger ones serve
    safety: float = 1e-9  # chosen: relative, far above the error of the refined suprema
    quadratic: float = 1e-6  # chosen: a limit of U / x^2 up to this counts as 0
    inside: int = 2001  # chosen: points of [-1, 1] on which the steepest slope of U is found
    inside_safety: float = 1e-3  # chosen: relative, above what is missed between them


@dataclass(frozen=True)
class Lyapunov:
    """How far the constants of V_n are from their bounds."""

    slack: float = 1.01  # chosen: factor above the bounds, as the inequalities (14) are strict


@dataclass(frozen=True)
class DriftCondition:
    """The search for points at which an inequality fails."""

    smallest: float = 1e-6  # chosen: least non-zero value on each axis, besides the kinks
    evaluations: int = 60  # chosen: of the refinement, for each variable


@dataclass(frozen=True)
class Ergodicity:
    """Rate of decay and bound of Poisson solutions on a box."""

    depth: float = 20.0  # chosen: the density at the end of the box is exp(-20) of its maximum
    coarse: int = 1  # chosen: level of the grid that shows the error
    fine: int = 2  # chosen: level of the grid
    settled: float = 1e-3  # chosen: the rate is taken from where the norm has fallen so far
    floor: float = 1e-10  # chosen: to where it has fallen so far; rounding is below that
    # derived: if eigenvalues coincide, or nearly, the norm is t^k exp(-rate t), and its slope at t
    # is k/t too small. In the second half of the window this error is 3.7 times the difference to
    # the slope in the whole window. Half as much again allows for complex pairs.
    unsettled: float = 5.6
    longest: int = 20_000  # chosen: steps; bounds the time
    trusted: float = 0.75  # chosen: part of a box that is used; its corners distort the solution
    points: int = 60  # chosen: points on each side of 0 in the search for the largest ratio
    nearest: float = 1e-4  # chosen: the smallest positive one of them
    rounds: int = 6  # chosen: number of closer searches around the largest ratio
    near: int = 13  # chosen: points of each variable in a closer search
    rounding: float = 1e-11  # fitted: relative rounding error; linear scenes show up to 2e-12


ASSUMPTIONS = Assumptions()
LYAPUNOV = Lyapunov()
DRIFT_CONDITION = DriftCondition()
ERGODICITY = Ergodicity()
