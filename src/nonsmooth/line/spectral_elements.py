"""Galerkin matrices of the generator in L^2(m) on Legendre elements of high degree.

The drift is smooth on each element: elements have their edges on its kinks and are graded towards
them, so that the error falls exponentially with the polynomial degree for every penalization.
"""

from functools import lru_cache
from itertools import pairwise

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
    edges, phi = mesh(scene), depth(scene)
    g = vectorised(scene.numerical_observable(), (symbols.y,))
    nodes, points, weights, values, slopes = _reference_element(degree)
    mass, stiffness, observable = [], [], []
    where = np.empty((len(edges) - 1) * degree + 1)
    for k, (left, right) in enumerate(pairwise(edges)):
        half = (right - left) / 2
        where[k * degree : (k + 1) * degree + 1] = left + half * (nodes + 1)
        at = left + half * (points + 1)
        weight = weights * half * np.exp(-phi(at))
        values_of_g = finite_observable(scene, g, at)
        mass.append(values.T @ (weight[:, None] * values))
        observable.append(values.T @ ((weight * values_of_g)[:, None] * values))
        stiffness.append(energy(slopes, weight / half**2))
    masses = summed(mass)
    total = masses.sum()
    factor = scene.noise.sigma**2 / 2
    return where, masses / total, factor * summed(stiffness) / total, summed(observable) / total
