"""Numbers that were chosen for the methods on grids, one record for each method.

Each line says what the number is and where it comes from. That stated errors hold with these
numbers is tested on random scenes by `benchmarks/honesty.py`; what they cost is measured by
`benchmarks/requests.py`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Box:
    """How the half widths of the box are searched for."""

    farthest_noise: float = 60.0  # chosen: above the reach of noises whose variance is up to 30
    noise_points: int = 24_001  # chosen: half widths of noise to 0.0025
    rays: int = 64  # chosen: directions in the plane of (eta, zeta), 6 degrees apart
    ray_stride: int = 20  # chosen: every so many points on a ray, half widths to 0.05
    near: float = 3.0  # chosen: radius within which the noise's least dissipation is looked for
    least_dissipation: float = 1e-2  # chosen: keeps the box finite where F vanishes
    least: float = 0.1  # chosen: half width of noise that hardly moves
    spare: float = 1.02  # chosen: above the spacing of what was searched
    displacements: tuple[float, float, int] = (1e-3, 1e4, 4001)  # chosen: first, last, number


@dataclass(frozen=True)
class Elements:
    """How many elements there are, and how they are graded towards a kink."""

    ratio: float = 4.0  # chosen: of neighbouring elements at a kink; larger ones need high degrees
    ratio_at_origin: float = 2.5  # chosen: the same where the kink is at 0
    coarser_at_friction: float = 1.5  # chosen: layers that the kink of friction does without
    stopping: float = 1 / 64  # chosen: finest element in a layer that only stops, to its thickness
    within_wall: tuple[float, ...] = (0.5, 0.75)  # chosen: edges in an elastic wall, to its depth
    widest: float = 2.2  # chosen: no element is wider than the half width divided by this
    driven: int = 3  # derived: with odd degrees, the number of continuous nodes is even
    transported: int = 4  # derived: the number of discontinuous nodes is even
    few_layers: int = 1  # chosen: towards a kink, with three or four variables
    more_layers: int = 2  # chosen: the same for the forcing and the velocity, where it bends most
    depth: float = 20.0  # chosen: of a usual box in temperatures, from which these are estimated
    bend: float = 1.0  # chosen: temperatures by which a potential may bend in an element
    samples: int = 16  # chosen: points of an element at which the bend is measured
    most_parts: int = 9  # chosen: of an element that is split for the bend; bounds the cost


@dataclass(frozen=True)
class AlternatingDirections:
    """The iteration for three and four variables."""

    depth: float = 14.0  # chosen: of the normal density that weights residuals, at the box's ends
    krylov: int = 150  # chosen: vectors kept by GMRES, as memory allows
    restarts: int = 4  # chosen: scenes that need more mix too slowly for this method
    pilot_accuracy: float = 1e-5  # chosen: of the solutions that compare shifts
    shifts: tuple[float, ...] = (12.0, 5.0, 30.0, 2.0)  # chosen: the likeliest to be best first


@dataclass(frozen=True)
class TensorGrids:
    """Box and largest size of tensor grids."""

    margin: float = 0.15  # chosen: of the box, to see whether its size matters
    spare: float = 10.0  # chosen: what the box leaves out is exp(-10) times the tolerance
    fits: int = 4  # chosen: times that the box is fitted; it settles after two or three
    settled: float = 0.15  # chosen: relative change of half widths that is left alone
    fit_accuracy: float = 1e-2  # chosen: of the density that the box is fitted to
    tail: float = 1e-3  # chosen: mass outside a box that coarse grids see, to be extrapolated from
    normal_tail: float = 3.29  # derived: standard deviations beyond which a normal law has `tail`
    widening: float = 1.5  # chosen: most that one fit may widen the box
    # chosen: grid points by the number of variables, some minutes and gigabytes
    largest: Mapping[int, int] = field(
        default_factory=lambda: {2: 120_000, 3: 600_000, 4: 2_500_000}
    )


@dataclass(frozen=True)
class UniformRefinement:
    """Grids of two variables that are refined in both."""

    highest: int = 4  # chosen: last level; what needs more is left to the combination technique
    safety: float = 2.0  # chosen: times the difference of two levels
    # chosen: a level reduces the error at most so many times; if the change is smaller still, the
    # error has changed its sign
    gain: float = 30.0
    boxed: int = 1  # chosen: level on which a larger box is tried; on finer ones it matters less


@dataclass(frozen=True)
class CombinationTechnique:
    """How surpluses that were not computed are bounded."""

    relapse: float = 0.25  # chosen: part of the surplus before the last, if that is small by chance
    mixed: float = 0.25  # chosen: part of a surplus that is left if another variable is raised too


@dataclass(frozen=True)
class PotentialWells:
    """Which wells of a potential hold a path."""

    depth: float = 20.0  # chosen: of the box that is searched, in temperatures
    points: int = 4001  # chosen: of the search
    stiff: float = 1e6  # chosen: n whose box is searched at n = inf
    barrier: float = 2.0  # chosen: temperatures below which a barrier holds no path up for long
    most: int = 4  # chosen: wells of one variable, the deepest; bounds the cost


BOX = Box()
ELEMENTS = Elements()
ALTERNATING_DIRECTIONS = AlternatingDirections()
TENSOR_GRIDS = TensorGrids()
UNIFORM_REFINEMENT = UniformRefinement()
COMBINATION_TECHNIQUE = CombinationTechnique()
POTENTIAL_WELLS = PotentialWells()
