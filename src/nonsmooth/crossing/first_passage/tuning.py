"""Numbers that were chosen for first-passage problems, a record for each method."""

from dataclasses import dataclass, replace
from typing import NamedTuple

from nonsmooth.crossing.first_passage.problem import ContourLevel, ContourSettings, Part
from nonsmooth.kinetic.tuning import GibbsLevel, PlaneLevel


@dataclass(frozen=True)
class Contours:
    """Hyperbolic contours of the inverse Laplace transform."""

    spare: int = 3  # chosen: nodes that are prepared, over those that a bounded transform needs
    farthest: float = 7.0  # derived: parameter of the last node, exp(7)/2 saddles away from 0
    of_width: float = 0.85  # derived: spacing, in standard deviations, that gives a normal
    #                         integrand ten digits
    of_saddle: float = 0.25  # chosen: spacing near the pole at 0, over the distance of the saddle
    # chosen: near steep arms the transform soon grows, so the spacing is multiplied by 0.45 +
    # tilt / 0.7 if that is below 1
    steep: tuple[float, float] = (0.45, 0.7)
    truncation_most: int = 100  # chosen: largest number of terms on a contour; the rest is dropped


@dataclass(frozen=True)
class ContourFits:
    """Rational fits of a transform to its values at some nodes of contours."""

    first: int = 4  # chosen: distance of the nodes that are evaluated first
    # derived: then, of each so many nodes, those at these places one by one: each halves gaps
    period: int = 8
    then: tuple[int, ...] = (2, 6, 1, 5, 3, 7)
    share: float = 0.02  # chosen: largest last change of a probability, over the tolerance
    # chosen: a looser tolerance counts as this one, because stated errors may be far below it
    loosest: float = 1e-4
    closeness: float = 1e-3  # chosen: error of a fit at the known values, over that largest change


@dataclass(frozen=True)
class SaddlePoints:
    """Search for the saddle point of exp(z t) F(z) / z on the axis, and for usable contours.

    The arms of a contour point to the left of the vertical by some angle. On them exp(z t) falls
    by |z| t sin(angle) in the exponent, while |F(z)| may grow. It is measured at some angles.
    """

    inexact: float = 0.05  # chosen: so far outside of [0, 1] is no value of F on a coarse grid
    angles: tuple[float, ...] = (0.2, 0.4, 0.67)  # chosen: at which the growth of |F| is measured
    steepest: float = 0.0  # chosen: angle of a contour if |F| grows too much at all of them
    since: float = 2.0  # chosen: a time over that at which a contour has a larger angle, from
    #                     which on two variables are as accurate as later
    tamed: float = 0.3  # chosen: largest growth over fall on a contour through the saddle point
    tame: float = 0.08  # chosen: largest growth over fall on a hyperbola
    harmless: float = 0.7  # chosen: growth of log |F| that is ignored; poles near the axis cause it
    negligibly: float = 30.0  # derived: where exp(z t) < exp(-30) growth does not matter
    # chosen: for a hyperbola growth matters only where |z| t is larger; poles nearer to 0 are
    # inside the contour
    far: float = 6.0
    risen: float = 0.05  # chosen: hyperbolas serve where the probability's bound is at least this
    spacing: float = 0.6  # chosen: distance of samples of log F in log z, for a spline
    fine: float = 0.01  # chosen: distance in log z at which the spline is searched
    first: float = 0.1  # chosen: smallest z t examined
    largest: float = 150.0  # chosen: largest z t examined
    least_bend: float = 0.1  # chosen: least second derivative in log z; smaller ones are rounding


@dataclass(frozen=True)
class Hyperbola:
    """A kind of hyperbola.

    Attributes
    ----------
    sector : float
        Half angle of the sector around the negative axis that has the poles of F, and in which F
        grows.
    ratio : float
        Largest ratio of last to first time.
    more : int
        Number of nodes in addition to those of a level.
    since : float
        Earliest time at which this kind serves, over the earliest at which any hyperbola does.
    """

    sector: float
    ratio: float
    more: int
    since: float


@dataclass(frozen=True)
class Inversion:
    """Windows of times, each of which is served by one contour."""

    per_decade: float = 8.0  # chosen: additional nodes for each decade of times
    shortest: float = 3.0  # chosen: least ratio of last to first time for which a hyperbola is made
    growth: float = 1e4  # chosen: largest growth of the probability's bound in a window of the rise
    # chosen: soon after the rise, poles off the axis contribute; at three times that time their
    # contribution has decayed
    early: Hyperbola = Hyperbola(sector=0.9, ratio=4.0, more=10, since=1.0)
    steady: Hyperbola = Hyperbola(sector=0.3, ratio=20.0, more=3, since=3.0)
    # chosen: a probability below this part of the least one is negligible, whatever its error: two
    # levels and their difference all stay below the least one
    surely: float = 0.1
    small: float = 1e-3  # chosen: smaller survival probabilities get contours of their own


@dataclass(frozen=True)
class VerticalLines:
    """Rational fits on vertical lines."""

    step: float = 1.44  # chosen: ratio of heights; places in between are sampled to check the fit
    first: float = 0.1  # chosen: least height, times the mean duration
    least: float = 1e-12  # derived: rounding of 1 - F
    beyond: int = 2  # chosen: so many samples in a row must be negligible
    # chosen: unit of places, over the abscissa; poles come out wrong where most places are far from
    # 1, above it most of all. From 10 to 10^4 it makes no difference
    unit: float = 100.0
    far: tuple[float, ...] = (2.0, 4.0, 8.0, 30.0, 100.0)  # chosen: heights at which F is 0
    # chosen: errors below the second number that more samples do not make smaller by the first are
    # rounding; larger ones are turns of F
    falls: float = 0.5
    rounded: float = 1e-6
    closest: float = 1.001  # chosen: ratio of heights between which no sample is added
    most: int = 250  # chosen: number of samples from which no more are added
    terms: int = 100  # chosen: largest number of terms of a fit
    rounding: float = 1e-14  # derived: relative size of singular values that are rounding
    phase: float = 1e-14  # derived: rounding of exp(-z t_0) is so many times |z| t_0
    # chosen: a fit is made so much better than it has to be, or worse where that is better
    shares: tuple[float, ...] = (0.1, 1.0, 10.0, 100.0)
    accuracy: float = 0.1  # chosen: of a fit, over the tolerance, ...
    best: float = 1e-10  # chosen: ... and the best, above rounding, ...
    rising: float = 1e-7  # chosen: ... also in the rise, where F is rounded more
    negligible: float = 0.1  # chosen: a share of F below so much of the accuracy counts as none
    # chosen: in the rise, where small probabilities keep this relative accuracy, or that of `tol`
    relative: float = 1e-6
    # chosen: error of an inverse over that of F and exp(s t), a logarithm of heights over pi
    inverse: float = 3.0
    # chosen: of neighbouring lines in the rise; a bound is then at most some 100 times Chernoff's
    ratio: float = 4.0


@dataclass(frozen=True)
class Refinement:
    """The error, from the differences of levels."""

    # fitted: rounding error of a survival probability for each relaxation time, found by comparison
    # with the corrected formula of order 2 for slow crossings. It is larger without symmetry, where
    # `case_modes` does not treat the slow mode apart.
    rounding: float = 1e-13
    rounding_odd: float = 1e-14
    # fitted: benchmarks/crossing_honesty.py; factor on the difference of two levels, above 1 where
    # levels converge irregularly
    safety: float = 3.0
    # chosen: two levels that were asked for tol may agree better than either is right; the error is
    # at least so much of tol
    by_chance: float = 1e-3
    nearby: float = 2.0  # chosen: times within this factor share their errors
    underflow: float = 1e-300  # derived: about the smallest normal number
    exact: float = 1e-12  # chosen: smaller errors are kept, not replaced by the complement's error
    complement: float = 1e-15  # derived: rounding of 1 minus a probability


@dataclass(frozen=True)
class LineGrids:
    """Grids of one state variable."""

    coarse: int = 6  # chosen: polynomial degree for the choice of contours
    spare: float = 18.0  # chosen: what is neglected is exp(-18) of the probability
    depth: float = 26.0  # chosen: the grid ends where the density is exp(-26) of the probability
    many: int = 100  # chosen: nodes from which on a basis of few functions may be quicker
    similar: float = 4.0  # chosen: walls share grids if they are at most so many times as far


@dataclass(frozen=True)
class FarStart:
    """A start in the tails of one state variable."""

    depth: float = 16.0  # chosen: beyond this depth of the start the modes lose digits
    neglected: float = 1e-9  # derived: what `tail_descent` leaves out of the normal laws, and more


@dataclass(frozen=True)
class EachPart:
    """Refinement of one part of a resolution at a time."""

    enough: float = 0.8  # chosen: parts are refined until the error should be so much of tol
    # chosen: what extrapolation changes counts as so much of what it changed before, at least
    again: float = 0.5
    loose: float = 1e-3  # chosen: tolerance from which some parts begin coarser by one
    # chosen: changes up to so much of tol are left as they are; those of four parts may be met
    settled: float = 0.2
    # chosen: parts are measured with the others coarse if what the sum of their changes missed of
    # the change by refining them together is at most so much of tol
    additive: float = 0.3
    # chosen: there is no hope if the changes that are left at the finest resolution, extrapolated
    # from two of them, are so many times the tolerance
    hopeless: float = 10.0
    # chosen: where steps may do, contours that miss the tolerance give way after so many rounds,
    # and steps as well, unless their error is below so many times the tolerance
    tried: int = 2
    close: float = 3.0
    # chosen: how often the error may grow: grids that see a layer for the first time change more
    # than coarser ones
    patience: int = 1


@dataclass(frozen=True)
class PlaneTransform:
    """The transform of two state variables, and real z from whose solutions bases are taken."""

    least: float = 1.0  # chosen: least z times the last time, ...
    largest: float = 10.0  # chosen: ... and largest z times the first time
    shortest: float = 1e-6  # chosen: least mean duration in relaxation times, above rounding
    exponents: tuple[float, ...] = (0.5, 1.0, 2.0)  # chosen: z t at which W is bounded ...
    coarse: float = 1e-6  # chosen: ... with F on a coarse grid, whose error is far below this
    widest: float = 1.75  # chosen: decades of these z that have one part, ...
    parts: int = 1  # chosen: ... which is divided into so many for the first basis
    similar: float = 8.0  # chosen: longest over shortest of the intervals that share a basis
    # chosen: error of solutions on the coarsest grid by rounding, from which on slabs are doubled;
    # on finer grids it is up to 1e5 times as large, and bases leave out what is less than 1e-6
    rounding: float = 5e-13
    changed: float = 0.1  # chosen: part of a parameter by which the solutions of a basis differ


class Basis(NamedTuple):
    """How a grid is reduced: the real z of each are half as far apart as those of the one before.

    Attributes
    ----------
    accuracy, adjoint : float
        Relative sizes of what is left out of solutions, and of adjoint ones.
    least : float
        Least depth of a solution, relative to the way that int g goes in a relaxation time.
    """

    accuracy: float
    adjoint: float
    least: float


@dataclass(frozen=True)
class NearWall:
    """Thresholds that are too near for grids of two variables."""

    first: float = 1e-8  # chosen: relaxation times after which a threshold may be crossed
    times: int = 200  # chosen: times at which paths are followed, up to one relaxation time
    straight: float = 2.0  # chosen: a path that starts at half of the speed needs no resolution
    # chosen: least reach of the state, over the half width of the grid; at a quarter of it errors
    # were wrong, at half of it no tolerance was met
    share: float = 0.05


@dataclass(frozen=True)
class PlaneGrids:
    """Grids of two state variables by their resolution."""

    driven: tuple[int, ...] = (3, 4, 5, 6, 7, 9, 11, 13)  # chosen: polynomial degrees
    # chosen: the same if g depends on it, with the half axis over the finest element; in wide
    # elements solutions of degrees from 8 on grow
    observed: tuple[tuple[int, float], ...] = (
        (4, 3.0),
        (5, 3.0),
        (6, 3.0),
        (7, 3.0),
        (7, 9.0),
        (9, 9.0),
        (11, 9.0),
        (13, 9.0),
    )
    # chosen: degrees between the middle and a wall, and edges over its place; next to the wall,
    # where the velocity is 0, solutions are singular, and higher degrees alone do not converge ...
    between: tuple[tuple[int, tuple[float, ...]], ...] = tuple(
        (degree, (0.5, 0.9, 0.98)) for degree in (2, 3, 4, 5, 6, 7, 8, 10)
    )
    # chosen: ... unless the wall is soft
    soft: tuple[tuple[int, tuple[float, ...]], ...] = tuple(
        (degree, ()) for degree in (7, 9, 11, 13, 15, 17, 19, 23)
    )
    other: tuple[tuple[int, float, float], ...] = (
        (2, 8.0, 0.05),
        (3, 8.0, 0.03),
        (4, 8.0, 0.03),
        (5, 8.0, 0.03),
        (6, 8.0, 0.02),
        (7, 6.0, 0.02),
        (8, 6.0, 0.01),
        (10, 6.0, 0.01),
    )
    hermite: tuple[int, ...] = (6, 8, 12, 16, 20, 26, 34, 44)
    elements: tuple[tuple[int, tuple[float, ...], tuple[float, ...]], ...] = (
        (3, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (4, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (5, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (5, (0.05, 0.2, 0.5, 1.0), (0.5, 1.0)),
        (6, (0.05, 0.2, 0.5, 1.0), (0.5, 1.0)),
        (7, (0.05, 0.2, 0.5, 1.0), (0.5, 1.0)),
        (8, (0.05, 0.2, 0.5, 1.0), (0.5, 1.0)),
        (10, (0.05, 0.2, 0.5, 1.0), (0.5, 1.0)),
    )
    dropped: float = 1e-6  # chosen: share of E |g| at nodes that are taken to stand still

    def plane(self, driven: int, other: int) -> PlaneLevel:
        """Level of a tensor grid."""
        return PlaneLevel(
            self.driven[driven],
            self.observed[driven],
            self.between[other],
            *self.other[other],
            self.dropped,
            self.soft[other],
        )

    def gibbs(self, driven: int, other: int) -> GibbsLevel:
        """Level of a grid in Hermite polynomials of the driven variable."""
        return GibbsLevel(self.hermite[driven], *self.elements[other], self.dropped)


@dataclass(frozen=True)
class TimeStepping:
    """Steps in time of two state variables."""

    until: float = 10.0  # chosen: last time, in relaxation times; later the transform is tame
    latest: float = 40.0  # chosen: last time where contours miss the tolerance, or it is near ...
    near: float = 8.0  # chosen: ... as of at most so many times one that needs steps
    narrow: float = 3.0  # chosen: an interval's length, in ways that int g goes in a relaxation
    #                      time, up to which steps are faster than contours
    ratio: float = 2.0  # chosen: ratio of the widths of neighbouring elements in x
    # chosen: polynomial degree in x; the smallest element over the lesser of the distance to the
    # threshold and of the way that int g goes in a relaxation time; the largest over the distance
    elements: tuple[tuple[int, float, float], ...] = (
        (2, 4e-2, 0.3),
        (3, 2e-2, 0.25),
        (4, 1e-2, 0.2),
        (5, 5e-3, 0.15),
        (6, 2e-3, 0.12),
        (7, 1e-3, 0.1),
    )
    # chosen: lengths, relative to ...
    steps: tuple[float, ...] = (4.0, 2.0, 1.0, 0.5, 0.25, 0.125, 0.0625)
    longest: float = 0.05  # chosen: ... the longest step, in times of the fastest rate, and to ...
    first: float = 5e-3  # chosen: ... the first step over the mean duration, ...
    early: float = 4.0  # chosen: ... or over so many relaxation times if these are shorter
    # chosen: steps of length 1 are doubled once time is so many times the step, shorter ones later
    per_length: float = 100.0
    reached: float = 6.0  # chosen: end of the axis where there is no threshold, in spreads of ...
    slow: float = 8.0  # chosen: ... int g if its correlation time is half of so many relaxations
    # chosen: values so far outside of [0, 1] mean that the solution grows; elements overshoot by
    # less where a front passes
    unstable: float = 1e-2


CONTOURS = Contours()
CONTOUR_FITS = ContourFits()
SADDLE_POINTS = SaddlePoints()
INVERSION = Inversion()
VERTICAL_LINES = VerticalLines()
REFINEMENT = Refinement()
LINE_GRIDS = LineGrids()
FAR_START = FarStart()
PLANE_TRANSFORM = PlaneTransform()
EACH_PART = EachPart()
NEAR_WALL = NearWall()
PLANE_GRIDS = PlaneGrids()
# chosen: what is left out, so that the change to the next basis shows an error by it, too; a basis
# has the solutions of the one before if its depths are the same
BASES = (
    Basis(1e-6, 1e-3, 2e-3),
    Basis(1e-7, 1e-3, 2e-3),
    Basis(1e-7, 1e-4, 1e-3),
    Basis(1e-8, 1e-4, 5e-4),
)
TIME_STEPPING = TimeStepping()
# in one element, early times converge irregularly, and graded elements are no better
_BETWEEN_EARLY = tuple((degree, (0.5,)) for degree in (4, 5, 6, 7, 8, 9, 10))
STEPPED_GRIDS = PlaneGrids(
    driven=(4, 5, 6, 8, 9, 10, 12),
    observed=((5, 3.0), (6, 3.0), (7, 3.0), (9, 3.0), (8, 9.0), (10, 9.0), (12, 9.0)),
    between=_BETWEEN_EARLY,
    soft=_BETWEEN_EARLY,
    other=(*PLANE_GRIDS.other[:5], (7, 8.0, 0.02), (8, 8.0, 0.01)),
    hermite=(10, 16, 24, 36, 54, 80, 110),
    elements=(
        (4, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (5, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (6, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (7, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (8, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (9, (0.12, 0.4, 1.0), (0.5, 1.0)),
        (10, (0.12, 0.4, 1.0), (0.5, 1.0)),
    ),
)
# driven and other variable of the grid, x, time. Degrees of the other variable converge
# irregularly. Steps are of order 2, extrapolated; the least error, a tenth of the last change, is
# chosen: 0.02 to 0.14 of it were seen, where what a third run changes was larger
STEPPED_PARTS = (
    Part(2, 5, 1, 0.05, True),
    Part(2, 5, 1, 0.3, True),
    Part(1, 4, 1, 0.1),
    Part(1, 5, 1, 0.1, beyond=1 / 3),
)
# driven and other variable of the grid, basis, contour. Changes by the last two fall fast: to a
# twentieth and to an eighth were seen of those by the basis, so that half of one is more than what
# is left
PLANE_PARTS = (
    Part(2, 6, 1, 0.05, True),
    Part(2, 6, 1, 0.3, True),
    Part(0, 2, 1, 0.3, counted=0.5),
    Part(1, 4, -1, counted=0.5),
)
# Where modes are nearly parallel, the first basis is off by up to 3e-5, irregularly; the second,
# which is compared with it, by a tenth of that
PARALLEL_PARTS = (*PLANE_PARTS[:2], Part(1, 3, -1, 0.3, counted=0.5), PLANE_PARTS[3])
# Hermite polynomials and their elements converge slowly, and irregularly, if the damping is less
# than this share of the rate of oscillations
HARDLY_DAMPED = 0.2  # chosen
SLOW_PARTS = (Part(2, 6, 1, 0.5, True), Part(2, 6, 1, 0.5, True), *PLANE_PARTS[2:])

# The numbers of these records are described at `Settings` and `ContourSettings`. All without a
# comment are chosen by trial; benchmarks/crossing_honesty.py checks the errors that result.
LINE = ContourSettings(
    default_tolerance=1e-7,
    coarse_tolerance=1e-4,
    # chosen: with more nodes their real parts are larger, which only makes rounding errors grow
    levels=(
        ContourLevel(4, 7, 1.2),
        ContourLevel(6, 10, 0.9),
        ContourLevel(7, 11, 0.85),
        ContourLevel(9, 13, 0.75),
        ContourLevel(11, 15, 0.7),
        ContourLevel(14, 17, 0.65),
    ),
    relative=True,
    least_probability=1e-14,
    # fitted: benchmarks/crossing_honesty.py; if g is odd, decay lengths are computed as square
    # roots, which costs the short ones half of their digits
    unseen_error=2e-9,
    advice="loosen tol",
    least_transform=1e-70,
    window=2.5,
    rise_truncation=1e-12,
    steady_truncation=1e-10,
)
LINE_FROM_AFAR = replace(
    LINE,
    relative=False,
    # chosen: from a far start the probability rises fast, up to 1, which takes more nodes; degrees
    # 6 and 7 share an error of some 3e-8 there, so that they are not compared
    levels=tuple(
        level._replace(spacing=0.65 * level.spacing)
        for level in LINE.levels
        if level.resolution != 7
    ),
    rise_truncation=1e-9,
    advice="loosen tol, or use method='monte_carlo'",
)
PLANE = ContourSettings(
    default_tolerance=1e-4,
    coarse_tolerance=0.0,
    levels=(
        ContourLevel(0, 7, 1.2),
        ContourLevel(1, 8, 1.05),
        ContourLevel(2, 9, 0.95),
        ContourLevel(3, 10, 0.9),
        ContourLevel(4, 12, 0.8),
    ),
    relative=False,
    least_probability=2e-5,
    unseen_error=2e-6,  # derived: flow of the nodes that are taken to stand still, and
    #                     what is outside of the box
    advice="loosen tol, or use method='monte_carlo'",
    least_transform=1e-13,
    window=4.0,
    rise_truncation=1e-7,
    steady_truncation=1e-6,
)
