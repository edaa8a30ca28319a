"""Galerkin matrices of the generator in L^2(m) on Legendre elements of high degree.

The drift is smooth on each element: elements have their edges on its kinks and are graded towards
them, so that the error falls exponentially with the polynomial degree for every penalization.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from nonsmooth.errors import SceneError
from nonsmooth.grids.elements import energy, lagrange, lobatto, summed
from nonsmooth.grids.grading import growing, mirrored
from nonsmooth.line import tuning
from nonsmooth.line.integrands import finite_observable
from nonsmooth.line.potential import depth, potential
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


def mesh(scene: Scene) -> np.ndarray:
    """Return the element edges, increasing, symmetric about 0.

    Raises
    ------
    SceneError
        If the scene has another state or noise, or starts where the density is too small.
    """
    settings, knot, phi = tuning.SPECTRAL_ELEMENTS, potential(scene)[1], depth(scene)
    end = 1.0
    while phi(end / settings.step) > settings.depth:
        end /= settings.step
    while phi(end) < settings.depth:
        end *= settings.step
    start = abs(scene.start.get("y", 0.0))
    if phi(start) > settings.depth:
        raise SceneError(
            f"the start y = {scene.start['y']:g} is too far in the tails, where spectral elements "
            "weighted by the stationary density are not accurate; start nearer or use simulate"
        )
    end = max(end, settings.past_start * start)
    knot = min(knot, end)  # a kink beyond the end does not matter
    widest = end / settings.fewest
    finest = min(max(settings.finest, knot / settings.per_knot), widest)
    outer = growing(knot, end, finest, widest)
    inner = -growing(-knot, 0.0, finest, widest, spare=1.5)
    return mirrored([start, *outer, *inner])


@dataclass(frozen=True)
class Weighted:
    """Elements with a rule of quadrature in L^2(m).

    Attributes
    ----------
    half : numpy.ndarray, shape (e,)
        Half of the widths of the elements.
    nodes : numpy.ndarray, shape (e, d + 1)
    points, weights : numpy.ndarray, shape (e, q)
        Gauss points, and their weights times m.
    values, slopes : numpy.ndarray, shape (q, d + 1)
        Of the nodal functions at the points; slopes on an element of half width 1.
    """

    half: np.ndarray
    nodes: np.ndarray
    points: np.ndarray
    weights: np.ndarray
    values: np.ndarray
    slopes: np.ndarray

    def products(self, factor: np.ndarray | float = 1.0) -> np.ndarray:
        """Return <f phi_i, phi_j>, shape (k, k), for a factor f at the points."""
        return summed(self.values.T @ (w[:, None] * self.values) for w in self.weights * factor)

    def energies(self) -> np.ndarray:
        """Return <phi_i', phi_j'>, shape (k, k)."""
        scaled = self.weights / self.half[:, None] ** 2
        return summed(energy(self.slopes, w) for w in scaled)


def weighted(edges: np.ndarray, phi: Callable, degree: int) -> Weighted:
    """Prepare elements for integrals with the weight m = exp(-Phi).

    Parameters
    ----------
    edges : numpy.ndarray, shape (e + 1,)
    phi : callable
        Phi, of arrays.
    degree : int
        d, the polynomial degree.

    Returns
    -------
    Weighted
    """
    local, points, weights, values, slopes = _reference_element(degree)
    half = np.diff(edges) / 2
    left, wide = edges[:-1, None], half[:, None]
    at = left + wide * (points + 1)
    nodes = left + wide * (local + 1)
    return Weighted(half, nodes, at, weights * wide * np.exp(-phi(at)), values, slopes)


@lru_cache(maxsize=8)
def _reference_element(degree):
    """Nodes, Gauss points and weights, and the Lagrange basis with its slopes at these points."""
    nodes, _, _ = lobatto(degree)
    points, weights = legendre.leggauss(degree + tuning.SPECTRAL_ELEMENTS.extra_points)
    return nodes, points, weights, *lagrange(nodes, points)


def assemble(scene: Scene, degree: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Assemble mass, stiffness and observable matrices in L^2(m).

    Parameters
    ----------
    scene : Scene
    degree : int
        Polynomial degree of the elements.

    Returns
    -------
    nodes : numpy.ndarray, shape (k,)
    mass, stiffness, observable : numpy.ndarray, shape (k, k)
        <phi_i, phi_j>, (sigma^2/2) <phi_i', phi_j'> and <g phi_i, phi_j>, m of total mass 1.

    Raises
    ------
    SceneError
        As from `mesh`, or if g is not finite.
    """
    elements = weighted(mesh(scene), depth(scene), degree)
    g = vectorised(scene.numerical_observable(), (symbols.y,))
    observable = elements.products(finite_observable(scene, g, elements.points))
    mass = elements.products()
    total = mass.sum()
    factor = scene.noise.sigma**2 / 2
    nodes = np.append(elements.nodes[:, :-1], elements.nodes[-1, -1])
    return nodes, mass / total, factor * elements.energies() / total, observable / total
