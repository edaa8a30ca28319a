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
    positive: float = 1e-3  # chosen: the assumptions want beta > 0, and any larger value is one too
    safety: float = 1e-9  # chosen: relative, far above the error of the refined suprema
    quadratic: float = 1e-6  # chosen: U / x^2 that counts as none at infinity
    inside: int = 2001  # chosen: points of [-1, 1] on which the steepest slope of U is found
    inside_safety: float = 1e-3  # chosen: relative, above what is missed between them


@dataclass(frozen=True)
class Lyapunov:
    """How far the constants of V_n are from their bounds."""

    slack: float = 1.01  # chosen: the inequalities (14) are strict


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
    floor: float = 1e-10  # chosen: to there; above rounding, which is relative to the first norm
    # derived: eigenvalues that coincide, or nearly, make the norm t^k exp(-rate t). The slope in
    # the middle of an interval is then k/t too small: in its second half, 3.7 times as much as it
    # has changed since all of it. Half as much again allows for complex pairs.
    unsettled: float = 5.6
    longest: int = 20_000  # chosen: steps; bounds the time
    trusted: float = 0.75  # chosen: of a box, in whose corners the solution sees where it ends
    points: int = 60  # chosen: on each side of 0, of the search for the largest ratio
    nearest: float = 1e-4  # chosen: the first of them
    rounds: int = 6  # chosen: closer looks at the largest ratio
    near: int = 13  # chosen: points of each variable in a closer look
    rounding: float = 1e-11  # fitted: linear scenes have up to 2e-12, relative


ASSUMPTIONS = Assumptions()
LYAPUNOV = Lyapunov()
DRIFT_CONDITION = DriftCondition()
ERGODICITY = Ergodicity()
