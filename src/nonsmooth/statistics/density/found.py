"""What every method finds: a density at points, with its error."""

import math
from typing import NamedTuple

import numpy as np

from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


class Density(NamedTuple):
    """The density of one or two variables.

    Attributes
    ----------
    value : numpy.ndarray
        One axis for each variable.
    error : float
        Holds at every point.
    averaged : bool
        Whether values are averages over the cells around the points.
    """

    value: np.ndarray
    error: float
    averaged: bool = False


Found = dict[tuple[str, ...], Density]


def relative_error(density: Density) -> float:
    """Return the error relative to the largest value; inf if this is 0."""
    largest = float(np.max(density.value))
    return density.error / largest if largest > 0 else math.inf


def keys(scene: Scene) -> list[tuple[str, ...]]:
    """Names of the variables of each density: each alone, and the last two of the state."""
    names = [symbol.name for symbol in STATE_VARIABLES if symbol.name in scene.state]
    return [(name,) for name in names] + [tuple(names[-2:])] * (len(names) > 1)
