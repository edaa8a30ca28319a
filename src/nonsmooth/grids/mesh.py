"""Where the elements of a scene's variables end: on the kinks, graded towards them, in a box."""

import math

import numpy as np
import sympy

from nonsmooth.grids.elements import continuous, discontinuous
from nonsmooth.grids.grading import geometric, layers, mirrored, split
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import n
from nonsmooth.scenes.symbols import eta, x, y, zeta

ORDER = (
    eta,
    zeta,
    y,
    x,
)  # of the axes: the forcing first, for each value of which mechanics is solved
_INWARD = 4.0  # each element next to a kink is so many times smaller than its neighbour
_WITHIN = np.array([0.5, 0.75])  # edges within an elastic wall, relative to its depth
_STOPPING = 1 / 64  # finest element within a layer that only stops, relative to its thickness
_WIDEST = 2.2  # no element is wider than the half width divided by this
_DRIVEN, _TRANSPORTED = (
    3,
    4,
)  # elements of a variable without kinks, so that nodes are even in number
_DEPTH = 20.0  # of a usual box, in units of the temperature
_BEND = 1.0  # by so many temperatures may a potential bend in an element, beyond a parabola
_LAYERS = {eta: 2, y: 2}  # with many variables, if not 1
_SAMPLES, _MOST = 16, 9  # points at which the bend is measured; most parts of an element


def variables(scene):
    """Return the symbols of the scene's state in the order of the axes."""
    return tuple(symbol for symbol in ORDER if symbol.name in scene.state)


def box(scene, depth):
    """Half widths of a box that holds the invariant density, possibly with much to spare.

    From the noise's own density, and for the oscillator from the energy that the noise can feed
    into a damped linear one.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    depth : float
        Outside, the density is of the order exp(-depth) of its maximum.

    Returns
    -------
    dict
        Maps the symbols of the state to half widths, "1".
    """
    ends, noise = {}, scene.noise
    if noise.kind == "white":
        power = noise.sigma**2
    else:
        ends = _noise_box(noise, depth)
        # a spectral density of at most 2 var(eta) / (relaxation rate), taken as 2 widths^2 / depth
        power = 4 * ends[eta] ** 2 / depth
    speed = math.sqrt(power * depth / scene.damping)
    if eta in ends:
        speed = min(speed, 2 * ends[eta] / scene.damping)
    ends[y] = speed
    if "x" in scene.state:
        ends[x] = _reach(scene, speed, ends.get(eta, 0.0))
    return ends


def narrowed(scene, ends, found):
    """Replace half widths of the oscillator's variables by what a solution has shown.

    Parameters
    ----------
    scene : Scene
    ends : dict
        Half widths of all variables, as from `box`.
    found : dict
        Better half widths of `y` and `x`. That of a displacement between walls is not used: it
        follows from the velocity's; nor is it elsewhere if smaller than what the velocity
        allows, for a coarse solution does not see a well that holds little.
    """
    ends = ends | {y: found[y]}
    if x in ends:
        walls = scene.mechanics.argument == x
        allowed = _reach(scene, found[y], ends.get(eta, 0.0))
        ends[x] = allowed if walls else max(allowed, found[x])
    return ends


def _noise_box(noise, depth):
    reach = np.linspace(0, 60, 24001)[1:]
    if noise.kind == "langevin":
        v = vectorised(noise.potential_expression, (eta,))
        allowed = depth * noise.sigma**2 / 2
        both = np.minimum(v(reach), v(-reach)) - min(v(reach).min(), v(-reach).min(), v(0.0))
        return {eta: _last_below(reach, both, allowed)}
    energy = vectorised(noise.energy, (eta, zeta))
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    rays = reach[::20, None] * np.cos(angle), reach[::20, None] * np.sin(angle)
    H = energy(*rays)
    near = np.hypot(*rays) < 3
    weakest = max(np.min(vectorised(noise.dissipation, (eta, zeta))(*rays)[near]), 1e-2)
    inside = H - H.min() <= depth * noise.sigma**2 / (2 * weakest)
    return {
        eta: 1.02 * float(np.max(np.abs(rays[0])[inside], initial=0.1)),
        zeta: 1.02 * float(np.max(np.abs(rays[1])[inside], initial=0.1)),
    }


def _last_below(reach, values, allowed):
    below = np.flatnonzero(values <= allowed)
    return float(reach[below[-1]]) if len(below) else float(reach[0])


def _reach(scene, speed, forcing):
    """Half width of the displacement, given those of the velocity and of the forcing."""
    knot, _, outer = scene.mechanics.penalty.at(scene.n)
    if scene.mechanics.is_plastic:  # inward drift beyond, for every velocity
        return knot + 1.02 * speed / outer
    # the potential energy is that of the fastest velocity
    reach = np.geomspace(1e-3, 1e4, 4001)
    U = vectorised(scene.potential_expression, (x,))
    height = np.minimum(U(reach), U(-reach)) - min(U(reach).min(), U(-reach).min())
    free = _last_below(reach, height, speed**2 / 2 + forcing)
    if scene.mechanics.in_potential:
        return min(free, knot + speed / math.sqrt(outer) + forcing / outer)
    return free


def knots(scene):
    """Positive values at which a variable's coefficients, or the dynamics, have a kink."""
    knot, inner, _ = scene.mechanics.penalty.at(scene.n)
    found = {scene.mechanics.argument: knot}
    if not scene.mechanics.is_friction:
        found[y] = 0.0  # where the displacement turns back at a wall
    elif "eta" in scene.state and "x" not in scene.state:
        found[eta] = knot * (inner + scene.damping)  # the forcing that overcomes friction
    return found


def _is_smooth(scene, symbol, end):
    return knots(scene).get(symbol, end) >= end


def _holding(scene):
    """Return the forcing that holds the oscillator at rest at a wall, 0 if there is none."""
    if scene.mechanics.argument != x:
        return 0.0
    slope = vectorised(sympy.diff(scene.potential_expression, x), (x,))
    knot, _, _ = scene.mechanics.penalty.at(scene.n)
    return float(slope(np.array(knot)) - slope(np.array(-knot))) / 2


def _has_walls(scene, end):
    return scene.mechanics.argument == x and not _is_smooth(scene, x, end)


def edges(scene, symbol, end, depth):
    """Edges of the elements of one variable, symmetric about 0.

    Parameters
    ----------
    scene : Scene
    symbol : sympy.Symbol
    end : float
        Half width.
    depth : int
        Number of ever smaller elements towards a kink.

    Returns
    -------
    numpy.ndarray
    """
    if _is_smooth(scene, symbol, end):
        holding = _holding(scene) if symbol == eta else 0.0
        if symbol != scene.noise.driven and 0 < holding < end:
            return _both_sides(np.array([holding, end]))
        count = _DRIVEN if symbol == scene.noise.driven else _TRANSPORTED
        return np.linspace(-end, end, count + 1)
    knot = knots(scene)[symbol]
    if knot == 0:
        outward = geometric(end, 2.5, depth + 1)
        return _both_sides(outward)
    finest = knot * _INWARD**-depth
    if symbol == y:  # the kink of friction, whose distance from 0 is the finest scale there is
        finest *= _INWARD**1.5
    beyond = end - knot
    if scene.mechanics.in_potential:
        # an elastic wall is as deep as the box, however stiff: the motion in it turns through
        # the plane of y and sqrt(n) x, and the solution is as curved there as it is in y
        outward = _towards(beyond, min(finest, beyond / 8))
        if scene.dimension <= 2:  # elements are dear with more
            outward = np.append(outward, beyond * _WITHIN)
    else:
        outward = _towards(beyond, min(finest, beyond * _STOPPING))
    if symbol == y:  # within, velocities follow the forcing up to the edge
        inward = _towards(knot, knot * _STOPPING)
    else:
        inward = _towards(knot, min(finest, knot / 2))
    return _both_sides(np.concatenate([knot + outward, knot - inward, [knot]]))


def _towards(distance, finest):
    return geometric(distance, _INWARD, layers(distance, finest, _INWARD))


def _both_sides(positive):
    """Add the origin and the negative half, and split elements that are too wide."""
    end = positive.max()
    positive = np.unique(np.append(positive[positive > 1e-14 * end], 0.0))
    parts = np.ceil(np.diff(positive) * _WIDEST / end).astype(int)
    return mirrored(split(positive, parts))


def potentials(scene, ends):
    """Potential in which each variable moves, and the temperature.

    Parameters
    ----------
    scene : Scene
    ends : dict
        Half widths of the box, see `box`. The temperature of a displacement is that of the
        velocity, estimated from its half width.

    Returns
    -------
    dict
        Maps symbols to (sympy.Expr, float).
    """
    found, noise = {}, scene.noise
    if noise.kind == "langevin":
        found[eta] = noise.potential_expression, noise.sigma**2 / 2
    elif noise.kind == "hamiltonian":
        for symbol, other in ((eta, zeta), (zeta, eta)):
            energy = noise.energy.subs(other, 0)
            reach = np.linspace(-ends[symbol], ends[symbol], 201)
            found[symbol] = energy, np.ptp(vectorised(energy, (symbol,))(reach)) / _DEPTH
    if x in ends:
        found[x] = _displacement_potential(scene), ends[y] ** 2 / (2 * _DEPTH)
    return found


def _displacement_potential(scene):
    """U, and a spring's potential in it unless the spring becomes a wall at n = inf."""
    if scene.mechanics.confines_displacement:
        return scene.potential_expression
    return scene.potential_expression + scene.mechanics.added_potential.subs(n, scene.n)


def _resolved(edges, potential, temperature):
    """Split elements in which a potential has a barrier or changes its curvature.

    Across a barrier the Poisson solution is an error function, as wide as the potential's fall by
    the temperature; in a parabola it is as smooth as the observable.
    """
    place = np.linspace(0, 1, _SAMPLES + 1)
    values = potential(edges[:-1, None] + np.diff(edges)[:, None] * place)
    # curvature times the element's width squared over 8, by how much it bends the potential
    bend = np.diff(values, 2, axis=1) * _SAMPLES**2 / 8
    lowest = bend.min(axis=1)
    excess = np.maximum(bend.max(axis=1) - lowest, -lowest) / temperature
    excess = np.maximum(excess, excess[::-1])  # rounding must not make the mesh asymmetric
    parts = np.ceil(np.sqrt(np.clip(excess / _BEND, 1, _MOST**2)) - 1e-6).astype(int)
    parts += 1 - parts % 2  # an even number of nodes stays even
    return split(edges, parts)


def axes(scene, ends, levels, margin=0.0):
    """Discretise every variable of the state.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    ends : dict
        Half widths, see `box`.
    levels : dict
        Maps symbols to resolution levels, integers >= 0: each raises the polynomial degree and,
        in turn or each time, the number of layers towards a kink.
    margin : float
        Of elements added outside the box, relative to its width, to see whether it is too small.

    Returns
    -------
    dict
        Maps symbols, in the order of the axes, to `Axis`.
    """
    made, wells = {}, potentials(scene, ends)
    for symbol in variables(scene):
        level, end = levels[symbol], ends[symbol]
        # with many variables, layers are dear
        depth = 2 + level if len(levels) <= 2 else _LAYERS.get(symbol, 1)
        where = edges(scene, symbol, end, depth)
        if symbol in wells:
            potential, temperature = wells[symbol]
            where = _resolved(where, vectorised(potential, (symbol,)), temperature)
        if margin:
            # beyond a wall its own depth counts, not the distance between the walls
            scale = end - knots(scene)[x] if symbol == x and _has_walls(scene, end) else end
            where = np.concatenate([[-end - margin * scale], where, [end + margin * scale]])
        if symbol == scene.noise.driven:
            # odd degrees where there is no kink keep the number of nodes even
            stride = 2 if _is_smooth(scene, symbol, end) else 1
            made[symbol] = continuous(where, 3 + stride * level)
        else:
            made[symbol] = discontinuous(where, 2 + level)
    return made
