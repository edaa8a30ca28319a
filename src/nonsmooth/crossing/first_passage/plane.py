"""First passage of int_0^t g for two state variables, by adding and doubling of slabs."""

import math
from collections.abc import Callable

import numpy as np

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.problem import ContourSettings, LaplaceProblem
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import ordinates_gibbs
from nonsmooth.kinetic.adding_doubling import half_space, slab
from nonsmooth.kinetic.ordinates_gibbs import gibbs_ordinates
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates, boxed, plane_ordinates
from nonsmooth.scenes.scene import Scene


def applies(scene: Scene) -> bool:
    """Whether the scene has two state variables, white or Langevin noise, odd g and drift."""
    return (
        scene.dimension == 2
        and scene.noise.kind != "hamiltonian"
        and not math.isinf(scene.n)
        and scene.is_odd()
    )


class PlaneProblem(LaplaceProblem):
    """A scene with two state variables to which this module `applies`, and an interval.

    The resolution of a level is that of the grid and of the slabs. One grid serves all times.

    Parameters
    ----------
    scene : Scene
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    """

    def __init__(self, scene: Scene, lower: float, upper: float):
        self.scene, self.lower, self.upper = scene, lower, upper
        self._ends = boxed(scene)
        self._grids: dict[int, PlaneOrdinates] = {}

    @property
    def settings(self) -> ContourSettings:
        """How accurate the problem is, and its levels."""
        return tuning.PLANE

    def coarse_transform(self, radius: float, depth: float) -> Callable[[complex], complex]:
        """Return F on the coarsest grid; see `LaplaceProblem`."""
        return self._on_grid(0, 1 / self.scene.damping)

    def transform(
        self, resolution: int, times: np.ndarray, rarity: float
    ) -> Callable[[complex], complex]:
        """Return F on a grid of some resolution; see `LaplaceProblem`."""
        return self._on_grid(resolution, times[0])

    def discretised(self, level: int, time: float) -> PlaneOrdinates:
        """Make a grid.

        Parameters
        ----------
        level : int
            Of resolution, from 0.
        time : float
            Shortest time of interest.
        """
        if ordinates_gibbs.applies(self.scene):
            return gibbs_ordinates(self.scene, self._ends, level)
        return plane_ordinates(self.scene, self._ends, level, time)

    def mean_duration(self, time: float) -> float:
        """Mean of the lesser of the first passage time and of an exponential time of mean `time`.

        It is at least a small part of `time`.
        """
        z = 1 / time
        mean = (1 - self.coarse_transform(z, 0.0)(z)).real / z
        return max(mean, tuning.SLABS.least * time)

    def _on_grid(self, resolution, time):
        # the window of the shortest times is asked for first; its grid serves the others, too
        if resolution not in self._grids:
            self._grids[resolution] = self.discretised(resolution, time)
        grid = self._grids[resolution]
        return lambda z: first_passage(grid, z, self.lower, self.upper, resolution)


def first_passage(
    grid: PlaneOrdinates, z: complex, lower: float, upper: float, resolution: int
) -> complex:
    """E exp(-z tau), tau the first time that int_0^t g leaves (lower, upper).

    The start divides the interval into two slabs. Their reflection and transmission give the values
    at the start where the flow enters either of them.

    Parameters
    ----------
    grid : PlaneOrdinates
    z : complex
    lower, upper : float
        Of opposite signs; one may be infinite.
    resolution : int
        Of the slabs, from 0.

    Returns
    -------
    complex
    """
    settings = tuning.SLABS
    thin = settings.thin * grid.way / 2**resolution

    def made(thickness):
        doublings = max(settings.fewest + resolution, math.ceil(math.log2(thickness / thin)))
        return slab(grid, z, thickness, doublings)

    one, ones = np.eye(len(grid.speeds)), grid.ones[: len(grid.speeds)]
    if lower == -upper:
        half = made(upper)
        even = np.linalg.solve(one - half.reflection, half.transmission @ ones)
        return (grid.start_row(z, EVEN) @ even).item()
    below, above = (made(abs(b)) if np.isfinite(b) else None for b in (lower, upper))
    from_below, from_above = (s.transmission @ ones if s else 0 * ones for s in (below, above))
    reflects_below = below.reflection if below else half_space(above or made(upper))
    reflects_above = above.reflection if above else half_space(below or made(-lower))
    # values at the start where the flow enters the slab above, and that below
    up = np.linalg.solve(
        one - reflects_above @ reflects_below, from_above + reflects_above @ from_below
    )
    down = from_below + reflects_below @ up
    odd = np.sign(grid.speeds) * (up - down) / 2
    return (grid.start_row(z, EVEN) @ (up + down) / 2 + grid.start_row(z, ODD) @ odd).item()
