"""The edges of the elements: they lie on the kinks, and elements become smaller towards them."""

from collections.abc import Callable, Mapping

import numpy as np
import sympy
from sympy import Symbol

from nonsmooth.errors import SceneError
from nonsmooth.grids import tuning
from nonsmooth.grids.grading import geometric, layers, mirrored, split
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import n
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, x, y, zeta


def kinks(scene: Scene) -> dict[Symbol, float]:
    """Positive values at which a variable's coefficients, or the dynamics, have a kink.

    Parameters
    ----------
    scene : Scene
        With a finite n.

    Returns
    -------
    dict
        Maps symbols to values, "1"; variables without a kink are left out.
    """
    kink, inner, _ = scene.mechanics.penalty.at(scene.n)
    found = {scene.mechanics.argument: kink}
    if not scene.mechanics.is_friction:
        found[y] = 0.0  # the velocity at which the displacement turns back at a wall
    elif "eta" in scene.state and "x" not in scene.state:
        # the forcing that overcomes friction
        found[eta] = kink * (inner + scene.damping)
    return found


def is_smooth(scene: Scene, symbol: Symbol, end: float) -> bool:
    """Whether a variable has no kink in the box."""
    return kinks(scene).get(symbol, end) >= end


def has_walls(scene: Scene, end: float) -> bool:
    """Whether the displacement is held by walls that lie in the box."""
    return scene.mechanics.argument == x and not is_smooth(scene, x, end)


def element_edges(scene: Scene, symbol: Symbol, end: float, depth: int) -> np.ndarray:
    """Edges of the elements of one variable, symmetric about 0.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    symbol : sympy.Symbol
    end : float
        Half width of the box.
    depth : int
        Number of ever smaller elements towards a kink.

    Returns
    -------
    numpy.ndarray
    """
    chosen = tuning.ELEMENTS
    if is_smooth(scene, symbol, end):
        holding = _holding_force(scene) if symbol == eta else 0.0
        if symbol != scene.noise.driven and 0 < holding < end:
            return _both_sides(np.array([holding, end]))
        count = chosen.driven if symbol == scene.noise.driven else chosen.transported
        return np.linspace(-end, end, count + 1)
    kink = kinks(scene)[symbol]
    if kink == 0:
        return _both_sides(geometric(end, chosen.ratio_at_origin, depth + 1))
    finest = kink * chosen.ratio**-depth
    if symbol == y:  # the kink of friction, whose distance from 0 is the finest scale there is
        finest *= chosen.ratio**chosen.coarser_at_friction
    outward = _beyond(scene, end - kink, finest)
    if symbol == y:  # between the kinks friction is viscous, and velocities follow the forcing
        inward = _towards(kink, kink * chosen.stopping)
    else:
        inward = _towards(kink, min(finest, kink / 2))
    return _both_sides(np.concatenate([kink + outward, kink - inward, [kink]]))


def _holding_force(scene):
    """Return the forcing that holds the oscillator at rest at a wall, 0 if there is none."""
    if scene.mechanics.argument != x:
        return 0.0
    slope = vectorised(sympy.diff(scene.potential_expression, x), (x,))
    kink, _, _ = scene.mechanics.penalty.at(scene.n)
    return float(slope(np.array(kink)) - slope(np.array(-kink))) / 2


def _beyond(scene, beyond, finest):
    """Distances of the edges from the kink on its outer side, up to the end of the box."""
    chosen = tuning.ELEMENTS
    if not scene.mechanics.in_potential:
        return _towards(beyond, min(finest, beyond * chosen.stopping))
    # In an elastic wall the state turns in the plane of y and sqrt(n) x, however stiff the wall is.
    # The solution then bends over the depth of the wall no more than it does over the range of y,
    # so that there is no need for smaller elements towards the kink.
    outward = _towards(beyond, min(finest, beyond / 8))
    if scene.dimension <= 2:  # with more variables these elements are too expensive
        outward = np.append(outward, beyond * np.array(chosen.within_wall))
    return outward


def _towards(distance, finest):
    ratio = tuning.ELEMENTS.ratio
    return geometric(distance, ratio, layers(distance, finest, ratio))


def _both_sides(positive):
    """Add the origin and the negative half, and split elements that are too wide."""
    end = positive.max()
    positive = np.unique(np.append(positive[positive > 1e-14 * end], 0.0))
    parts = np.ceil(np.diff(positive) * tuning.ELEMENTS.widest / end).astype(int)
    return mirrored(split(positive, parts))


def potentials(
    scene: Scene, ends: Mapping[Symbol, float]
) -> dict[Symbol, tuple[sympy.Expr, float]]:
    """Potential in which each variable moves, and its temperature.

    The temperature is the one at which exp(-potential / temperature) is the invariant density, or
    an estimate of it.

    Parameters
    ----------
    scene : Scene
    ends : dict
        Half widths of the box, see `box.half_widths`. The temperature of a displacement is that of
        the velocity, estimated from its half width.

    Returns
    -------
    dict
        Maps symbols to potential and temperature.
    """
    found, noise, depth = {}, scene.noise, tuning.ELEMENTS.depth
    if noise.kind == "langevin":
        found[eta] = noise.potential_expression, noise.sigma**2 / 2
    elif noise.kind == "hamiltonian":
        for symbol, other in ((eta, zeta), (zeta, eta)):
            energy = noise.energy.subs(other, 0)
            reach = np.linspace(-ends[symbol], ends[symbol], 201)
            found[symbol] = energy, np.ptp(vectorised(energy, (symbol,))(reach)) / depth
    if x in ends:
        found[x] = _of_displacement(scene), ends[y] ** 2 / (2 * depth)
    return found


def _of_displacement(scene):
    """Return U, with a spring's potential unless the spring becomes a wall at n = inf."""
    if scene.mechanics.confines_displacement:
        return scene.potential_expression
    return scene.potential_expression + scene.mechanics.added_potential.subs(n, scene.n)


def resolving(edges: np.ndarray, potential: Callable, temperature: float) -> np.ndarray:
    """Split elements in which a potential has a barrier or changes its curvature.

    Across a barrier the Poisson solution is an error function, as wide as the distance over which
    the potential falls by the temperature. In a parabola it is as smooth as the observable.

    Parameters
    ----------
    edges : numpy.ndarray
        Symmetric about 0.
    potential : callable
        Takes values of the variable.
    temperature : float

    Returns
    -------
    numpy.ndarray

    Raises
    ------
    SceneError
        If the potential varies too much to be resolved.
    """
    chosen = tuning.ELEMENTS
    place = np.linspace(0, 1, chosen.samples + 1)
    values = potential(edges[:-1, None] + np.diff(edges)[:, None] * place)
    # the curvature times the element's width squared over 8: by how much the potential deviates
    # from a straight line over the element
    bend = np.diff(values, 2, axis=1) * chosen.samples**2 / 8
    lowest = bend.min(axis=1)
    excess = np.maximum(bend.max(axis=1) - lowest, -lowest) / temperature
    excess = np.maximum(excess, excess[::-1])  # rounding must not make the mesh asymmetric
    if not excess.max() <= chosen.steepest * chosen.most_parts**2:
        raise SceneError(
            f"a potential bends by {excess.max():.0e} temperatures within one element of the grid, "
            "which none can resolve; choose one that varies less or Monte Carlo"
        )
    parts = np.sqrt(np.clip(excess / chosen.bend, 1, chosen.most_parts**2))
    parts = np.ceil(parts - 1e-6).astype(int)
    parts += 1 - parts % 2  # odd, so that an even number of nodes stays even
    return split(edges, parts)
