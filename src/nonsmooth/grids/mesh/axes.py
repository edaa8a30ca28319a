"""The axes of a tensor grid: one for each variable of a scene's state."""

from collections.abc import Mapping

import numpy as np
from sympy import Symbol

from nonsmooth.grids import tuning
from nonsmooth.grids.elements import Axis, continuous, discontinuous
from nonsmooth.grids.mesh.edges import (
    element_edges,
    has_walls,
    is_smooth,
    kinks,
    potentials,
    resolving,
)
from nonsmooth.grids.mesh.hermite import deviation, hermite
from nonsmooth.grids.mesh.layers import layered_edges, resolves_layer
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, x, y, zeta

# The forcing comes first: the iterative solver solves the oscillator's equations for each of its
# values, which are blocks of the matrix in this order.
ORDER = (eta, zeta, y, x)


def variables(scene: Scene) -> tuple[Symbol, ...]:
    """Return the symbols of the scene's state in the order of the axes."""
    return tuple(symbol for symbol in ORDER if symbol.name in scene.state)


def axes(
    scene: Scene,
    ends: Mapping[Symbol, float],
    levels: Mapping[Symbol, int],
    margin: float = 0.0,
    of_density: bool = False,
) -> dict[Symbol, Axis]:
    """Discretise every variable of the state.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    ends : dict
        Half widths, see `box.half_widths`.
    levels : dict
        Maps symbols to resolution levels, integers >= 0. Each level raises the polynomial degree
        and, with two variables, the number of layers towards a kink.
    margin : float
        Width of an element that is added on either side of the box, relative to the half width, to
        see whether the box is too small. Polynomials of a normal variable need no box.
    of_density : bool
        Whether densities are solved for, in the place of functions. Functions are continued beyond
        the box by their polynomials, to which mass would be lost; so elements of degree 0 are added
        for densities, from which it comes back. The other elements then resolve layers.

    Returns
    -------
    dict
        Maps symbols, in the order of the axes, to `Axis`.
    """
    made, wells, chosen = {}, potentials(scene, ends), tuning.HERMITE
    layered = of_density and resolves_layer(scene, ends[scene.noise.driven])
    for symbol in variables(scene):
        level, end = levels[symbol], ends[symbol]
        if len(levels) > 2 and (spread := deviation(scene, symbol)) is not None:
            made[symbol] = hermite(chosen.fewest + chosen.added * level, spread, end)
            continue
        if layered:
            edges = layered_edges(scene, symbol, end, level)
        else:
            edges = element_edges(scene, symbol, end, _layers(scene, symbol, levels, of_density))
        if symbol in wells:
            potential, temperature = wells[symbol]
            edges = resolving(edges, vectorised(potential, (symbol,)), temperature)
        # within a wall the margin is relative to the depth of the wall, which may be much
        # smaller than the half width
        scale = end - kinks(scene)[x] if symbol == x and has_walls(scene, end) else end
        if margin:
            edges = _wider(edges, margin * scale)
        if symbol == scene.noise.driven:
            # Without a kink the number of elements is odd. Odd degrees then make the number of
            # nodes even, so that symmetry can be used.
            stride = 2 if is_smooth(scene, symbol, end) else 1
            degree = tuning.LAYERS.degree + level if layered else 2 + stride * level
            made[symbol] = continuous(edges, 1 + degree, closed=of_density)
            continue
        degrees = np.full(len(edges) - 1, tuning.LAYERS.degree if layered else 2) + level
        if of_density:
            edges = _wider(edges, tuning.LAYERS.rim * scale)
            degrees = np.concatenate([[0], degrees, [0]])
        made[symbol] = discontinuous(edges, degrees)
    return made


def _wider(edges, margin):
    """Add an element on either side."""
    return np.concatenate([[edges[0] - margin], edges, [edges[-1] + margin]])


def _layers(scene, symbol, levels, of_density):
    """Return the number of ever smaller elements towards a kink; few with many variables."""
    if len(levels) <= 2:
        return 2 + levels[symbol]
    chosen = tuning.ELEMENTS
    if of_density and symbol == x and scene.mechanics.is_plastic:
        return chosen.layers_of_yielding
    return chosen.more_layers if symbol in (eta, y) else chosen.few_layers
