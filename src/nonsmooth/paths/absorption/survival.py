"""How many paths of an ensemble have left an interval of the state, and what the step changes."""

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.paths.absorption.envelope import scales
from nonsmooth.paths.absorption.loop import (
    STATIONARY,
    Interval,
    compile_march_survival,
    march_survival,
)
from nonsmooth.paths.ensembles import require_finite
from nonsmooth.paths.kernels.panel import DELTA, STATE, new_panel
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.time_grids import equal_steps
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


def crossed(
    scene: Scene,
    variable: str | None,
    levels: tuple[float, float],
    times: ArrayLike,
    sampling: Sampling,
    envelope: str | None = None,
) -> np.ndarray:
    """Sum up the probabilities of paths to have left an interval.

    Parameters
    ----------
    scene : Scene
    variable : str or None
        The variable of the state that leaves it; None stands for int g, which is then added up in
        the precision of the steps.
    levels : (float, float)
        Lower and upper end, between which it starts.
    times : array_like, shape (t,)
        Increasing.
    sampling : Sampling
        With the shorter of the two steps; its scheme must share the noise of two steps.
    envelope : str, optional
        Of the noise, see `envelope.scales`.

    Returns
    -------
    numpy.ndarray, shape (t, 3)
        Sums over the paths of C, C' - C and (C' - C)^2; C is the probability to have left the
        interval with the step, and C' that with twice the step.

    Raises
    ------
    SceneError
        If a path diverges, or the envelope is negative.
    """
    scheme, precision = sampling.scheme, sampling.precision
    interval = _interval(scene, variable, levels)
    grid = equal_steps(times, 2 * sampling.step)
    pairs = {
        h: (
            registry.coefficients(scene, scheme, h / 2, precision),
            registry.on_given_increments(registry.coefficients(scene, scheme, h, precision)),
        )
        for h in {h for _, h in grid}
    }
    factors = _factors(envelope, grid)
    compile_march_survival(*pairs[grid[0][1]], new_panel(scene, sampling.seed, 0, precision))

    def run(job):
        block, count = job
        panel, other = (new_panel(scene, sampling.seed, block, precision) for _ in range(2))
        before = np.tile(panel.data[interval.row, :count].astype(float), (2, 1))
        survival, sums = np.ones((2, count)), np.zeros((len(grid), 3))
        for k, (steps, h) in enumerate(grid):
            both = (*pairs[h], panel, other, count, steps, interval, before, survival)
            march_survival(*both, factors[k])
            change = survival[0] - survival[1]
            sums[k] = np.sum(1 - survival[0]), change.sum(), np.sum(change**2)
        require_finite(before)
        return sums

    total = np.zeros((len(grid), 3))
    for sums in parallel(run, sampling, 3 * sum(steps for steps, _ in grid)):
        total += sums
    return total


def _factors(envelope, grid):
    """Return the factors of the noise in the fine steps up to each output time."""
    if envelope is None:
        return [STATIONARY] * len(grid)
    ends = np.cumsum([steps * h for steps, h in grid])
    return [
        scales(envelope, end - steps * h, h / 2, 2 * steps)
        for end, (steps, h) in zip(ends, grid, strict=True)
    ]


def _interval(scene, variable, levels):
    if variable is None:
        return Interval(DELTA, *levels, 0.0)
    place = [symbol.name for symbol in STATE_VARIABLES].index(variable)
    driven = variable == scene.noise.driven.name
    return Interval(STATE[place], *levels, scene.noise.sigma**2 if driven else 0.0)
