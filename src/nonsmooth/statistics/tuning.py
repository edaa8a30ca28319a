"""Numbers that were chosen for the statistics, one record for each method.

Each line says what the number is and where it comes from.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Gamma2OnGrids:
    """gamma^2 by the combination technique; entries by the number of state variables."""

    # chosen: levels of the grids that the box and the shift are fitted on, cheap ones
    fitted: Mapping[int, int] = field(default_factory=lambda: {2: 2, 3: 1, 4: 0})
    # chosen: levels of the coarsest grid, from which surpluses decay
    coarse: Mapping[int, int] = field(default_factory=lambda: {2: 2, 3: 1, 4: 1})
    residual: float = 0.02  # chosen: first residual of the iteration, relative to the tolerance
    iteration: float = 0.1  # chosen: part of the tolerance that a tenth of the residual may change
    work: int = 8  # chosen: largest grids that may be spent on one value; bounds the time
    rounding: float = 1e-3  # chosen: part of the tolerance that covers rounding
    stiff: float = 1e7  # chosen: n that stands for inf; what it leaves, of order 1/n, is known
    stiff_elastic: float = 1e12  # chosen: the same for elastic walls, where it is n^(-1/2)
    softer: float = 1e-2  # chosen: times these, a second n to extrapolate from
    long: float = 100.0  # chosen: correlation time of a slow scene, in relaxation times


@dataclass(frozen=True)
class MomentsOnGrids:
    """Mean and variance of the integral, by rational Krylov spaces."""

    poles: tuple[float, ...] = (0.0, 10.0)  # chosen: larger ones resolve times that grids do not
    dimensions: tuple[int, ...] = tuple(range(12, 85, 6))  # chosen: of the spaces compared
    projection: float = 0.05  # chosen: part of the tolerance for the projection
    coarsest: int = 1  # chosen: level of the first grid
    finest: int = 9  # chosen: level at which refinement ends
    largest: int = 45_000  # chosen: grid points; each pole keeps its factors in memory
    dependent: float = 1e-10  # chosen: a function that has less of its own is left out
    rounding: float = 3e-11  # fitted: linear scenes have up to 9e-12, relative
    growing: float = 1e-12  # chosen: relative rate above which a mode grows, beyond rounding
    apart: float = 1.8  # chosen: ratio of times at which the oscillation of errors is sampled
    around: float = 1.25  # chosen: the box holds the start with so much to spare


@dataclass(frozen=True)
class InvariantDensity:
    """Densities on grids and in closed form; entries by the number of state variables."""

    # chosen: tolerance unless given, reached in seconds
    tol: Mapping[int, float] = field(default_factory=lambda: {1: 1e-8, 2: 1e-6, 3: 1e-2, 4: 5e-2})
    points: int = 201  # chosen: of a density unless given
    deepest: float = 80.0  # derived: exp(-80) is below rounding of the norm of a closed form
    gauss: int = 16  # chosen: points for each piece of a bin
    fewer: int = 10  # chosen: points that show the error of those
    residual: float = 0.05  # chosen: of the iteration, relative to the tolerance


@dataclass(frozen=True)
class SpectralGap:
    """The slowest eigenvalue."""

    wanted: int = 6  # chosen: eigenvalues; the slowest may be a complex pair, and close to others
    fitted: int = 1  # chosen: level on which the box is fitted
    finest: int = 8  # chosen: last level; bounds the time
    degrees: tuple[int, ...] = (8, 12, 16, 20, 24)  # chosen: with one variable
    iteration: float = 1e-2  # chosen: part of the tolerance for the iteration
    rounding: float = 2e-11  # fitted: linear scenes have up to 2e-12, relative
    backward: float = 5e-13  # fitted: what moves eigenvalues that coincide is up to 2e-13


@dataclass(frozen=True)
class Gamma2:
    """Tolerances of gamma^2 for one to four state variables."""

    # chosen: relative; what the deterministic methods reach within about a minute
    tolerance: tuple[float, ...] = (1e-10, 1e-6, 2e-4, 3e-3)
    # fitted: benchmarks/requests.py; from these tolerances on Monte Carlo is the faster
    faster_sampled: tuple[float, ...] = (math.inf, math.inf, 1e-2, 3e-3)


@dataclass(frozen=True)
class SampledGamma2:
    """Times and sizes of gamma^2 by Monte Carlo."""

    # chosen: the least relative tolerance that is tried; work grows as its inverse square or faster
    least_tolerance: float = 1e-3
    # chosen: between which the slope is taken, unless it still changes; where the time scale of the
    # scene is 1, its start is long forgotten at the first
    times: tuple[float, ...] = (10.0, 60.0, 110.0)
    # chosen: relaxation times of the drift far out that pass before the first of them at least
    relaxed: float = 2.0
    # chosen: n whose drift is looked at for that instead of a larger one
    soft: float = 1e3
    # chosen: how often the times are doubled, up to 64 times those above
    doublings: int = 7
    # chosen: paths from each well; slopes of theirs that differ by a fifth are told apart
    scouts: int = 1024
    # chosen: slopes agree within so many standard errors, or to this relative difference
    agreement_errors: float = 4.0
    agreement: float = 1e-3
    # chosen: part of the tolerance for the standard errors of the bias
    halving_share: float = 0.4
    # chosen: step for a stationary mean, times the smaller of 1 and 1/C_b; its bias is below 1e-3
    step_of_mean: float = 0.02


@dataclass(frozen=True)
class Variance:
    """Tolerances and resolutions of v(0, tau)."""

    # chosen: absolute, of v(tau)/tau, for one and two state variables
    tolerance: tuple[float, ...] = (1e-9, 1e-5)
    # chosen: polynomial degrees of the eigenfunctions, until two agree
    degrees: tuple[int, ...] = (8, 12, 16, 20, 24)
    # fitted: benchmarks/requests.py; steps of all paths that take less time than grids for two
    # variables
    few_steps: float = 5e7
    # derived: relative standard error of a variance that rests on 1 / 0.2^2 = 25 paths
    resting: float = 0.2
    # chosen: root of the factor by which paths are added at once where it rests on fewer
    more: float = 6.0


GAMMA2_ON_GRIDS = Gamma2OnGrids()
MOMENTS_ON_GRIDS = MomentsOnGrids()
INVARIANT_DENSITY = InvariantDensity()
SPECTRAL_GAP = SpectralGap()
GAMMA2 = Gamma2()
SAMPLED_GAMMA2 = SampledGamma2()
VARIANCE = Variance()
