"""The tuned numbers of the methods of this package."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Scale:
    """The few paths that tell how far int g gets, to begin a search."""

    paths: int = 1024  # chosen: a quantile to some per cent
    longest: float = 100.0  # chosen: relaxation times that are simulated; later reach ~ sqrt(T)
    counted: float = 20.0  # chosen: paths beyond the outermost quantile that is read off


@dataclass(frozen=True)
class Search:
    """The search of a root of W."""

    share: float = 0.1  # chosen: of P and of 1 - P, the largest error of W unless tol is given
    farthest: float = 2.0  # chosen: largest factor of one step of the secant method
    close: float = 0.1  # chosen: distance of W from P, over the error of W, at which it ends
    rounding: float = 1e-12  # derived: relative distance of roots that rounding cannot tell apart
    most: int = 30  # chosen: a bisection from a factor of 2 has 1e-9 then
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


SCALE = Scale()
SEARCH = Search()
GRID = Grid()
