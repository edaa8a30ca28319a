"""Paths that pass thresholds, again and again.

A path runs through cycles: a cycle lasts until int g has moved by b to either side, and for some
time after that. At equidistant times, called looks, a path is examined for passages.
"""

import math
from dataclasses import dataclass

import numpy as np

from nonsmooth.paths.ensembles import require_finite
from nonsmooth.paths.kernels.compilation import kernel
from nonsmooth.paths.kernels.panel import STATE, TOTAL_DELTA, new_panel
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.time_loop import (
    EVERYWHERE,
    compile_march,
    compile_march_pair,
    march,
    march_pair,
)
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


@dataclass(frozen=True)
class Cycle:
    """How a path is followed.

    Attributes
    ----------
    threshold : float
        b.
    after : int
        Looks from the passage until the end of the cycle.
    stride : int
        Steps from one look to the next.
    until : float
        Step of the last look.
    """

    threshold: float
    after: int
    stride: int = 1
    until: float = math.inf


@dataclass(frozen=True)
class Ends:
    """The ends of many cycles; what is below passed on the lower side is mirrored.

    Attributes
    ----------
    path : numpy.ndarray of int, shape (m,)
        Numbers of the paths.
    gain : numpy.ndarray, shape (m,)
        What int g has gained beyond b.
    state : dict
        Maps symbols to arrays of shape (m,).
    paths : int
        Number of all paths.
    """

    path: np.ndarray
    gain: np.ndarray
    state: dict
    paths: int


def followed(
    scene: Scene, approach: int, steps: int, cycles: list[Cycle], sampling: Sampling
) -> list[Ends]:
    """Follow paths through cycles.

    Parameters
    ----------
    scene : Scene
        With odd g and drift.
    approach : int
        Steps before the first cycle.
    steps : int
        Steps after that.
    cycles : list of Cycle
        Each is made of all paths.
    sampling : Sampling

    Returns
    -------
    list of Ends
        One for each kind of cycles.
    """
    s = registry.coefficients(scene, sampling.scheme, sampling.step, sampling.precision)
    compile_march(s, new_panel(scene, sampling.seed, 0, sampling.precision))

    def run(job):
        block, lanes = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        march(s, panel, lanes, approach, *EVERYWHERE)
        watches = [_Watch(panel, lanes, cycle) for cycle in cycles]
        return _watched(watches, steps, lambda: march(s, panel, lanes, 1, *EVERYWHERE))

    return _gathered(scene, parallel(run, sampling, approach + steps))


def followed_twice(
    scene: Scene, approach: int, steps: int, cycle: Cycle, sampling: Sampling
) -> list[Ends]:
    """Follow paths with half the step and with the step, on the same noise.

    Parameters
    ----------
    scene, approach, steps, cycle, sampling
        As for `followed`.

    Returns
    -------
    list of Ends
        With half the step, and with the step.
    """
    fine, coarse = (
        registry.coefficients(scene, sampling.scheme, h, sampling.precision)
        for h in (sampling.step / 2, sampling.step)
    )
    given = registry.on_given_increments(coarse)
    compile_march_pair(fine, given, new_panel(scene, sampling.seed, 0, sampling.precision))

    def run(job):
        block, lanes = job
        panels = [new_panel(scene, sampling.seed, block, sampling.precision) for _ in range(2)]
        none = np.empty((2, 0))

        def advance(by):
            march_pair(fine, given, *panels, lanes, by, *EVERYWHERE, 0.0, none)

        advance(approach)
        watches = [_Watch(panel, lanes, cycle) for panel in panels]
        return _watched(watches, steps, lambda: advance(1))

    return _gathered(scene, parallel(run, sampling, 3 * (approach + steps)))


class _Watch:
    """Looks at the paths of a panel, which all go through cycles of one kind."""

    def __init__(self, panel, lanes, cycle):
        self._panel, self._cycle = panel, cycle
        self.integral = panel.total[TOTAL_DELTA, :lanes]
        self._progress = np.zeros((3, lanes))
        self._progress[0] = self.integral
        self._ended = np.empty((2, lanes))
        self.ends = []

    def look(self, k):
        """Look at the paths after k steps."""
        if k % self._cycle.stride or k > self._cycle.until:
            return
        ended = _look(
            self._progress, self.integral, self._cycle.threshold, self._cycle.after, self._ended
        )
        if ended:
            path = self._ended[0, :ended].astype(int)
            side = self._progress[1, path]
            state = self._panel.data[STATE[0] : STATE[-1] + 1, path] * side
            self.ends.append(np.vstack([path, self._ended[1, :ended], state]))
            self._progress[1, path] = 0.0


@kernel
def _look(progress, integral, threshold, after, ended):
    """Notice passages; where the time after one is over, end the cycle and begin the next.

    `progress` has int g at the beginning of the cycle, the side of the passage and the looks since
    then. Write the places of the paths whose cycle has ended to `ended`, and what int g has gained
    beyond the threshold; return how many. Their sides are left for the caller to reset.
    """
    base, side, waited = progress
    found = 0
    for i in range(len(integral)):
        moved = integral[i] - base[i]
        if side[i] != 0:
            waited[i] += 1
        elif abs(moved) >= threshold:
            side[i] = 1.0 if moved > 0 else -1.0
        if side[i] != 0 and waited[i] >= after:
            ended[0, found], ended[1, found] = i, side[i] * moved - threshold
            base[i], waited[i] = integral[i], 0.0
            found += 1
    return found


def _watched(watches, steps, advance):
    """Look after every step; return the number of paths and their ends, for each watch."""
    for k in range(1, steps + 1):
        advance()
        for watch in watches:
            watch.look(k)
    for watch in watches:
        require_finite(watch.integral)
    return [(len(watch.integral), watch.ends) for watch in watches]


def _gathered(scene, blocks):
    """Join what the blocks of paths have found, for each kind of cycles."""
    return [_joined(scene, kind) for kind in zip(*blocks, strict=True)]


def _joined(scene, blocks):
    rows, first = [np.empty((2 + len(STATE), 0))], 0
    for lanes, ends in blocks:
        for found in ends:
            found[0] += first
            rows.append(found)
        first += lanes
    path, gain, *states = np.hstack(rows)
    state = {
        symbol: values
        for symbol, values in zip(STATE_VARIABLES, states, strict=True)
        if symbol.name in scene.state
    }
    return Ends(path.astype(int), gain, state, first)
