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

    farthest_noise: float = 60.0  # chosen: search to here; enough for noises of variance up to 30
    noise_points: int = 24_001  # chosen: points of that search, which are 0.0025 apart
    rays: int = 64  # chosen: directions searched in the plane of (eta, zeta), 6 degrees apart
    ray_stride: int = 20  # chosen: on a ray one point in so many is used; these are 0.05 apart
    near: float = 3.0  # chosen: radius within which the noise's least dissipation is looked for
    least_dissipation: float = 1e-2  # chosen: keeps the box finite where F vanishes
    least: float = 0.1  # chosen: smallest half width, for noise that hardly moves
    spare: float = 1.02  # chosen: widens what was found, by more than the spacing of the points
    # chosen: first, last and number of the displacements searched, a wide range in steps of 0.4 %
    displacements: tuple[float, float, int] = (1e-3, 1e4, 4001)


@dataclass(frozen=True)
class Elements:
    """How many elements there are, and how they are graded towards a kink."""

    ratio: float = 4.0  # chosen: of neighbouring distances from a kink; more needs high degrees
    ratio_at_origin: float = 2.5  # chosen: the same where the kink is at 0
    # chosen: at the kink of friction elements end so many factors of `ratio` earlier, because the
    # kink's distance from 0 is itself the smallest scale
    coarser_at_friction: float = 1.5
    # chosen: smallest element at a kink relative to the layer it lies in, at most; elastic walls,
    # which throw the oscillator back, need no such small ones
    stopping: float = 1 / 64
    within_wall: tuple[float, ...] = (0.5, 0.75)  # chosen: edges in an elastic wall, over its depth
    widest: float = 2.2  # chosen: no element is wider than the half width divided by this
    driven: int = 3  # derived: elements without a kink; with odd degrees an even number of nodes
    transported: int = 4  # derived: the same for discontinuous elements, with any degree
    few_layers: int = 1  # chosen: smaller elements towards a kink, with three or four variables
    more_layers: int = 2  # chosen: the same for forcing and velocity, in which solutions bend most
    # chosen: the same for the density of a displacement that yields, which is steep where it leaves
    # the kink; with 1 in the place of 4 its averages take twenty times as long
    layers_of_yielding: int = 4
    # chosen: height of a potential at the ends of a usual box, in temperatures; a temperature that
    # is not known is estimated by it
    depth: float = 20.0
    bend: float = 1.0  # chosen: temperatures by which a potential may bend in an element
    samples: int = 16  # chosen: points of an element at which the bend is measured
    # chosen: temperatures by which it bends in a part of an element, beyond which no degree that
    # can be afforded resolves its density
    steepest: float = 1e3
    most_parts: int = 9  # chosen: into which an element is split for the bend; bounds the cost


@dataclass(frozen=True)
class Layers:
    """Elements of densities that are concentrated along a line."""

    width: float = 6.0  # chosen: of the elements on level 0, in standard deviations of the lag
    narrower: float = 0.25  # chosen: what each level adds to 1 over the width, relative to level 0
    fewest: int = 4  # chosen: elements of a half width on level 0; each level adds one
    degree: int = 4  # chosen: on level 0; each level adds one
    # chosen: the last of the growing elements is left out if less of it than this would remain
    spare: float = 0.3
    ratio: float = 3.0  # chosen: of the elements that crowd where solutions are least smooth
    corner: int = 3  # chosen: powers of the ratio by which these are smaller than a half width
    distinct: float = 1e-9  # chosen: relative distance below which two edges are one
    # chosen: elements of a half width on level 0, at most; layers that need more are not resolved
    most: int = 32
    rim: float = 0.05  # chosen: width of the constant elements at the ends, over the half width


@dataclass(frozen=True)
class Hermite:
    """Polynomials of a normal variable; both numbers are even, as symmetry needs them."""

    fewest: int = 6  # chosen: nodes on level 0
    added: int = 4  # chosen: nodes that each level adds


@dataclass(frozen=True)
class AlternatingDirections:
    """The iteration for three and four variables."""

    depth: float = 14.0  # chosen: residuals are weighted with a density, exp(-14) at the box's ends
    krylov: int = 150  # chosen: vectors that GMRES keeps between restarts, as memory allows
    restarts: int = 4  # chosen: of GMRES; scenes that need more mix too slowly for this method
    pilot_accuracy: float = 1e-5  # chosen: residual of the solutions by which shifts are compared
    # chosen: to be tried, from the likeliest one on
    shifts: tuple[float, ...] = (2.5, 5.0, 10.0, 20.0, 40.0)
    shift: float = 5.0  # chosen: the likeliest


@dataclass(frozen=True)
class TensorGrids:
    """Box and largest size of tensor grids."""

    margin: float = 0.15  # chosen: by which the box is enlarged, to see whether its size matters
    spare: float = 10.0  # chosen: relative density at the box's end, exp(-10) times the tolerance
    fits: int = 4  # chosen: how often the box is fitted at most; it settles after two or three
    settled: float = 0.15  # chosen: relative change of half widths below which the fit ends
    fit_accuracy: float = 1e-2  # chosen: of the density that the box is fitted to
    # chosen: the tails are extrapolated from the distance beyond which there is so much mass, which
    # coarse grids still resolve
    tail: float = 1e-3
    normal_tail: float = 3.29  # derived: standard deviations beyond which a normal law has `tail`
    widening: float = 1.5  # chosen: largest factor by which one fit may widen the box
    around: float = 1.25  # chosen: a box that contains the start reaches so many times as far
    # chosen: largest number of grid points by that of variables, some minutes and gigabytes
    largest: Mapping[int, int] = field(
        default_factory=lambda: {2: 120_000, 3: 600_000, 4: 2_500_000}
    )
    # chosen: seconds that a program waits at its end until sparse factors are freed
    to_close: float = 1.0


@dataclass(frozen=True)
class UniformRefinement:
    """Grids of two variables that are refined in both."""

    highest: int = 4  # chosen: last level; what needs more is left to the combination technique
    safety: float = 2.0  # chosen: the error is so many times the difference of two levels
    # chosen: largest factor by which a level reduces the error; if the change falls by more, the
    # error has changed its sign
    gain: float = 30.0
    boxed: int = 1  # chosen: first level on which a larger box is tried; few need a finer one


@dataclass(frozen=True)
class CombinationTechnique:
    """How surpluses that were not computed are estimated."""

    # chosen: a surplus is taken to be at least this part of the one two levels below, because the
    # one directly below may be small by chance
    relapse: float = 0.25
    mixed: float = 0.25  # chosen: factor on surpluses where two or more variables are raised
    # chosen: the same for displacement and velocity, or forcing and velocity, refined separately;
    # the motion mixes them
    mixed_by_motion: float = 1.0


@dataclass(frozen=True)
class PotentialWells:
    """Which wells of a potential hold a path."""

    depth: float = 20.0  # chosen: of the box that is searched, see `mesh.box.half_widths`
    points: int = 4001  # chosen: at which each potential is evaluated
    stiff: float = 1e6  # chosen: at n = inf the box of this n is searched
    barrier: float = 2.0  # chosen: lower barriers, in temperatures, hold no path up for long
    most: int = 4  # chosen: wells of one variable, of which the deepest are kept; bounds the cost
    # chosen: displacements that are searched if nothing bounds them, and half width of velocities
    # so low that any barrier holds a path
    far: float = 20.0
    cold: float = 1e-3


BOX = Box()
ELEMENTS = Elements()
LAYERS = Layers()
HERMITE = Hermite()
ALTERNATING_DIRECTIONS = AlternatingDirections()
TENSOR_GRIDS = TensorGrids()
UNIFORM_REFINEMENT = UniformRefinement()
COMBINATION_TECHNIQUE = CombinationTechnique()
POTENTIAL_WELLS = PotentialWells()
