"""The tuned numbers of the methods of this package."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Sampled:
    """kappa by Monte Carlo."""

    tolerance: float = 0.2  # relative error, unless asked; chosen: seconds, enough for a correction
    paths: int = 2000  # at first, doubled at each attempt; chosen: two blocks of paths
    # time after a passage, in units of the larger of 1 and 1 / C_b, at first; chosen: e^-4 = 2 %
    lag: float = 4.0
    cycles: int = 75  # duration of a path over that time; chosen: dozens of passages on each path
    # threshold over the standard deviation of what int g gains in that time; chosen: the start of a
    # cycle is forgotten at the passage
    far: float = 2.0
    attempts: int = 3  # each with more paths and time; chosen: a minute
    start: float = 0.05  # relative error of the variance for the mean from the start; chosen
    # paths that measure the bias of the step: at least, and one in so many of all; chosen: their
    # steps and half steps cost as much as the others
    pilot_paths: int = 1000
    halved: int = 4


SAMPLED = Sampled()
