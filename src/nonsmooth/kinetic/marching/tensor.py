"""Split steps on tensor grids: exp(A t) by alternating directions.

A is the sum of a part D in the variable that noise drives and a part O in the other variable. D
acts for each value of the other variable, O for each value of the driven one: both exponentials are
small matrices, where exp(A t) has the square of the number of nodes. Half a step of D goes before
and after O. The splitting is of order 2, as that of the transport is.
"""

import math
from dataclasses import dataclass

import numpy as np
import sympy

from nonsmooth.grids.generator import Change, assemble, evaluate, start_row
from nonsmooth.kinetic.marching.split_step import IMAGINARY, Interval, SplitStep
from nonsmooth.kinetic.ordinates_plane import axes
from nonsmooth.kinetic.tuning import PlaneLevel
from nonsmooth.linear_algebra import dense
from nonsmooth.scenes.scene import Scene

_NEAR = 0.1  # distance from 0 at which the drift's slope is taken, over the end of an axis


@dataclass(frozen=True)
class TensorOrdinates:
    """A grid of d values of the driven variable and o values of the other one.

    Attributes
    ----------
    speeds, start : numpy.ndarray, shape (o, d)
        g, and the weights that interpolate at the start.
    driven : numpy.ndarray, shape (o, d, d) or (1, d, d)
        D, for each value of the other variable or for all of them.
    other : numpy.ndarray, shape (d, o, o)
        O, for each value of the driven variable.
    rate : float
        At which the two variables act on each other, or the driven one relaxes; steps of exp(A t)
        should be shorter than its inverse.
    """

    speeds: np.ndarray
    start: np.ndarray
    driven: np.ndarray
    other: np.ndarray
    rate: float


def tensor_ordinates(
    scene: Scene,
    ends: dict,
    level: PlaneLevel,
    time: float,
    change: Change | None = None,
) -> TensorOrdinates:
    """Discretise a scene with two state variables, finite n, odd drift and odd g.

    Parameters
    ----------
    scene, ends, level, time
        As for `ordinates_plane.plane_ordinates`.
    change : Change, optional
        Of the scene; D and O get its `IMAGINARY` part, see `split_step`.

    Returns
    -------
    TensorOrdinates
    """
    made = axes(scene, ends, level, time)
    place = list(made).index(scene.noise.driven)
    shape = tuple(len(axis.nodes) for axis in made.values())

    def ordered(values):
        """From the order of the axes to that of (other, driven)."""
        return np.moveaxis(values.reshape(shape), place, -1)

    nodes = ordered(np.arange(np.prod(shape)))
    blocks = {}
    for symbol in made:
        A = assemble(scene, made, {symbol})
        if change is not None:
            A = A + IMAGINARY * assemble(scene, made, {symbol}, change)
        lines = nodes if symbol == scene.noise.driven else nodes.T
        blocks[symbol] = np.array([A[line][:, line].toarray() for line in lines])
    driven = blocks.pop(scene.noise.driven)
    (other,) = blocks.values()
    return TensorOrdinates(
        ordered(evaluate(scene.numerical_observable(), made)),
        ordered(start_row(scene, made)),
        driven[:1] if np.all(driven == driven[:1]) else driven,
        other,
        _rate(scene, made),
    )


def _rate(scene, made):
    """Largest rate of the drift about 0, but for the relaxation of the other variable alone."""
    steps = np.array([-_NEAR, 0.0, _NEAR])
    near = {symbol: axis.edges[-1] * steps for symbol, axis in made.items()}
    drift, slopes = scene.numerical_drift(), {}
    for row in made:
        values = evaluate(sympy.sympify(drift[row]), made, near).reshape(3, 3)
        changes = values[2, 1] - values[0, 1], values[1, 2] - values[1, 0]
        for column, change in zip(made, changes, strict=True):
            slopes[row, column] = change / np.ptp(near[column])
    first, second = made
    return max(
        abs(slopes[scene.noise.driven, scene.noise.driven]),
        math.sqrt(abs(slopes[first, second] * slopes[second, first])),
    )


class TensorSteps(SplitStep):
    """Steps on a tensor grid.

    Parameters
    ----------
    grid : TensorOrdinates
    interval : Interval
    step : float
    """

    def __init__(self, grid: TensorOrdinates, interval: Interval, step: float):
        pairs = grid.speeds.size // 2
        dtype = np.result_type(grid.driven, interval.forward)
        self._values = np.ones((*grid.speeds.shape, len(interval.kept)), dtype)
        self._spare = np.empty_like(self._values)
        flat = self._values.reshape(2 * pairs, -1)
        start = grid.start.reshape(2, pairs)
        super().__init__(
            interval,
            grid.speeds.reshape(2, pairs)[1],
            np.array([start[1], start[0, ::-1]]),
            flat[pairs:],
            flat[:pairs][::-1],
            step,
        )
        self.rate = grid.rate
        self._driven = np.array([dense.exponential(step / 2 * part) for part in grid.driven])
        self._other = np.array([dense.exponential(step * part) for part in grid.other])

    @property
    def operations(self) -> float:
        """Additions and multiplications of a step."""
        across = 2 * self._driven.shape[-1] + self._other.shape[-1]
        return super().operations + 2.0 * across * self._values.size

    def mix(self) -> None:
        """Apply D for half a step, O, and D for half a step."""
        by_driven, spare = (part.transpose(1, 0, 2) for part in (self._values, self._spare))
        np.matmul(self._driven, self._values, out=self._spare)
        np.matmul(self._other, spare, out=by_driven)
        np.matmul(self._driven, self._values, out=self._spare)
        self._values[:] = self._spare

    def doubled(self) -> None:
        """Make the step twice as long."""
        super().doubled()
        self._driven, self._other = self._driven @ self._driven, self._other @ self._other
