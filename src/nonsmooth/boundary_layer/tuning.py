"""The tuned numbers of the methods of this package."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Line:
    """The Milne problem of one variable, by spectral elements."""

    accuracy: float = 1e-8  # absolute, unless asked; chosen: far below what formulas need
    # chosen: from what suffices for smooth g to where rounding is all that is left
    degrees: tuple[int, ...] = (7, 9, 11, 13, 15, 17, 20)
    centred: float = 1e-9  # largest |E g| over the deviation of g; chosen: above rounding of E g


@dataclass(frozen=True)
class TwoVariables:
    """The Milne problem of two variables, on tensor grids."""

    accuracy: float = 1e-3  # absolute, unless asked; chosen: what takes up to two minutes
    # the box ends where the density is exp(-16) of its maximum; chosen: only 1e-7 is left outside
    depth: float = 16.0
    zero: float = 1e-13  # |g| up to this counts as 0, relative; derived: above rounding of g
    largest: int = 3000  # nodes with g != 0; chosen: a minute of dense linear algebra
    # correlation of g and its Poisson solution below which gamma^2 counts as 0; chosen: above the
    # discretisation error of a gamma^2 that is 0
    standstill: float = 1e-3
    gamma2: float = 1e-5  # relative error wanted of gamma^2; chosen: it costs less than the rest
    # the last change of a variable is at most the tolerance over this; derived: twice the changes
    # of both variables are half the tolerance; the other half is for what they change together
    safety: float = 8.0
    # smallest scale of a node over the largest; chosen: discrete densities are rounding below
    smallest_scale: float = 1e-10


@dataclass(frozen=True)
class Sampled:
    """kappa by Monte Carlo."""

    tolerance: float = 0.2  # relative error, unless asked; chosen: seconds, enough for a correction
    paths: int = 2000  # at first, doubled at each attempt; chosen: two blocks of paths
    # time after a passage at the first attempt, in units of the larger of 1 and 1 / C_b; chosen:
    # if that is the relaxation time, e^-4 = 2 % is left of correlations
    lag: float = 4.0
    cycles: int = 75  # duration of a path over that time; chosen: dozens of passages on each path
    # threshold over the standard deviation of what int g gains in that time; chosen: the start of a
    # cycle is forgotten at the passage
    far: float = 2.0
    attempts: int = 3  # each with more paths and time; chosen: a minute
    # tolerance of the simulation that gives the mean of int g from the start; chosen: quick
    start: float = 0.05
    # paths that measure the bias of the step: the least number, and one in so many of all paths;
    # chosen: with whole and half steps they cost three quarters of what the others cost
    pilot_paths: int = 1000
    halved: int = 4


LINE = Line()
TWO_VARIABLES = TwoVariables()
SAMPLED = Sampled()
