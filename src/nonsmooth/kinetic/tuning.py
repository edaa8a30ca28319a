"""Numbers that were chosen for the kinetic equation, a record for each method."""

from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True)
class LineOrdinates:
    """Elements of one state variable."""

    depth: float = 40.0  # derived: the grid ends where m has fallen by exp(-40), below rounding
    steepest: float = 12.0  # chosen: largest log of the ratio of densities at an element's ends
    grading: float = 3.0  # chosen: widest element over its distance to a zero of g or the start
    # `finest` and `at_start` are relative to the lesser of the deviation of y and sigma sqrt(t)
    finest: float = 0.1  # chosen: width at a zero of g; the error is of the order of its cube
    at_start: float = 1.0  # chosen: width at the start, where the solution is smooth
    crossing: float = 3.0  # chosen: widest element over the spread of velocities of the paths
    #                        that go straight to a wall
    # derived: where the density is less than exp(26) = 2e11 times that at the end of the grid,
    # fewer digits matter, and elements are wider by 26 over the logarithm of this ratio ...
    digits: float = 26.0
    rarest: float = 0.1  # chosen: ... but at most 1/rarest times as wide
    # derived: the grid reaches so many deviations beyond the start; more has probability exp(-72)
    reach: float = 12.0
    long_time: float = 1e3  # chosen: time unless given, in 1/C_b; so long that it has no effect
    deepest: float = 700.0  # derived: a density below exp(-708) has no digits in double precision
    shrink: float = 0.98  # chosen: factor by which the axis is shortened until it ends at `deepest`
    probed: int = 4001  # chosen: points of the sums that give the spread of the velocity
    searched: int = 501  # chosen: points between which sign changes of g are looked for
    most: int = 400  # chosen: number of elements; dense matrices of more take minutes at each z
    cut: float = 0.3  # chosen: place at which an element is cut whose one end is a zero of g
    inside: float = 1e-9  # chosen: how far within an element its ends are, where functions jump


@dataclass(frozen=True)
class CaseModes:
    """Eigenvalue problems of the elementary solutions."""

    # chosen: squared decay lengths below this, relative to the largest, are taken to be rounding
    rounding: float = 1e-12
    separated: float = 30.0  # chosen: slow eigenvalue over the others from which it is split off
    powers: int = 12  # derived: steps of the power method; separated^-12 is below rounding
    directed: float = 0.1  # chosen: relative flux from which it tells the wall of a mode


@dataclass(frozen=True)
class Adjoint:
    """Integrals over the solution and the adjoint solution."""

    # derived: difference of two rates times the length up to which a series serves: its next term
    # is 5e-4 of the fourth power, and where it ends the quotient of differences has 12 digits
    near: float = 1e-3


class PlaneLevel(NamedTuple):
    """Resolution of a tensor grid.

    Attributes
    ----------
    driven : int
        Polynomial degree in the variable that noise drives, if g does not depend on it.
    observed : tuple of int and float
        The same if g does, and the half axis over the finest element.
    between : tuple of int and tuple of float
        Polynomial degree in the other variable between its middle and a wall, if nothing happens
        there, and edges over the place of the wall.
    other : int
        Polynomial degree in the other variable elsewhere.
    ratio : float
        Ratio of the widths of neighbouring elements in the other variable, where they are graded.
    finest : float
        Width of the element next to g = 0, relative to the end of the axis.
    dropped : float
        Share of E |g| at nodes that are taken to stand still.
    soft : tuple of int and tuple of float, optional
        As `between`, for a wall that paths enter deeply.
    """

    driven: int
    observed: tuple[int, float]
    between: tuple[int, tuple[float, ...]]
    other: int
    ratio: float
    finest: float
    dropped: float
    soft: tuple[int, tuple[float, ...]] | None = None


@dataclass(frozen=True)
class PlaneOrdinates:
    """Tensor grids of two state variables."""

    depth: float = 14.0  # derived: outside the box the density is exp(-14) = 8e-7 of its maximum
    fast: float = 1.5  # chosen: largest of the finest elements if noise drives g, in sigma sqrt(t),
    ratio: float = 3.0  # chosen: ... and ratio of neighbouring ones
    outer: float = 0.4  # chosen: an edge in the outermost element, over the end of the axis
    in_wall: float = 0.3  # chosen: an edge inside a wall, over its depth
    soft: float = 0.7  # chosen: depth over the wall's place from which on a wall is soft
    # chosen: position of the kink over the largest and over the finest element beside it, if g is
    # the penalty force
    beside_knot: tuple[float, float] = (2.0, 64.0)


class GibbsLevel(NamedTuple):
    """Resolution of a grid in Hermite polynomials of the velocity and elements of displacement.

    Attributes
    ----------
    hermite : int
        Number of Hermite polynomials.
    degree : int
        Polynomial degree in x.
    inside, within : tuple of float
        Edges of elements relative to the distance of the wall from 0, and beyond the wall
        relative to the depth of the box there.
    dropped : float
        Share of E |g| at nodes that are taken to stand still.
    """

    hermite: int
    degree: int
    inside: tuple[float, ...]
    within: tuple[float, ...]
    dropped: float


@dataclass(frozen=True)
class Fields:
    """Solutions at many depths, from which a basis is taken."""

    per_octave: int = 3  # chosen: depths within a factor of 2
    even: int = 16  # chosen: depths that are equally far apart
    sourced: int = 8  # chosen: the same between a source and a face
    rounding: float = 1e-6  # chosen: a smaller share of the start in one parity is rounding
    decayed: float = 18.0  # chosen: no depth is beyond exp(-18) of the slowest mode
    # chosen: size of a transform, which is between 0 and 1, that shows an unstable grid
    unstable: float = 5.0


@dataclass(frozen=True)
class DoubledSlabs:
    """The same solutions, by doubling of slabs."""

    # chosen: least depth over the thickness of the first slab, at least; with 2 bases were worse
    parts: float = 4.0
    even: int = 4  # chosen: how often the half of a slab is halved evenly, ...
    near: int = 3  # chosen: ... and how often what is nearer to the face than any depth
    opaque: float = 1e-9  # chosen: relative size of what is seen through a slab taken as infinite
    most: int = 64  # chosen: doublings of a slab that is not opaque because of rounding


@dataclass(frozen=True)
class ReducedOrdinates:
    """Modes of few ordinates."""

    # chosen: rate, in units of one over the way that int g goes in a relaxation time, from which on
    # modes decay next to the walls; the real part of such a rate is at least this share of its size
    fast: float = 50.0
    least: float = 0.15


@dataclass(frozen=True)
class TailDescent:
    """The way of the velocity from a far start to the bulk."""

    # chosen: the bulk begins where m has fallen by exp(-8); the modes of `case_modes` are accurate
    # there, and the velocity falls to there in a short time
    level: float = 8.0
    spreads: float = 6.5  # derived: a normal variable is farther out with probability 8e-11
    points: int = 48  # chosen: Gauss points of a normal law in each direction, exact to rounding
    probed: int = 2001  # chosen: points at which the sign and the slope of g are looked at
    linear: float = 1e-12  # derived: relative deviations from a line up to this are rounding
    times: int = 401  # chosen: times among which the end of the descent is sought
    share: float = 0.8  # chosen: the descent is so much of the flight, at most
    series: float = 1e-2  # derived: below it a series gives the variance; its next term is 1e-12
    rate: float = 3.0  # chosen: factor of safety on the rate of change of the solution at the level


@dataclass(frozen=True)
class TailEquation:
    """The kinetic equation above the level, marched in x."""

    unlikely: float = 30.0  # derived: ways exceeded with probability exp(-30) are left out
    stages: int = 5  # chosen: of the Radau IIA method, of order 9
    # chosen: degrees by which the largest |z| that is resolved doubles; transforms are small beyond
    # it, and comparing degrees shows how small
    degrees: float = 3.0
    # chosen: that |z| times the spread of arrivals, but for the factor by the degree; a normal law
    # is exp(-3) there with the degree 9, exp(-7) with 11 and exp(-29) with 14, which differ
    front: float = 0.3
    path: int = 1001  # chosen: points on the path without noise
    sharpest: float = 30.0  # chosen: mean time of arrival over the spread, at most
    work: float = 5e8  # chosen: steps times squared nodes, at most; about a second for each z
    turn: float = 0.8  # chosen: largest |z| t of a step, t its duration
    rotation: float = 40.0  # chosen: largest |z| t of the fall through an element
    width: float = 0.9  # chosen: width of elements over the spread of velocities on the way down
    beyond: float = 4.0  # chosen: spreads of y by which the grid reaches beyond the start
    most: int = 400  # chosen: elements; the bound of the longest way takes two seconds then
    coarse: int = 7  # chosen: polynomial degree for the bound of the longest way
    exponents: int = 49  # chosen: exponents theta tried for that bound, over six decades


@dataclass(frozen=True)
class ReducedLine:
    """Bases of one state variable on a vertical line."""

    apart: float = 4.0  # chosen: ratio of the heights at which a basis is checked
    most: int = 16  # chosen: number of these heights; half as many real z span a basis
    octaves: int = 10  # chosen: depths of solutions are down to 2^-10 of the distance of the walls
    even: int = 10  # chosen: and so many of it are equally far apart
    vanishing: float = 1e-12  # derived: functions so small, relative to others, are rounding
    adjoint: float = 100.0  # chosen: what is left out of adjoint solutions over that of solutions
    shares: tuple[float, ...] = (3.0, 0.3, 0.03)  # chosen: parts of the accuracy that are left out
    spared: int = 1  # chosen: number of checked heights above which it need not be good enough
    checked: float = 0.3  # chosen: part of the accuracy up to which a basis may be off
    fewer: float = 0.75  # chosen: largest number of functions over that of nodes


LINE_ORDINATES = LineOrdinates()
CASE_MODES = CaseModes()
ADJOINT = Adjoint()
PLANE_ORDINATES = PlaneOrdinates()
FIELDS = Fields()
DOUBLED_SLABS = DoubledSlabs()
REDUCED_ORDINATES = ReducedOrdinates()
REDUCED_LINE = ReducedLine()
TAIL_DESCENT = TailDescent()
TAIL_EQUATION = TailEquation()
