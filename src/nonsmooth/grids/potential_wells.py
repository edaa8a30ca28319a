"""Wells of the potentials U, v and H, between which a scene may pass rarely."""

import itertools
import math

import numpy as np
import scipy

from nonsmooth.grids import mesh
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.symbols import x

_DEPTH = 20.0  # of the box that is searched, in temperatures
_POINTS = 4001
_STIFF = 1e6  # n whose box is searched at n = inf
_BARRIER = 2.0  # temperatures below which a barrier holds no path up for long
_MOST = 4  # wells of one variable, the deepest


def starts(scene):
    """Find starting points in all the wells that a path can be held in.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of dict
        Like `Scene.start`; one only where no barrier is in the way.
    """
    ends = mesh.box(scene if math.isfinite(scene.n) else scene.with_n(_STIFF), _DEPTH)
    places = {}
    for symbol, (potential, temperature) in mesh.potentials(scene, ends).items():
        end = min(ends[symbol], scene.mechanics.wall) if symbol == x else ends[symbol]
        places[symbol.name] = _minima(vectorised(potential, (symbol,)), end, temperature)
    return [dict(zip(places, point, strict=True)) for point in itertools.product(*places.values())]


def _minima(potential, end, temperature):
    """Deepest minima on [-end, end], those at an end included."""
    place = np.linspace(-end, end, _POINTS)
    height = potential(place) / temperature
    walled = np.pad(height, 1, constant_values=height.max() + 2 * _BARRIER)
    found = scipy.signal.find_peaks(-walled, prominence=_BARRIER)[0] - 1
    return sorted(float(p) for p in place[found[np.argsort(height[found])][:_MOST]])
