"""Elements that resolve densities where a stiff force makes one variable follow another.

A displacement that yields, and a velocity that friction holds, follow the variable that noise
drives and lag behind it. Their density is concentrated along a line that is as wide as the lag.
Elements that crowd towards a kink miss most of it; here they are as wide as some lags.
"""

import math
from collections.abc import Mapping

import numpy as np
from sympy import Symbol

from nonsmooth.grids import tuning
from nonsmooth.grids.grading import distinct, geometric, growing, layers, mirrored
from nonsmooth.grids.mesh.edges import kinks
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, y


def is_held(scene: Scene) -> bool:
    """Whether a stiff force holds a variable of the state that noise does not drive."""
    model, held = scene.mechanics, scene.mechanics.argument
    transported = held.name in scene.state and held != scene.noise.driven
    return transported and not model.in_potential


def resolves_layer(scene: Scene, end: float) -> bool:
    """Whether there is such a layer, and few enough elements resolve it.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    end : float
        Half width of the box of the variable that noise drives.

    Returns
    -------
    bool
    """
    if scene.dimension > 2 or not is_held(scene):
        return False
    return end <= tuning.LAYERS.most * _finest(scene, 0)[0]


def misses_layer(scene: Scene, ends: Mapping[Symbol, float], edges: np.ndarray) -> bool:
    """Whether elements of the variable that is held are too wide for its layer.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    ends : dict
        Half widths of the box.
    edges : numpy.ndarray
        Of the elements of this variable.

    Returns
    -------
    bool
        Whether an element next to the kink is wider than those that resolve the layer, or all that
        is beyond the kink, where a displacement yields. What the variable follows is driven by
        noise, or changes by its half width in a unit of time.
    """
    held = scene.mechanics.argument
    if not is_held(scene) or kinks(scene)[held] >= ends[held]:
        return False
    followed = eta if scene.mechanics.is_friction and eta in ends else y
    if followed == scene.noise.driven:
        width = _finest(scene, 0)[1]
    else:
        width = tuning.LAYERS.width * ends[followed] / _stiffness(scene) ** 2
    if scene.mechanics.is_plastic:
        return ends[held] - kinks(scene)[held] > width
    place = int(np.argmin(np.abs(edges - kinks(scene)[held])))
    return bool(np.max(np.diff(edges[place - 1 : place + 2])) > width)


def layered_edges(scene: Scene, symbol: Symbol, end: float, level: int) -> np.ndarray:
    """Edges of the elements of one variable, symmetric about 0, where a density has a layer.

    Parameters
    ----------
    scene : Scene
    symbol : sympy.Symbol
    end : float
        Half width of the box.
    level : int
        From 0 on; elements become smaller.

    Returns
    -------
    numpy.ndarray
        One of them is 0, so that a transported variable has an even number of nodes.
    """
    chosen = tuning.LAYERS
    width, narrow = _finest(scene, level)
    widest = end / (chosen.fewest + level)
    kink = kinks(scene)[symbol]
    # At the kink solutions are least smooth where the velocity is 0: a displacement has moved by
    # the cube of a velocity when noise has reached this.
    corner = chosen.ratio ** -(chosen.corner + level)
    if symbol == scene.noise.driven:
        edges = np.linspace(0, end, math.ceil(end / min(width, widest)) + 1)
        corner **= 1 / 3
    elif kink >= end:
        edges = np.linspace(0, end, chosen.fewest + level + 1)
    else:
        edges = _about_kink(scene, kink, end, narrow, widest, level)
    if not scene.mechanics.is_friction and kink < end:
        edges = _crowded(edges, kink, corner * end)
    return mirrored(distinct(edges[edges > 0], relative=chosen.distinct))


def _finest(scene, level):
    """Return the width of the elements of the driven variable, and of those within the layer."""
    chosen, rate = tuning.LAYERS, _stiffness(scene)
    lag = scene.noise.sigma / math.sqrt(2 * rate)  # its standard deviation
    width = lag * chosen.width / (1 + level * chosen.narrower)
    return width, width / rate


def _stiffness(scene):
    """Return the rate at which the variable that is held follows."""
    _, inner, outer = scene.mechanics.penalty.at(scene.n)
    return max(inner, outer) + (scene.damping if scene.mechanics.is_friction else 0.0)


def _about_kink(scene, kink, end, narrow, widest, level):
    """Return equal elements on the stiff side of the kink, and growing ones on the other side."""
    chosen, stiff_within = tuning.LAYERS, scene.mechanics.is_friction
    depth, rest = (kink, end - kink) if stiff_within else (end - kink, kink)
    count = math.ceil(depth / min(narrow, depth / (chosen.fewest + level), widest))
    stiff = np.linspace(0, depth, count + 1)
    soft = growing(stiff[1], rest, stiff[1], widest, chosen.spare)
    soft = np.append(soft[soft < rest], rest)
    if stiff_within:
        return np.concatenate([stiff, kink + soft])
    return np.concatenate([kink + stiff, kink - soft])


def _crowded(edges, kink, finest):
    """Add ever smaller elements on both sides of a kink, down to a finest one."""
    ratio = tuning.LAYERS.ratio
    size = np.min(np.abs(edges[edges != kink] - kink))
    if finest >= size:
        return edges
    near = geometric(size, ratio, layers(size, finest, ratio) + 1)[1:]
    return np.concatenate([edges, kink + near, kink - near])
