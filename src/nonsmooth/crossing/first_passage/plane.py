"""First passage of x' = g out of an interval for two state variables, by doubling slabs."""

import math

import numpy as np

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import ordinates_gibbs
from nonsmooth.kinetic.adding_doubling import half_space, slab
from nonsmooth.kinetic.ordinates_gibbs import gibbs_ordinates
from nonsmooth.kinetic.ordinates_plane import boxed, plane_ordinates

# resolution of the grid; nodes of a contour for a single time, and their spacing during the rise
_LEVELS = ((0, 7, 1.2), (1, 8, 1.05), (2, 9, 0.95), (3, 10, 0.9))
_FEWEST = 7  # doublings at resolution 0
_THIN = 0.1  # thinnest slab at resolution 0, relative to the way that g goes while it relaxes


def applies(scene):
    """Whether the scene has two state variables, white or Langevin noise, odd g and drift."""
    return (
        scene.dimension == 2
        and scene.noise.kind != "hamiltonian"
        and not math.isinf(scene.n)
        and scene.is_odd()
    )


class Plane:
    """A scene with two state variables to which this module `applies`, and an interval.

    One grid serves all times; probabilities have an absolute error.

    Parameters
    ----------
    scene : Scene
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    """

    tol, loose = 1e-4, 0.0
    cure = "loosen tol, or use method='monte_carlo'"
    relative = False
    levels: tuple[tuple, ...] = _LEVELS
    negligible, rounded = 2e-5, 1e-13
    narrow, last, least = 4.0, 1e-7, 1e-6
    inexact = 1e-5  # flow of the nodes that are taken to stand still

    def __init__(self, scene, lower, upper):
        self.scene, self.lower, self.upper = scene, lower, upper
        self._ends = boxed(scene)
        self._grids = {}

    def near_axis(self, _radius, _depth):
        """Return z -> E exp(-z tau) on the coarsest grid."""
        return self._on(0, 1 / self.scene.damping)

    def transform(self, resolution, times, _rarity):
        """Return z -> E exp(-z tau)."""
        return self._on(resolution, times[0])

    def _on(self, resolution, time):
        if resolution not in self._grids:  # of the shortest time, which is asked for first
            self._grids[resolution] = self._grid(resolution, time)
        grid = self._grids[resolution]
        return lambda z: first_passage(grid, z, self.lower, self.upper, resolution)

    def _grid(self, resolution, time):
        if ordinates_gibbs.applies(self.scene):
            return gibbs_ordinates(self.scene, self._ends, resolution)
        return plane_ordinates(self.scene, self._ends, resolution, time)


def first_passage(grid, z, lower, upper, resolution):
    """E exp(-z tau), tau the first time that int_0^t g leaves (lower, upper).

    Parameters
    ----------
    grid : PlaneOrdinates
    z : float or complex
    lower, upper : float
        Of opposite signs; one may be infinite.
    resolution : int
        Of the slabs, from 0.

    Returns
    -------
    float or complex
    """
    thin = _THIN * grid.way / 2**resolution

    def made(thickness):
        doublings = max(_FEWEST + resolution, math.ceil(math.log2(thickness / thin)))
        return slab(grid, z, thickness, doublings)

    one, ones = np.eye(len(grid.speeds)), grid.ones[: len(grid.speeds)]
    if lower == -upper:
        half = made(upper)
        even = np.linalg.solve(one - half.reflection, half.transmission @ ones)
        return grid.start_row(z, EVEN) @ even
    # values at the start where the flow enters the slab above, and that below
    below, above = (made(abs(b)) if np.isfinite(b) else None for b in (lower, upper))
    into = [s.transmission @ ones if s else 0 * ones for s in (below, above)]
    below = below.reflection if below else half_space(above)
    above = above.reflection if above else half_space(made(abs(lower)))
    up = np.linalg.solve(one - above @ below, into[1] + above @ into[0])
    down = into[0] + below @ up
    odd = np.sign(grid.speeds) * (up - down) / 2
    return grid.start_row(z, EVEN) @ (up + down) / 2 + grid.start_row(z, ODD) @ odd
