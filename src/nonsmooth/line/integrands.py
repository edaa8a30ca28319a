"""What is integrated for a scene: Phi and g as functions of y, and elements to begin with."""

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
import scipy
import sympy

from nonsmooth.errors import SceneError, quoted
from nonsmooth.grids.grading import distinct
from nonsmooth.line import tuning
from nonsmooth.line.gauss_elements import NODES, GaussElements
from nonsmooth.line.kinks import sign_changes, switches
from nonsmooth.line.potential import potential
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene

_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Integrands:
    """A scene as functions of y.

    Attributes
    ----------
    scene : Scene
    depth : callable
        Phi, of `potential`.
    knot : float
        Where Phi has kinks, at -knot and knot.
    constant : float
        Additive constant of g, kept apart so that a large one costs no digits.
    varying : sympy.Expr
        The rest of g.
    """

    scene: Scene
    depth: Callable
    knot: float
    constant: float
    varying: sympy.Expr

    @classmethod
    def of(cls, scene: Scene) -> "Integrands":
        """Take the functions from a scene.

        Raises
        ------
        SceneError
            If the scene's state is not y alone or its noise is not white.
        """
        energy, knot = potential(scene)
        constant, varying = scene.numerical_observable().as_independent(symbols.y, as_Add=True)
        return cls(scene, vectorised(energy, (symbols.y,)), knot, float(constant), varying)

    def g(self, y: np.ndarray) -> np.ndarray:
        """Evaluate g without its constant.

        Raises
        ------
        SceneError
            If it is not finite.
        """
        return finite_observable(self.scene, vectorised(self.varying, (symbols.y,)), y)

    def first_elements(self) -> GaussElements:
        """Make elements with edges at 0 and on the kinks, in which exp(-Phi) changes little."""
        edges = self._edges()
        return self._on(edges[:-1], edges[1:])

    def halved(self, elements: GaussElements, marked: np.ndarray) -> GaussElements:
        """Halve the marked elements."""
        left, right = elements.left[marked], elements.right[marked]
        middle = (left + right) / 2
        new = self._on(np.append(left, middle), np.append(middle, right))
        order = np.argsort(np.append(elements.left[~marked], new.left))
        return GaussElements(
            *(
                np.concatenate([getattr(elements, f.name)[~marked], getattr(new, f.name)])[order]
                for f in fields(GaussElements)
            )
        )

    def _on(self, left, right):
        points = left[:, None] + (right - left)[:, None] / 2 * (NODES + 1)
        return GaussElements(left, right, points, self.depth(points), self.g(points))

    def _edges(self):
        settings = tuning.QUADRATURE
        # with damping alone Phi reaches that depth here; with friction it does so nearer to 0
        end = self.scene.noise.sigma * np.sqrt(settings.depth / self.scene.damping)
        if self.depth(end) > settings.depth:
            end = scipy.optimize.brentq(lambda y: self.depth(y) - settings.depth, 0.0, end)
        edges = _within([-end, -self.knot, 0.0, self.knot, end], end)
        functions = [vectorised(f, (symbols.y,)) for f in switches(self.varying)]
        # Kinks may be so close together that only the points of shorter elements tell them apart:
        # look for them again until no more are found.
        while True:
            while np.any(steep := np.abs(np.diff(self.depth(edges))) > settings.steepest):
                edges = np.sort(np.append(edges, (edges[:-1] + edges[1:])[steep] / 2))
            grown = _within(
                np.concatenate([edges, *(sign_changes(f, edges) for f in functions)]), end
            )
            if len(grown) == len(edges) or len(grown) > settings.most_elements:
                return edges
            edges = grown


def finite_observable(scene: Scene, g: Callable, y: np.ndarray) -> np.ndarray:
    """Evaluate g, or g without its additive constant, and refuse values that are not finite.

    Raises
    ------
    SceneError
        If it is not finite.
    """
    # all branches of a formula are evaluated everywhere, also where they are not taken
    with np.errstate(all="ignore"):
        value = g(y)
    if not np.all(np.isfinite(value)):
        place = np.asarray(y)[~np.isfinite(value)][0]
        raise SceneError(
            f"g = {quoted(scene.observable)} is not finite at y = {place:g}; "
            "choose one that is, or write it so that it does not overflow"
        )
    return value


def _within(edges, end):
    """Sort edges within [-end, end]; of those that only rounding keeps apart, keep the first."""
    return distinct(np.clip(edges, -end, end), relative=8 * _EPS)
