"""First passage of int_0^t g for two state variables, by the Laplace transform on reduced grids."""

import math
from collections.abc import Callable
from contextlib import suppress
from functools import cached_property

import numpy as np

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.inversion import contour_solver
from nonsmooth.crossing.first_passage.problem import (
    ContourSettings,
    LaplaceProblem,
    Part,
)
from nonsmooth.crossing.first_passage.saddle_points import SaddlePoints, in_common, saddle_points
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.generator import Change
from nonsmooth.kinetic import ordinates_gibbs
from nonsmooth.kinetic.bases import doubled_slabs, fields
from nonsmooth.kinetic.bases.reduced_ordinates import Fields, ReducedOrdinates, joined, reduced
from nonsmooth.kinetic.marching.split_step import IMAGINARY
from nonsmooth.kinetic.marching.tensor import TensorOrdinates, tensor_ordinates
from nonsmooth.kinetic.ordinates_gibbs import gibbs_ordinates
from nonsmooth.kinetic.ordinates_plane import (
    PlaneOrdinates,
    UnstableError,
    boxed,
    plane_ordinates,
)
from nonsmooth.refine import solvable
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


def applies(scene: Scene) -> bool:
    """Whether the scene has two state variables, white or Langevin noise, odd g and drift."""
    return (
        scene.dimension == 2
        and scene.noise.kind in ("white", "langevin")
        and not math.isinf(scene.n)
        and scene.is_odd()
    )


class SharedGrids:
    """Grids and bases of one scene that serve the same times, for one interval or several.

    A resolution is a triple: of the grid in the driven variable, in the other one, and of the basis
    in which the grid is reduced. One grid serves all times. A basis is taken from solutions in the
    longest interval, or in halves of it, one of which is at least as long as the interval that it
    is for, and one at most, if there are several lengths.

    Parameters
    ----------
    scene : Scene
    intervals : numpy.ndarray, shape (m, 2)
        All finite, or all with one infinite level.
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    change : Change, optional
        Of the scene, if derivatives are wanted: grids know that of the generator, in bases are
        solutions with a changed generator, too, and grids for steps have imaginary parts.

    Attributes
    ----------
    ends : dict
        Half widths of the box, from symbols.
    """

    def __init__(
        self,
        scene: Scene,
        intervals: np.ndarray,
        times: np.ndarray,
        change: Change | None = None,
    ):
        self.scene, self.ends, self._change = scene, boxed(scene), change
        self._times, lengths = times, intervals[:, 1] - intervals[:, 0]
        self._length, self._nearest = lengths.max(), np.abs(intervals).min()
        shorter = np.zeros(len(intervals))
        if math.isfinite(self._length):
            shorter = np.log2(self._length / lengths)
        self._halvings = int(np.ceil(shorter).max())
        # from pairs of levels to the halves of which one is longer and one is shorter
        first = np.minimum(np.floor(shorter), max(self._halvings - 1, 0)).astype(int)
        self._halves = {
            tuple(levels): (k, min(k + 1, self._halvings))
            for levels, k in zip(intervals.tolist(), first.tolist(), strict=True)
        }
        self._grids: dict[tuple, PlaneOrdinates] = {}
        self._known: dict[tuple, list[Fields]] = {}
        self._reduced: dict[tuple, ReducedOrdinates] = {}
        self._transforms: dict[tuple, dict] = {}
        self._saddles: dict[tuple, dict[tuple, SaddlePoints]] = {}

    def grid(
        self, driven: int, other: int, levels: tuning.PlaneGrids = tuning.PLANE_GRIDS
    ) -> PlaneOrdinates:
        """Make a grid.

        Parameters
        ----------
        driven, other : int
            Resolution of the variable that noise drives, and of the other.
        levels : PlaneGrids
            What a resolution means.
        """
        key = driven, other, levels
        if key not in self._grids:
            if ordinates_gibbs.applies(self.scene):
                self._grids[key] = gibbs_ordinates(
                    self.scene, self.ends, levels.gibbs(driven, other), self._change
                )
            else:
                self._grids[key] = plane_ordinates(
                    self.scene, self.ends, levels.plane(driven, other), self._early, self._change
                )
        return self._grids[key]

    def stepped_grid(self, driven: int, other: int) -> PlaneOrdinates | TensorOrdinates:
        """Make a grid for steps in time, in Hermite polynomials if there is one.

        Parameters
        ----------
        driven, other : int
            As for `grid`.
        """
        levels = tuning.STEPPED_GRIDS
        if ordinates_gibbs.applies(self.scene):
            grid = self.grid(driven, other, levels)
            return grid if self._change is None else grid.changed(IMAGINARY)
        return tensor_ordinates(
            self.scene, self.ends, levels.plane(driven, other), self._early, self._change
        )

    @property
    def way(self) -> float:
        """How far int g goes within a relaxation time."""
        return self.grid(0, 0).way

    @property
    def _early(self):
        """The shortest time of interest."""
        return min(self._times[0], 1 / self.scene.damping)

    def transform(
        self, resolution: tuple[int, int, int], interval: tuple[float, float]
    ) -> Callable[[complex], complex]:
        """Return F of an interval. Its values are computed for all that have its basis.

        Parameters
        ----------
        resolution : tuple
            Of the grid in both variables, and of the basis.
        interval : tuple
            Lower and upper level.
        """
        halves = self._halves[interval]
        ordinates = self.ordinates(*resolution, halves)
        alike = [other for other, between in self._halves.items() if between == halves]
        values = self._transforms.setdefault((*resolution, halves), {})

        def transform(z):
            if z not in values:
                found = ordinates.first_passage(z, np.array(alike))
                values[z] = dict(zip(alike, found, strict=True))
            return values[z][interval]

        return transform

    def saddle_points(self, times: np.ndarray) -> dict[tuple[float, float], SaddlePoints]:
        """Find the saddle points of all intervals but those that coarse grids do not resolve.

        Parameters
        ----------
        times : numpy.ndarray, shape (k,)
            Increasing, positive.

        Returns
        -------
        dict
            From intervals.
        """
        key = tuple(times)
        if key not in self._saddles:
            found = self._saddles[key] = {}
            for interval in self._halves:
                with suppress(ToleranceError, UnstableError):
                    lower, upper = interval
                    problem = PlaneProblem(self.scene, lower, upper, times, self)
                    found[interval] = saddle_points(problem, times)
        return self._saddles[key]

    def ordinates(
        self, driven: int, other: int, basis: int, halves: tuple[int, int] = (0, 0)
    ) -> ReducedOrdinates:
        """Reduce a grid.

        Parameters
        ----------
        driven, other : int
            As for `grid`.
        basis : int
            Resolution of the basis.
        halves : tuple of int
            How often the longest interval is halved for its solutions, at first and at last.
        """
        key = driven, other, basis, halves
        if key not in self._reduced:
            found = [
                of_half
                for of_z in self._fields(driven, other, basis)
                for of_half in of_z[halves[0] : halves[1] + 1]
            ]
            settings = tuning.BASES[basis]
            self._reduced[key] = reduced(
                self.grid(driven, other), joined(found), settings.accuracy, settings.adjoint
            )
        return self._reduced[key]

    def _fields(self, driven, other, basis):
        """Solutions in the longest interval and in its halves for the z of a basis."""
        least = tuning.BASES[basis].least
        return [self._field(driven, other, z, least) for z in self._shifts(basis)]

    def _field(self, driven, other, z, least):
        """Solutions in the longest interval and in its halves for a real z."""
        key = driven, other, z, least
        if key not in self._known:
            grid = self.grid(driven, other)
            # what int g goes within a relaxation time, or within 1/z if this is shorter
            way = grid.way / (1 + z / self.scene.damping)
            grids = [grid]
            if self._change is not None:
                grids.append(grid.changed(tuning.PLANE_TRANSFORM.changed))
            solve = doubled_slabs.fields if self.nearly_parallel else fields.fields
            slab = self._length, least * way, self._nearest, self._halvings
            found = [solve(one, z, *slab) for one in grids]
            self._known[key] = [joined(of_half) for of_half in zip(*found, strict=True)]
        return self._known[key]

    @cached_property
    def nearly_parallel(self) -> bool:
        """Whether modes of all ordinates are: rounding, seen on the coarsest grid, grows on others.

        Slabs are doubled then, which takes longer.
        """
        z = 1 / math.sqrt(self._times[0] * self._times[-1])
        with solvable():
            rounded = fields.rounding(self.grid(0, 0), z, self._length)
        return not rounded < tuning.PLANE_TRANSFORM.rounding

    def _shifts(self, refined):
        """Real z, of the sizes of the inverse times; of a basis that is `refined` so many times."""
        settings = tuning.PLANE_TRANSFORM
        ends = settings.least / self._times[-1], settings.largest / self._times[0]
        parts = 1
        while math.log10(ends[1] / ends[0]) > settings.widest * parts:
            parts *= 2
        return np.geomspace(*ends, settings.parts * parts * 2**refined + 1)


class PlaneProblem(LaplaceProblem):
    """A scene with two state variables to which this module `applies`, and an interval.

    Resolutions are those of `SharedGrids`.

    Parameters
    ----------
    scene : Scene
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    grids : SharedGrids, optional
        For the same times, if other intervals have them in common with this one.

    Attributes
    ----------
    grids : SharedGrids
    """

    def __init__(
        self,
        scene: Scene,
        lower: float,
        upper: float,
        times: np.ndarray,
        grids: SharedGrids | None = None,
    ):
        self.scene, self.lower, self.upper = scene, lower, upper
        self._times = times
        self.grids = grids or SharedGrids(scene, np.array([[lower, upper]]), times)
        _require_resolved(scene, self.grids.ends, min(-lower, upper))

    @property
    def settings(self) -> ContourSettings:
        """How accurate the problem is."""
        return tuning.PLANE

    @property
    def resolutions(self) -> tuple[Part, ...]:
        """Those of the grid in both variables, of the basis, and of a contour."""
        if self.grids.nearly_parallel:
            return tuning.PARALLEL_PARTS
        driven = self.scene.noise.driven
        (other,) = set(self.grids.ends) - {driven}
        # of oscillations: the widths of the box are so many standard deviations
        rate = self.grids.ends[driven] / self.grids.ends[other]
        hardly_damped = self.scene.damping < tuning.HARDLY_DAMPED * rate
        slow = hardly_damped and ordinates_gibbs.applies(self.scene)
        return tuning.SLOW_PARTS if slow else tuning.PLANE_PARTS

    def coarse_transform(self, radius: float, depth: float) -> Callable[[complex], complex]:
        """Return F on the coarsest grid; see `LaplaceProblem`."""
        return self.grids.transform((0, 0, 0), self.levels)

    def transform(
        self, resolution: tuple, times: np.ndarray, rarity: float
    ) -> Callable[[complex], complex]:
        """Return F on a grid of some resolution; see `LaplaceProblem`."""
        return self.grids.transform(resolution, self.levels)

    @property
    def levels(self) -> tuple[float, float]:
        """Lower and upper level."""
        return float(self.lower), float(self.upper)

    def saddle_points(self, times: np.ndarray) -> SaddlePoints:
        """Find the saddle points of its interval.

        Parameters
        ----------
        times : numpy.ndarray, shape (k,)
            Increasing, positive.
        """
        known = self.grids.saddle_points(times)
        return known[self.levels] if self.levels in known else saddle_points(self, times)

    def mean_duration(self) -> float:
        """Mean of the lesser of the first passage time and of an exponential one, for first steps.

        The latter has the mean of a relaxation time.
        """
        z = self.scene.damping
        mean = (1 - self.coarse_transform(z, 0.0)(z)).real / z
        return max(mean, tuning.PLANE_TRANSFORM.shortest / z)

    def largest_probability(self, time: float) -> float:
        """Chernoff's bound of the probability, from a few small exponents."""
        settings, transform = tuning.PLANE_TRANSFORM, self.coarse_transform(0.0, 0.0)
        return min(
            math.exp(s) * (abs(transform(s / time)) + settings.coarse) for s in settings.exponents
        )


def _require_resolved(scene, ends, distance):
    """Refuse thresholds that paths cross before they leave the elements around the start.

    On the nodes of these elements g is not 0 from the beginning: all levels may then agree on
    paths that cross too early.
    """
    settings, driven = tuning.NEAR_WALL, scene.noise.driven
    (slow,) = set(ends) - {driven}
    start = {symbol: scene.start.get(symbol.name, 0.0) for symbol in ends}
    times = np.geomspace(settings.first, 1.0, settings.times) / scene.damping
    # noise moves the driven variable like t^(1/2), whose integral moves the other one
    noisy = scene.noise.sigma * np.sqrt(times)
    reach = {driven: noisy, slow: (noisy + abs(start[driven])) * times}
    g = vectorised(scene.numerical_observable(), tuple(start))

    def ways(symbol):
        """How far int g gets, if one variable moves."""
        places = ({**start, symbol: start[symbol] + side * reach[symbol]} for side in (-1, 1))
        return times * np.max([np.abs(g(*place.values())) for place in places], axis=0)

    def crosses(symbol):
        """First time at which int g gets there, if it does."""
        there = ways(symbol) >= distance
        return int(np.argmax(there)) if there.any() else len(times)

    first = min(crosses(driven), crosses(slow))
    if first == 0 or (
        first == crosses(slow) < len(times)
        and abs(g(*start.values())) * times[first] < distance / settings.straight
        and reach[slow][first] < settings.share * ends[slow]
    ):
        raise ToleranceError(
            f"a threshold at {distance:.3g} from the start is crossed before grids of two "
            "variables resolve the state; use method='monte_carlo'"
        )


def inverted(
    problem: PlaneProblem,
    times: np.ndarray,
    tol: float,
    wanted: dict[tuple, np.ndarray] | None = None,
) -> Callable[..., np.ndarray]:
    """Prepare the inversion of the transform, on contours that serve all intervals of its grids.

    Parameters
    ----------
    problem : PlaneProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.
    tol : float
        Absolute error wanted, for fits of the transform.
    wanted : dict, optional
        From these intervals to the times at which they are to be solved, boolean arrays of the
        shape (k,); all unless given.

    Returns
    -------
    callable
        Takes the resolutions of the grid, driven and other variable, of the basis and of the
        contour, and how many times are wanted, None for all; returns probability and survival
        probability at the first of them, shape (2, m), 0 and 1 where the interval is not wanted.
    """
    least, count = np.log(tuning.PLANE.least_probability), len(times)
    own, known = problem.saddle_points(times), problem.grids.saddle_points(times)
    wanted = wanted or dict.fromkeys(known, np.full(count, True))
    counts = np.array([wanted[levels] & (of.bound >= least) for levels, of in known.items()])
    here, begin = wanted[problem.levels], np.searchsorted(own.bound, least)
    solve = contour_solver(problem, times, tol, in_common(list(known.values()), counts))
    nothing = np.array([np.zeros(count), np.ones(count)])

    def solved(resolution, first=None):
        *grid, contour = resolution
        level = tuning.PLANE.levels[contour]._replace(resolution=tuple(grid))
        found, *_ = solve(level, nothing, here & (np.arange(count) < (first or count)))
        # contours that serve others may not serve it yet
        found[:, :begin], found[:, ~here] = nothing[:, :begin], nothing[:, ~here]
        return found[:, :first]

    return solved


def tame(problem: PlaneProblem, times: np.ndarray) -> np.ndarray:
    """Whether contours may bend to the left, from some time on, and crossings are no longer rare.

    Where they may not, F has fronts, and small errors of a grid are large ones of a contour; paths
    that cross while this is rare fly there directly, which is such a front.

    Parameters
    ----------
    problem : PlaneProblem
    times : numpy.ndarray, shape (k,)
        Increasing, positive.

    Returns
    -------
    numpy.ndarray of bool, shape (k,)
        False where the coarsest grid does not tell.
    """
    settings = tuning.SADDLE_POINTS
    before = times / settings.since
    seen = np.union1d(before, times)
    try:
        saddles = problem.saddle_points(seen)
    except (ToleranceError, UnstableError):
        return np.full(len(times), False)
    bends = saddles.tilt[np.searchsorted(seen, before)] > settings.steepest
    risen = saddles.bound[np.searchsorted(seen, times)] >= np.log(settings.risen)
    return np.logical_and.accumulate((bends & risen)[::-1])[::-1]
