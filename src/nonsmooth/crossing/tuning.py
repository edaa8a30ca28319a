"""The tuned numbers of the methods of this package."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Counting:
    """Sizes of the pilots and runs that count paths."""

    # chosen: level of the pilot's limits of the probability, that of three standard errors
    confidence: float = 0.997
    # chosen: paths of the pilot times the tolerance: one that changes sides is an eighth of it
    pilot: float = 12.0
    # fitted: counts by which the limits at that level are off where nothing has crossed
    skew: float = 5.1
    # chosen: largest factor of the paths for a probability that the pilot has not seen
    enlarge: float = 8
    # derived: times the work of the paths, as an eighth is run with the step and its half, too
    checked: float = 1 + 3 / 8
    # chosen: runs at a step whose bias fits in by the weak order; one is enough as a rule
    attempts: int = 3


COUNTING = Counting()
