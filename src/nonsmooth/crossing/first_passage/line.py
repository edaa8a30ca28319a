"""First passage of int_0^t g for the state y with white noise, by Case's elementary solutions."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.problem import ContourSettings, LaplaceProblem
from nonsmooth.kinetic import tail_equation
from nonsmooth.kinetic.bases.reduced_line import on_line
from nonsmooth.kinetic.case_modes import modes
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.kinetic.tail_descent import Tail
from nonsmooth.scenes.scene import Scene


class Intervals:
    """Intervals of one scene, whose transforms share grids and modes.

    A grid serves the nearest walls. The modes at a place z cost much more than the transform of one
    more interval, so that it is computed for all of them at once.

    Parameters
    ----------
    scene : Scene
    ends : sequence, shape (m, 2)

    Attributes
    ----------
    problems : list of LineProblem
        One for each interval.
    """

    def __init__(self, scene: Scene, ends: Sequence[tuple[float, float]] | np.ndarray):
        nearest = tuple(np.min(np.abs(ends), axis=0))
        self.problems = [LineProblem(scene, lower, upper, self) for lower, upper in ends]
        # by polynomial degree, shortest time, reach and depth
        self.grid = cache(partial(ordinates, scene, distances=nearest))
        self.parts, self.on_line = cache(self._parts), cache(self._on_line)

    def _on_line(self, of_grid, abscissa, accuracy):
        """Return what `reduced_line.on_line` does; None if the grid is small or folded."""
        grid = self.grid(*of_grid)
        two_sided = all(problem.two_sided for problem in self.problems)
        if grid.mirrored or not two_sided or len(grid.moving) < tuning.LINE_GRIDS.many:
            return None
        intervals = [(problem.lower, problem.upper) for problem in self.problems]

        def exact(z):
            found = self.parts(of_grid, z)
            return np.array([found[interval] for interval in intervals])

        return on_line(grid, intervals, exact, abscissa, accuracy)

    def _parts(self, of_grid, z, line=None):
        """Parts of the transform at a place for each interval, if need be on a line alone."""
        found = modes(self.grid(*of_grid) if line is None else self.on_line(of_grid, *line)[0], z)
        return {
            (problem.lower, problem.upper): found.by_exit(problem.lower, problem.upper)
            if problem.is_split
            else np.array([found.first_passage(problem.lower, problem.upper)])
            for problem in self.problems
        }


@dataclass(frozen=True)
class _OfLine(LaplaceProblem):
    """A scene with the state y and white noise, and an interval.

    The resolution of a level is the polynomial degree of the grid.
    """

    scene: Scene
    lower: float
    upper: float

    @property
    def on_vertical_lines(self) -> bool:
        """Whether F is inverted on vertical lines: always, see `LaplaceProblem`."""
        return True

    def coarse_transform(self, radius: float, depth: float) -> Callable[[complex], complex]:
        """Return F on a grid of low degree; see `LaplaceProblem`."""
        grids, depth = tuning.LINE_GRIDS, 2.0 ** np.ceil(np.log2(depth))
        reach = self._reach(depth / radius, depth / 2)
        # depths that are powers of 2 have grids in common
        return self._on_coarse_grid(grids.coarse, depth / 2 / radius, reach, grids.depth + depth)

    def transform(
        self, resolution: int, times: np.ndarray, rarity: float
    ) -> Callable[[complex], complex]:
        """Return F on a grid for given times; see `LaplaceProblem`."""
        return self._on_grid(*self.fitting(resolution, times, rarity))

    def fitting(
        self, resolution: int, times: np.ndarray, rarity: float
    ) -> tuple[int, float, float, float]:
        """Return degree, shortest time, reach and depth of the grid for given times.

        Parameters
        ----------
        resolution, times, rarity
            As for `transform`.
        """
        reach = self._reach(times[-1], rarity)
        return resolution, times[0], reach, tuning.LINE_GRIDS.depth + rarity

    @abstractmethod
    def _on_grid(self, degree, time, reach, depth):
        """Return F on a grid."""

    def _on_coarse_grid(self, *of_grid):
        """As `_on_grid`, at places that other intervals ask for, too."""
        return self._on_grid(*of_grid)

    def _reach(self, time, depth):
        """Return a change of velocity that is unlikely to be exceeded within a time.

        Brownian motion exceeds it with a probability of at most 4 exp(-depth - 18). The drift,
        which points to the origin, makes that rarer still.
        """
        spare = tuning.LINE_GRIDS.spare
        return self.scene.noise.sigma * np.sqrt(2 * time * (depth + spare))


@dataclass(frozen=True)
class LineProblem(_OfLine):
    """First passage from a start that is not far in the tails.

    Attributes
    ----------
    intervals : Intervals
        All that are asked for, this one among them.
    """

    intervals: Intervals

    @property
    def settings(self) -> ContourSettings:
        """How accurate the problem is, and its levels."""
        return tuning.LINE

    @property
    def is_split(self) -> bool:
        """Whether F has two parts: not if there is one wall or one is the image of the other."""
        return self.two_sided and not (self.scene.is_odd() and self.lower == -self.upper)

    def parts(
        self, resolution: int, times: np.ndarray, rarity: float
    ) -> tuple[Callable[[complex], np.ndarray], np.ndarray]:
        """Parts of F by the wall through which paths leave; see `LaplaceProblem`.

        No path is there before g has been as large as it can be all the time.
        """
        of_grid = self.fitting(resolution, times, rarity)
        grid = self.intervals.grid(*of_grid)
        fastest = np.array([np.max(grid.g), -np.min(grid.g)])
        if grid.mirrored:
            fastest = np.full(2, fastest.max())
        distances = np.array([self.upper, -self.lower])
        fronts = np.divide(distances, fastest, out=np.zeros(2), where=fastest > 0)
        if not self.is_split:
            fronts = fronts[np.isfinite(distances)][:1]
        return lambda z: self.intervals.parts(of_grid, z)[self.lower, self.upper], fronts

    def parts_on_line(
        self,
        parts: Callable[[complex], np.ndarray],
        of_grid: tuple[int, np.ndarray, float],
        abscissa: float,
        accuracy: float,
    ) -> tuple[Callable[[complex], np.ndarray], float]:
        """Parts of F in a basis, if there is one; see `LaplaceProblem`."""
        key, line = self.fitting(*of_grid), (abscissa, accuracy)
        if (found := self.intervals.on_line(key, *line)) is None:
            return parts, 0.0
        _, highest, inexact = found

        def nearly(z):
            if z.imag > highest:
                return parts(z)
            return self.intervals.parts(key, z, line)[self.lower, self.upper]

        return nearly, inexact

    def _on_grid(self, *of_grid):
        grid = self.intervals.grid(*of_grid)
        return lambda z: modes(grid, z).first_passage(self.lower, self.upper)

    def _on_coarse_grid(self, *of_grid):
        return lambda z: self.intervals.parts(of_grid, z)[self.lower, self.upper].sum()


@dataclass(frozen=True)
class LineProblemFromAfar(_OfLine):
    """The rest of a path from a start far in the tails, after its first descent.

    Times count from the end of the descent, at which velocity and int g are normal.

    Attributes
    ----------
    tail : Tail
    """

    tail: Tail

    @property
    def settings(self) -> ContourSettings:
        """How accurate the problem is, and its levels."""
        return tuning.LINE_FROM_AFAR

    def _on_grid(self, degree, time, reach, depth):
        tail = self.tail
        grid = ordinates(
            replace(self.scene, start={"y": tail.side * tail.level}),
            degree,
            time,
            reach,
            depth,
            distances=(-self.lower, self.upper),
        )
        above_level = tail_equation.equation(tail, self.lower, self.upper, degree)
        return lambda z: above_level.mean(z, *modes(grid, z).waves(self.lower, self.upper))
