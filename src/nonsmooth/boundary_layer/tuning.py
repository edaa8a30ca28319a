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
    # a box of depth d has a density of the order exp(-d) outside; kappa is found in a box of the
    # depth log(1/tol) plus this, and deeper ones are harder to resolve; fitted: the effect of
    # the box is a hundredth of the tolerance
    spare: float = 5.0
    depth: float = 16.0  # chosen: of the box of the Poisson solution; only 1e-7 is left outside
    coarsest: int = 2  # chosen: levels from which the combination is tried to start
    # chosen: work for one combination, in units of the largest grid; bounds the time
    work: float = 3.0
    # how many times the first change by a variable counts; chosen: next to a soft wall it is a
    # third of all that follows
    alone: float = 3.0
    # chosen: changes between coarse grids may be small by chance; the error is at least so much of
    # tol
    by_chance: float = 0.01
    zero: float = 1e-13  # |g| up to this counts as 0, relative; derived: above rounding of g
    # distance of a threshold over kappa; chosen: nearer, the orders 2 and 3 mean little
    nearest: float = 3.0
    largest: int = 3000  # nodes with g != 0; chosen: half a minute of dense linear algebra
    gamma2: float = 1e-5  # relative error wanted of gamma^2; chosen: it costs less than the rest
    rounding: float = 1e-10  # chosen: relative, of the Poisson solution by sparse factors
    # smallest scale of a node over the largest; chosen: discrete densities are rounding below
    smallest_scale: float = 1e-10


@dataclass(frozen=True)
class Sampled:
    """kappa by Monte Carlo."""

    # relative error of the gain, unless asked; chosen: seconds, enough for a correction
    tolerance: float = 0.2
    tolerance_on_grids: float = 0.1  # chosen: the same where u is known, for some seconds
    share: float = 0.8  # chosen: part of the tolerance that is left to the paths where u is known
    scatter: float = 0.4  # chosen: part of the tolerance that the scatter is to have
    more: float = 8.0  # chosen: largest factor on the number of paths from one attempt to the next
    paths: int = 2000  # at the first attempt; chosen: two blocks of paths
    # time after a passage at the first attempt, in units of the larger of 1 and 1 / C_b; chosen:
    # if that is the relaxation time, e^-4 = 2 % is left of correlations; scenes that yield need
    # several times as much
    lag: float = 4.0
    cycles: int = 25  # duration of a path over that time; chosen: several passages on each path
    # threshold over the standard deviation of what int g gains in that time; chosen: the start of a
    # cycle is forgotten at the passage
    far: float = 2.0
    # error of a threshold over what halving it changes; chosen: a fifth covers layers that fall
    # more slowly than those seen, and two is cause enough for a larger threshold
    least: float = 0.2
    largest: float = 2.0
    farther: float = 2.0  # chosen: factor on the threshold from one attempt to the next
    # largest number of steps of all paths, over that of the first attempt; chosen: a minute
    work: float = 128.0
    # tolerance of the simulation that gives the mean of int g from the start; chosen: quick
    start: float = 0.05
    # paths that measure the bias of the step: the least number, and one in so many of all paths;
    # chosen: with whole and half steps they cost three quarters of what the others cost
    pilot_paths: int = 500
    halved: int = 4


@dataclass(frozen=True)
class Poisson:
    """The Poisson solution at points."""

    coarse: float = 1e-2  # chosen: relative error meant by the coarse grid, which sampling uses
    points: int = 20_000  # chosen: at which the finer solutions are compared with the coarse one
    at_start: float = 1e-2  # chosen: error of the value at the start, over kappa


LINE = Line()
TWO_VARIABLES = TwoVariables()
SAMPLED = Sampled()
POISSON = Poisson()
