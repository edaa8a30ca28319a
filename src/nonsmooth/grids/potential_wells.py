"""Wells of the potentials U, v and H, between which paths may pass only rarely."""

import itertools
import math

import numpy as np
import scipy

from nonsmooth.grids import tuning
from nonsmooth.grids.mesh.box import half_widths, is_known
from nonsmooth.grids.mesh.edges import potentials
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import x, y


def starts(scene: Scene) -> list[dict[str, float]]:
    """Find starting points, one in each well that holds a path for long.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of dict
        Like `Scene.start`; a single one if no barrier holds paths up. Of a noise whose invariant
        density is not known neither the temperature nor the potential is: all wells of U near 0
        count.
    """
    chosen = tuning.POTENTIAL_WELLS
    finite = scene if math.isfinite(scene.n) else scene.with_n(chosen.stiff)
    if is_known(scene):
        ends = half_widths(finite, chosen.depth)
    else:
        ends = {y: chosen.cold} | ({x: chosen.far} if x.name in scene.state else {})
    places = {}
    for symbol, (potential, temperature) in potentials(scene, ends).items():
        end = min(ends[symbol], scene.mechanics.wall) if symbol == x else ends[symbol]
        places[symbol.name] = _minima(vectorised(potential, (symbol,)), end, temperature)
    return [dict(zip(places, point, strict=True)) for point in itertools.product(*places.values())]


def _minima(potential, end, temperature):
    """Deepest minima on [-end, end], those at an end included."""
    chosen = tuning.POTENTIAL_WELLS
    place = np.linspace(-end, end, chosen.points)
    height = potential(place) / temperature
    walled = np.pad(height, 1, constant_values=height.max() + 2 * chosen.barrier)
    found = scipy.signal.find_peaks(-walled, prominence=chosen.barrier)[0] - 1
    return sorted(float(p) for p in place[found[np.argsort(height[found])][: chosen.most]])
