"""First passage of int_0^t g for the state y with white noise, by Case's elementary solutions."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.problem import ContourSettings, LaplaceProblem
from nonsmooth.kinetic import tail_equation
from nonsmooth.kinetic.case_modes import by_exit, first_passage, waves
from nonsmooth.kinetic.ordinates_line import ordinates
from nonsmooth.kinetic.tail_descent import Tail
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class LineProblem(LaplaceProblem):
    """A scene with the state y and white noise, and an interval.

    The resolution of a level is the polynomial degree of the grid.
    """

    scene: Scene
    lower: float
    upper: float

    @property
    def settings(self) -> ContourSettings:
        """How accurate the problem is, and its levels."""
        return tuning.LINE

    def coarse_transform(self, radius: float, depth: float) -> Callable[[complex], complex]:
        """Return F on a grid of low degree; see `LaplaceProblem`."""
        grids, time = tuning.LINE_GRIDS, depth / radius
        return self._on_grid(grids.coarse, time, self._reach(time, depth / 2), grids.depth + depth)

    def transform(
        self, resolution: int, times: np.ndarray, rarity: float
    ) -> Callable[[complex], complex]:
        """Return F on a grid for given times; see `LaplaceProblem`."""
        return self._on_grid(*self._fitting(resolution, times, rarity))

    @property
    def on_vertical_lines(self) -> bool:
        """Whether F is inverted on vertical lines: always, see `LaplaceProblem`."""
        return True

    def parts(
        self, resolution: int, times: np.ndarray, rarity: float
    ) -> tuple[Callable[[complex], np.ndarray], np.ndarray]:
        """Parts of F by the wall through which paths leave; see `LaplaceProblem`.

        No path is there before g has been as large as it can be all the time.
        """
        grid = self._grid(*self._fitting(resolution, times, rarity))
        fastest = np.array([np.max(grid.g), -np.min(grid.g)])
        if grid.mirrored:
            fastest = np.full(2, fastest.max())
        distances = np.array([self.upper, -self.lower])
        fronts = np.divide(distances, fastest, out=np.zeros(2), where=fastest > 0)
        fronts[np.isinf(fronts)] = 0.0  # nothing leaves there
        return lambda z: by_exit(grid, z, self.lower, self.upper), fronts

    def _fitting(self, resolution, times, rarity):
        """Return degree, shortest time, reach and depth of the grid for given times."""
        reach = self._reach(times[-1], rarity)
        return resolution, times[0], reach, tuning.LINE_GRIDS.depth + rarity

    def _on_grid(self, degree, time, reach, depth):
        grid = self._grid(degree, time, reach, depth)
        return lambda z: first_passage(grid, z, self.lower, self.upper)

    def _grid(self, degree, time, reach, depth):
        return ordinates(
            self.scene, degree, time, reach, depth, distances=(-self.lower, self.upper)
        )

    def _reach(self, time, depth):
        """Return a change of velocity that is unlikely to be exceeded within a time.

        Brownian motion exceeds it with a probability of at most 4 exp(-depth - 18). The drift,
        which points to the origin, makes that rarer still.
        """
        spare = tuning.LINE_GRIDS.spare
        return self.scene.noise.sigma * np.sqrt(2 * time * (depth + spare))


@dataclass(frozen=True)
class LineProblemFromAfar(LineProblem):
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

    parts = LaplaceProblem.parts

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
        return lambda z: above_level.mean(z, *waves(grid, z, self.lower, self.upper))
