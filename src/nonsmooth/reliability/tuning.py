"""The tuned numbers of the methods of this package."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Scale:
    """The few paths that tell how far int g gets, to begin a search."""

    paths: int = 8192  # chosen: a quantile to a per cent or two, a twentieth of a second
    longest: float = 100.0  # chosen: relaxation times that are simulated; later reach ~ sqrt(T)
    steps: float = 1e5  # chosen: of each path, at most; part of a second
    # chosen: of the guess of a time: how often the reach is sampled, the factor within which it
    # is near enough, and the powers of the time with which int g spreads late and early
    attempts: int = 8
    near: float = 1.1
    powers: tuple[float, float] = (0.5, 1.5)
    farthest: float = 1e6  # chosen: largest factor of one attempt
    # chosen: of the level of Brownian motion, as a power of the level; the scenes of the sweep have
    # 0.18 to 1.42, but for two in a hundred, where quantiles differ by noise
    slopes: tuple[float, float] = (0.2, 5.0)
    counted: float = 20.0  # chosen: paths beyond the outermost quantile that is read off


COUNTED = 2e-3  # chosen: error of W by paths that take the place of a solver


@dataclass(frozen=True)
class Search:
    """The search of a root of W."""

    share: float = 0.1  # chosen: of P and of 1 - P, the largest error of W unless tol is given
    surest: float = 1e-9  # chosen: least distance of P from 1; nearer ones are not told apart
    # chosen: distance in log T of times at which W is known for nothing, and how many of them there
    # are on either side of the first; with these, one is so near to the root that the slope does
    beside: float = 0.08
    places: int = 16
    # chosen: which of them, from the one that is nearest to the root, tell the slope
    telling: tuple[int, ...] = (-32, -6, -3, -1, 0, 1, 3, 6, 32)
    farthest: float = 10.0  # chosen: largest factor of one step of the secant method
    first: float = 2.0  # chosen: largest factor to the first limits
    close: float = 0.1  # chosen: distance of W from P, over the error of W, at which it ends
    ends: float = 50.0  # derived: log x within which Brownian motion crosses with any P but 0 and 1
    bend: float = 2.0  # chosen: relative change of the slope of log x* for a change of log x by 1
    # derived: the same for a change of log x* by 1, where W rises within a small part of x; with a
    # normal law it is below 1 for thresholds and 0.48 for times
    front: float = 1.0
    # chosen: largest doubt of the slope, and largest doubt of the root over the error
    doubt: float = 0.3
    vague: float = 1.0
    told: float = 1.0  # chosen: doubt from which on a guess of the slope is better
    wide: float = 10.0  # chosen: first step over the error, so that the slope is seen
    rounding: float = 1e-12  # derived: relative distance of roots that rounding cannot tell apart
    counted_rounding: float = 1e-6  # derived: the same of counted paths, some roundings of float32
    most: int = 30  # chosen: a bisection from a factor of 10 has 1e-8 then
    margin: float = 1.2  # chosen: of the first limits, over what the slope at the root tells
    widest: float = 100.0  # chosen: factor from the root to a limit, beyond which there is none


@dataclass(frozen=True)
class Grid:
    """Values at which sampled probabilities are inverted, in two passes."""

    # chosen: of the first pass: its values, the factor to either side of the guess, and the
    # tolerance over that of the second
    rough_values: int = 65
    rough_factor: float = 4.0
    rough_tolerance: float = 4.0
    values: int = 33  # chosen: of the second pass; their spacing is part of the stated interval
    margin: float = 0.5  # chosen: of the second pass beyond the interval of the first, over it
    attempts: int = 6  # chosen: shifts of a pass that does not contain the root
    # chosen: paths of a pass, at least; milliseconds, and a few hardly tell the bias of the step
    least_paths: int = 1000
    most_paths: float = 1e8  # chosen: minutes, and gigabytes for the bias of the step


@dataclass(frozen=True)
class TransformedMean:
    """The mean time from the transform on circles around 0."""

    line_tolerance: float = 1e-6  # chosen: one variable, seconds
    plane_tolerance: float = 1e-3  # chosen: two variables, a minute
    times: tuple[float, float] = (0.1, 4.0)  # chosen: over the mean, what a grid is made for
    small: float = 0.1  # chosen: z times the mean at which it is known to ten per cent
    later: float = 0.01  # chosen: z, over that, at which rare long times are looked for
    searches: int = 40  # chosen: of z, each at most half of the one before
    # chosen: of the circles, over the inverse mean; the leading pole is beyond the first unless
    # the start is much nearer to one threshold than to the other
    radii: tuple[float, ...] = (0.3, 0.1, 0.03, 0.01)
    nodes: int = 15  # chosen: of half a circle, a multiple of 3; (0.3)^10 is 6e-6, (0.1)^10 nothing
    # chosen: largest difference of two circles, over what the unseen error of F is on the smallest
    agreement: float = 5.0
    kept: float = 0.1  # chosen: a change between levels counts at least so much of the one before


@dataclass(frozen=True)
class SampledMean:
    """The mean time by Monte Carlo."""

    tolerance: float = 2e-2  # chosen: relative, seconds
    paths: int = 1024  # chosen: of the pilot
    left: float = 0.02  # chosen: part of the paths that may not have crossed at its end
    longer: float = 4.0  # chosen: factor by which it is prolonged
    most_steps: float = 1e5  # chosen: of each path of the pilot, some seconds
    tail: float = 0.05  # chosen: of the tolerance, part of the paths left at the end of the run


@dataclass(frozen=True)
class Hazard:
    """Differences of W over the logarithm of the time."""

    # chosen: of seven points, so that the error of the order 6 is far below that of W, 1e-7
    spacing: float = 0.05
    small: float = 0.1  # chosen: largest relative error of 1 - W; twice the error is stated for it
    few_digits: float = 2e-4  # chosen: error of W above which paths may tell more
    # chosen: log S jumps where it falls between two points so many times as much as beside, ...
    jump: float = 3.0
    beyond_doubt: float = 5.0  # chosen: ... and by so many errors more


HAZARD = Hazard()
TRANSFORMED_MEAN = TransformedMean()
SAMPLED_MEAN = SampledMean()
SCALE = Scale()
SEARCH = Search()
GRID = Grid()
