"""Numbers that were chosen for crossings of the state, a record for each method."""

from dataclasses import dataclass

from nonsmooth.crossing.first_passage.problem import Part


@dataclass(frozen=True)
class Line:
    """Eigenfunctions of one variable."""

    tolerance: float = 1e-8  # chosen: absolute error unless the user asks for another
    degrees: tuple[int, ...] = (6, 9, 12, 16, 20, 26)  # chosen: of the elements, coarse to fine
    safety: float = 3.0  # chosen: the error is so many times the change of the last two degrees
    depth: float = 60.0  # chosen: an infinite level is replaced where m has fallen by exp(-60)
    deepest: float = 1e10  # derived: Phi at the start, whose rounding is far below that depth
    first_reach: float = 1.0  # chosen: sigmas from the start at which that search begins
    reach_step: float = 1.25  # chosen: factor of that search
    fewest: float = 8.0  # chosen: elements of the interval, at least
    layer: float = (
        2.0  # chosen: elements at a level, over the way of the noise up to the first time
    )
    finest: float = 1e-4  # chosen: smallest element over the interval; smaller ones lose digits
    steepest: float = 4.0  # chosen: change of Phi over an element, at most
    most: int = 100  # chosen: elements that such changes may ask for; then half a minute
    rounding: float = 0.02  # fitted: to values by closed forms, relative to eps degree^2 / width
    least: float = 1e-14  # derived: rounding of the sum over the modes


@dataclass(frozen=True)
class Plane:
    """The backward equation of two variables on tensor grids."""

    tolerance: float = 1e-4  # chosen: absolute error unless the user asks for another
    least: float = 1e-11  # derived: rounding of the steps
    spare: float = (
        6.0  # chosen: relative density at the end of the box, exp(-6) times the tolerance
    )
    # chosen: by how much deeper the box may be to reach a level. The density there is to be nothing
    # even if it is multiplied by a long time and by the rate of crossings, some hundred
    beyond: float = 15.0
    margin: float = 0.2  # chosen: by which the box is enlarged, to see whether its size matters
    around: float = 1.5  # chosen: the box ends at so many times the start, or farther out
    samples: int = 401  # chosen: points at which the height of the potential is looked for
    # chosen: times, over one that is asked for, at which changes count, too
    earlier: tuple[float, ...] = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
    elements: int = 6  # chosen: least number of elements of each variable
    layers: int = 2  # chosen: least number of ever smaller elements ...
    crowded: int = 1  # chosen: ... and of those at levels and where the flow turns
    # chosen: ratio of neighbouring distances from a level of a transported variable, and their
    # number. At early times a front leaves the level
    fronts: tuple[tuple[float, int], ...] = ((6.0, 1), (4.0, 3), (3.0, 6), (2.5, 9), (2.0, 13))
    turn_ratio: float = 2.5  # chosen: of neighbouring distances from the point where the flow turns
    rough_ratio: float = 3.0  # chosen: the same from a level of the variable that noise drives
    closest: float = 1e-7  # chosen: smallest element, over the size of the box
    first: float = 1e-2  # chosen: first step, over the first time
    # chosen: by how much steps are refined; 1.5 leaves a tenth of the error of 0.75 at most
    refined: tuple[float, ...] = (0.75, 1.5, 3.0, 6.0)
    per_length: float = 4.0  # chosen: steps before their length is doubled, unless refined
    # chosen: longest step up to late times; later there are so many before it is doubled
    longest: float = 0.2
    late: float = 20.0
    # chosen: tolerance from which on paths, some seconds, are faster than two levels
    faster_sampled: float = 2e-3


@dataclass(frozen=True)
class Sampled:
    """Monte Carlo."""

    # derived: least weak order of a path that is killed at the ends of an interval. Paths that are
    # seen between steps only miss an excursion of the size h^(3/2), and bridges are exact up to the
    # change of the drift in a step, also h^(3/2); so the stated bias is rather too large
    order: float = 1.0
    # chosen: largest step of rough paths, as the square of a part of the way to the nearer level
    part_of_way: float = 0.5
    least_tolerance: float = 1e-3  # chosen: paths replace a solver that fails, within minutes
    attempts: int = 10  # chosen: samples, each with the paths and the step that the last asked for
    # chosen: largest factor by which the step falls in one of them. The bias of a long step tells
    # little about short ones; all samples together then cost 4/3 of the last
    finer: float = 4.0


LINE = Line()
PLANE = Plane()
# degree, layers, steps. A change counts as a share of the one before at least; 0.1, 0.03 and 0.02
# were tried for their speed on five scenes. benchmarks/state_honesty.py has others
PLANE_PARTS = (
    Part(3, 6, -1, 0.02),
    Part(1, 4, -1, 0.02),
    Part(1, 3, -1, 0.02, counted=0.3),
)
SAMPLED = Sampled()
