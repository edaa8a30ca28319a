"""The edges of the elements for discrete ordinates of one state variable.

Edges lie on the kinks of drift and g and on the zeros of g. Next to a threshold, the solution
behaves like |y|^(1/2) where g = 0 (grazing), so that elements are graded towards these zeros, and
a little towards the start. An element is also narrower than the spread of the velocities of paths
that go from there straight to a threshold.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nonsmooth.errors import ToleranceError, quoted
from nonsmooth.grids.grading import distinct
from nonsmooth.kinetic import tuning
from nonsmooth.line.kinks import isolated_zeros, sign_changes, switches
from nonsmooth.line.potential import depth, potential
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


def element_edges(
    scene: Scene,
    time: float,
    reach: float,
    deepest: float,
    grading: float,
    distances: tuple[float, float],
) -> np.ndarray:
    """Choose the edges of the elements.

    Parameters
    ----------
    scene, time, reach, deepest, grading, distances
        As for `ordinates_line.ordinates`.

    Returns
    -------
    numpy.ndarray
        Increasing; symmetric about 0 if drift and g are odd.

    Raises
    ------
    ToleranceError
        If double precision does not hold the density beyond the start, or too many elements would
        be needed.
    """
    settings, start = tuning.LINE_ORDINATES, scene.start.get("y", 0.0)
    end, scale = _extent(scene, time, reach, deepest)
    inside = np.linspace(-end, end, settings.searched)
    expression, knot = scene.numerical_observable(), potential(scene)[1]
    functions = [vectorised(f, (symbols.y,)) for f in [expression, *switches(expression)]]
    zeros, *kinks = [sign_changes(f, inside) for f in functions]
    zeros = isolated_zeros(functions[0], np.concatenate([zeros, *kinks]), end)
    starts = [start, -start] if scene.is_odd() else [start]
    finest = np.append(
        np.full(len(zeros), settings.finest), np.full(len(starts), settings.at_start)
    )
    widths = _Widths(
        scene,
        functions[0],
        np.append(zeros, starts),
        finest * scale,
        grading,
        deepest,
        distances,
    )
    edges = np.concatenate([[-end, 0.0, end], [knot, -knot], zeros, *kinks])
    edges = distinct(edges[np.abs(edges) <= end], 1e-12 * end)
    if scene.is_odd():
        edges = (edges - edges[::-1]) / 2
    return widths.refined(edges)


def _extent(scene, time, reach, deepest):
    """Half width of the axis, and the scale on which the solution changes with y."""
    phi, start = depth(scene), scene.start.get("y", 0.0)
    settings = tuning.LINE_ORDINATES
    end = scene.noise.sigma * np.sqrt(deepest / scene.damping)
    while phi(settings.shrink * end) > deepest:
        end *= settings.shrink
    inside = np.linspace(-end, end, settings.probed)
    weight = np.exp(-phi(inside))
    scale = min(
        np.sqrt(np.sum(weight * inside**2) / np.sum(weight)), scene.noise.sigma * np.sqrt(time)
    )
    beyond = abs(start) + min(settings.reach * scale, reach)
    if phi(beyond) > settings.deepest:
        raise ToleranceError(
            f"the start y = {start:g} is too far in the tails, where the stationary density is 0 "
            "in double precision; start nearer or use Monte Carlo"
        )
    return max(min(end, abs(start) + reach), beyond), scale


@dataclass(frozen=True)
class _Widths:
    """How wide elements may be.

    Attributes
    ----------
    scene : Scene
    g : callable
    singular, finest : numpy.ndarray, shape (s,)
        Zeros of g and the start, and the widths that elements may have next to them.
    grading, deepest, distances
        As for `ordinates_line.ordinates`.
    """

    scene: Scene
    g: Callable
    singular: np.ndarray
    finest: np.ndarray
    grading: float
    deepest: float
    distances: tuple[float, float]

    def refined(self, edges):
        """Cut elements until none is too wide."""
        settings, phi = tuning.LINE_ORDINATES, depth(self.scene)
        while True:
            left, right = edges[:-1], edges[1:]
            steep = np.abs(phi(right) - phi(left)) > settings.steepest
            # a little more is allowed, or rounding would cut elements that are just narrow enough
            cut = (right - left > 1.001 * self._allowed(left, right)) | steep
            if not cut.any():
                return edges
            left, right = left[cut], right[cut]
            # the cut is nearer to an end that is singular, so that elements there shrink fast
            at_left, at_right = (
                self._is_singular(left, right, left),
                self._is_singular(left, right, right),
            )
            part = np.where(
                at_left & ~at_right,
                settings.cut,
                np.where(at_right & ~at_left, 1 - settings.cut, 0.5),
            )
            edges = np.sort(np.append(edges, left + part * (right - left)))
            if len(edges) > settings.most:
                raise ToleranceError(
                    f"g = {quoted(self.scene.observable)} grows so fast that more than "
                    f"{settings.most} elements are needed; use method='monte_carlo'"
                )

    def _is_singular(self, left, right, end):
        return np.min(np.abs(end[:, None] - self.singular), axis=1) < 1e-9 * (right - left)

    def _allowed(self, left, right):
        distance = np.maximum(left[:, None] - self.singular, self.singular - right[:, None])
        graded = np.min(np.maximum(self.finest, self.grading * distance), axis=1)
        return np.minimum(graded, np.minimum(self._crossing(left), self._crossing(right)))

    def _crossing(self, y):
        """Width allowed by the spread of velocities of paths that go straight from y to a wall.

        It is larger where such velocities are rare.
        """
        settings, flow = tuning.LINE_ORDINATES, self.g(y)
        odd = self.scene.is_odd()
        lower, upper = (min(self.distances),) * 2 if odd else self.distances
        distance = np.where(flow > 0, upper, lower)
        digits = (self.deepest - depth(self.scene)(y)) / settings.digits
        share = np.clip(digits, settings.rarest, 1.0)
        return (
            settings.crossing
            * self.scene.noise.sigma
            * np.sqrt(distance / np.maximum(np.abs(flow), 1e-200))
            / share
        )
