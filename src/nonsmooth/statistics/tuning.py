"""Numbers that were chosen for the statistics, one record for each method.

Each line says what the number is and where it comes from.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Gamma2OnGrids:
    """gamma^2 by the combination technique; entries by the number of state variables."""

    # chosen: levels of the grids on which the box and the shift are fitted; cheap ones
    fitted: Mapping[int, int] = field(default_factory=lambda: {2: 2, 3: 1, 4: 0})
    # chosen: levels of the coarsest grid; from there on, changes by refinement decay
    coarse: Mapping[int, int] = field(default_factory=lambda: {2: 2, 3: 1, 4: 1})
    residual: float = 0.02  # chosen: first residual of the iteration, relative to the tolerance
    # chosen: part of the tolerance that a hundredth of the residual may change
    iteration: float = 0.1
    work: int = 8  # chosen: work for one value, in units of the largest grid; bounds the time
    # chosen: largest grid on which a larger box is tried, in units of the largest grid
    boxed: float = 0.25
    # chosen: part of the tolerance that box and residual may use up; where they use more, finer
    # grids are of no avail once their own error is below this part
    others: float = 0.25
    rounding: float = 1e-3  # chosen: part of the tolerance that covers rounding
    stiff: float = 1e7  # chosen: n in place of inf; the rest, of order 1/n, is extrapolated
    stiff_elastic: float = 1e12  # chosen: the same for elastic walls; the rest is n^(-1/2)
    softer: float = 1e-2  # chosen: the second n of the extrapolation, relative to the first
    # chosen: a gamma^2 below its error is taken for 0 if both are below this part of the terms that
    # cancel; coboundaries such as g = y between walls reach 1e-7 on coarse grids
    vanishing: float = 1e-6
    long: float = 100.0  # chosen: relaxation times; a scene correlated for longer is called slow


@dataclass(frozen=True)
class MomentsOnGrids:
    """Mean and variance of the integral, by rational Krylov spaces."""

    # chosen: poles of the Krylov space; larger ones would resolve times that the grids do not
    poles: tuple[float, ...] = (0.0, 10.0)
    # chosen: dimensions of the spaces, each compared with the one before
    dimensions: tuple[int, ...] = (12, 18, 24, 36, 48, 66, 84)
    projection: float = 0.05  # chosen: part of the tolerance for the projection
    coarsest: int = 1  # chosen: level of the first grid
    finest: int = 9  # chosen: level at which refinement ends
    behind: int = 2  # chosen: levels that a variable may be coarser than the finest one
    failed: float = 10.0  # chosen: an error so many times that of the grid before is a failure
    largest: int = 45_000  # chosen: grid points; each pole keeps its factors in memory
    # chosen: a function is left out if its part orthogonal to the others is smaller, relative to it
    dependent: float = 1e-10
    rounding: float = 3e-11  # fitted: relative rounding error; linear scenes show up to 9e-12
    growing: float = 1e-12  # chosen: relative rate above which a mode grows, beyond rounding
    apart: float = 1.8  # chosen: ratio of times at which the oscillation of errors is sampled


@dataclass(frozen=True)
class InvariantDensity:
    """Densities on grids and in closed form; entries by the number of state variables."""

    # chosen: tolerance unless one is given; it is reached in seconds
    tol: Mapping[int, float] = field(default_factory=lambda: {1: 1e-8, 2: 1e-4, 3: 1e-2, 4: 5e-2})
    # chosen: points of the finest grid with elements that resolve layers, half a minute
    largest_layered: int = 450_000
    # chosen: factor on differences between such grids; at the kink they fall by 2 to 3 a level
    layered_safety: float = 2.0
    # chosen: the same for three and four variables where layers are missed; two levels of random
    # scenes understated by up to 2.5, and by 4.5 where errors were above the densities
    unresolved_safety: float = 3.0
    # chosen: points of the finest grid unless a tolerance is given, some seconds
    quick: Mapping[int, float] = field(default_factory=lambda: {3: 220_000})
    first: int = 1  # chosen: level of the first grid
    # chosen: levels of the grids on which the box and the shift are fitted; cheap ones
    fitted: Mapping[int, int] = field(default_factory=lambda: {1: 1, 2: 1, 3: 1, 4: 0})
    # chosen: on coarser grids the error that two levels show may be smaller than the true one
    loosest: float = 0.3
    # chosen: largest factor by which a level reduces the error; if a difference falls by more, the
    # error has changed its sign
    gain: float = 10.0
    points: int = 201  # chosen: number of points of a density unless points are given
    deepest: float = 80.0  # derived: exp(-80) is below rounding of the norm of a closed form
    gauss: int = 16  # chosen: Gauss points for each piece of a bin
    fewer: int = 10  # chosen: Gauss points of a second quadrature, to see the error of the first
    residual: float = 0.05  # chosen: residual of the iteration, relative to the tolerance
    # chosen: part of all bins whose errors count for a bin, on either side; the difference of two
    # grids changes its sign several times over the bins
    near: float = 0.05
    safety: float = (
        2.0  # chosen: the error of a bin is so many times the largest difference near it
    )


@dataclass(frozen=True)
class SampledDensity:
    """Densities as histograms."""

    tolerance: float = 5e-2  # chosen: relative, unless given; most scenes reach it in seconds
    least_tolerance: float = 1e-3  # chosen: the least that is tried
    soft: float = 1e2  # chosen: n in the place of inf for the box that holds the points
    blocks: int = 32  # chosen: of 1000 paths; so many are enough to tell their spread
    longest_time: float = 1600.0  # chosen: of the last attempt, half a minute
    most_steps: float = 8e4  # chosen: the same in steps, where they must be short
    hopeless: float = 1e6  # chosen: steps of the first attempt that are too many, minutes
    stable: float = 0.9  # chosen: part of the longest stable step for the coarser of the two
    relaxed: float = 2.5  # chosen: so many first times of gamma^2 until a start is forgotten
    attempts: int = 4  # chosen: with steps that become shorter where their bias is large
    spare: float = 1.1  # chosen: by so much errors are aimed below the tolerance
    coarser: int = 4  # chosen: factor on the step by which its bias is seen
    dropped: float = 0.2  # chosen: share of the time until paths have forgotten their start
    symmetric: float = 1e-9  # chosen: deviation of symmetric edges from symmetry, in cells
    # chosen: time between two observations, about; a path leaves a cell long before it has
    # forgotten its start, and more observations take as long as the steps between them
    spacing: float = 0.15
    false_alarm: float = 1e-3  # chosen: probability that chance exceeds the error in some cell


@dataclass(frozen=True)
class SpectralGap:
    """The slowest eigenvalue."""

    # chosen: relative, unless given, by the number of variables; it is reached in about a minute
    tol: Mapping[int, float] = field(default_factory=lambda: {1: 1e-6, 2: 1e-6, 3: 1e-3, 4: 2e-2})
    # chosen: number of eigenvalues; the slowest may be a complex pair, and close to others
    wanted: int = 6
    fewer: int = 4  # chosen: the same with three and four variables, where each takes longer
    # chosen: factor on errors of three and four variables that finer grids do not reduce; of random
    # scenes with layers, they were up to 1.4 times too small
    unresolved_safety: float = 3.0
    loosest: float = 2e-5  # chosen: residual of modes on grids that are solved directly, at most
    known: float = 3e-2  # chosen: residual of modes other than the slowest, which are to be seen
    # chosen: modes of the second parity need only be seen if the slowest decays so many times as
    # fast as that of the first; such residuals move the rates of most scenes by less
    apart: float = 1.3
    # chosen: vectors that the iteration for three and four variables keeps, some 100 megabytes
    room: int = 80
    most: int = 200  # chosen: vectors after which it gives up; scenes that mix well need 20 to 60
    # chosen: residual of the rough inverses that its vectors are; a single step of alternating
    # directions leads some scenes nowhere, and 0.03 to 0.5 take about the same time
    inner: float = 0.5
    # chosen: levels of the first grids of those that are combined
    first: Mapping[int, int] = field(default_factory=lambda: {2: 2, 3: 1, 4: 0})
    fitted: int = 1  # chosen: level on which the box is fitted
    finest: int = 6  # chosen: last level; bounds the time to some 20 s
    # chosen: largest factor by which a level reduces the error; if changes fall by more, the error
    # has changed its sign
    gain: float = 30.0
    least_grids: int = 3  # chosen: of two variables, before their changes tell the error
    # chosen: polynomial degrees with one variable, until two agree
    degrees: tuple[int, ...] = (8, 12, 16, 20, 24)
    iteration: float = 1e-2  # chosen: part of the tolerance for the iteration
    rounding: float = 2e-11  # fitted: relative rounding error; linear scenes show up to 2e-12
    # fitted: relative backward error; eigenvalues that coincide show up to 2e-13
    backward: float = 5e-13


@dataclass(frozen=True)
class Mean:
    """The stationary mean of g; tolerances by the number of state variables."""

    # chosen: relative to the root mean square of g; what grids reach within about a minute
    tolerance: Mapping[int, float] = field(default_factory=lambda: {2: 1e-6, 3: 1e-3, 4: 1e-2})
    # chosen: the root mean square, which only scales the tolerance, is computed for an n of at most
    # this
    soft: float = 1e3
    # chosen: relative rounding error of a sum over the nodes, far above what closed forms show
    rounding: float = 1e-12


@dataclass(frozen=True)
class Gamma2:
    """Tolerances of gamma^2 for one to four state variables."""

    # chosen: relative; what the deterministic methods reach within about a minute
    tolerance: tuple[float, ...] = (1e-10, 1e-6, 2e-4, 3e-3)
    # fitted: benchmarks/requests.py; from these tolerances on Monte Carlo is the faster, unless it
    # takes more than so many steps of all paths together: about a second, and ten
    faster_sampled: tuple[float, ...] = (math.inf, math.inf, 1e-2, 3e-3)
    few_steps: tuple[float, ...] = (0.0, 0.0, 3e8, 3e9)


@dataclass(frozen=True)
class SampledGamma2:
    """Times and sizes of gamma^2 by Monte Carlo."""

    # chosen: the least relative tolerance that is tried; work grows as its inverse square or faster
    least_tolerance: float = 1e-3
    # chosen: times between which the slope is first taken; if the time scale of the scene is 1, its
    # start is long forgotten at the first of them
    times: tuple[float, ...] = (10.0, 60.0, 110.0)
    # chosen: the first of them is at least so many relaxation times of the drift far from 0
    relaxed: float = 2.0
    longest: float = 3e4  # chosen: the first of them at most; then minutes
    # chosen: that relaxation time is computed with an n of at most this
    soft: float = 1e3
    # chosen: how many times are tried, each twice the one before: up to 64 times those above
    doublings: int = 7
    # chosen: paths from each well; enough to tell slopes apart that differ by a fifth
    scouts: int = 1024
    # chosen: slopes agree within so many standard errors, or to this relative difference
    agreement_errors: float = 4.0
    agreement: float = 1e-3
    # chosen: part of the tolerance, or of three standard errors, for what has not settled
    rest_share: float = 0.1
    rounds: int = 3  # chosen: of its extrapolation; then it is known to some per cent
    # chosen: part of the tolerance for the standard errors of the bias
    halving_share: float = 0.4
    # chosen: first step for a stationary mean, times the smaller of 1 and 1/C_b; its bias is about
    # 1e-3
    step_of_mean: float = 0.02


@dataclass(frozen=True)
class Variance:
    """Tolerances and resolutions of v(0, tau)."""

    # of v(tau)/tau for one and two state variables, unless asked: absolute, or relative to the
    # largest of them if that is below 1; chosen: what takes seconds
    tolerance: tuple[float, ...] = (1e-9, 1e-5)
    # chosen: smaller rates than this count as if they were so large
    least: float = 1e-6
    # chosen: by Monte Carlo three standard errors and the bias, relative to the largest v(tau)/tau
    share: float = 0.05
    # chosen: polynomial degrees of the eigenfunctions, until two agree
    degrees: tuple[int, ...] = (4, 6, 8, 12, 16, 20, 24)
    # chosen: tolerances from this on are tried with the first of these degrees, others without the
    # first so many, which would not be enough
    loose: float = 1e-6
    few: int = 2
    # fitted: benchmarks/requests.py; this many steps of all paths together take less time than
    # grids for two variables
    few_steps: float = 5e7
    # derived: largest relative standard error; a variance that rests on 1 / 0.2^2 = 25 paths has it
    resting: float = 0.2
    # chosen: if it rests on fewer, the number of paths grows by this squared at most, at once
    more: float = 6.0


GAMMA2_ON_GRIDS = Gamma2OnGrids()
MOMENTS_ON_GRIDS = MomentsOnGrids()
INVARIANT_DENSITY = InvariantDensity()
SAMPLED_DENSITY = SampledDensity()
SPECTRAL_GAP = SpectralGap()
MEAN = Mean()
GAMMA2 = Gamma2()
SAMPLED_GAMMA2 = SampledGamma2()
VARIANCE = Variance()
