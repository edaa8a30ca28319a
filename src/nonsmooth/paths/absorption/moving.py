"""Moments and paths of int g under an envelope, with a step and with half of it."""

import functools
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.paths.absorption.loop import Intervals
from nonsmooth.paths.absorption.survival import over_blocks
from nonsmooth.paths.cost import require_memory
from nonsmooth.paths.kernels.panel import DELTA, STATE, new_panel
from nonsmooth.paths.moments import mean_bias, moments, step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES

_NOWHERE = Intervals(DELTA, np.empty(0), np.empty(0), 0.0)


def moments_under_envelope(
    scene: Scene, times: ArrayLike, sampling: Sampling, envelope: str
) -> dict[str, np.ndarray]:
    """Mean and variance of D = int_0^t g, their standard errors, and the biases of the step.

    Parameters
    ----------
    scene : Scene
    times : array_like, shape (t,)
        Increasing, positive.
    sampling : Sampling
        Its scheme must share the noise of two steps.
    envelope : str
        See `envelope.scales`.

    Returns
    -------
    dict
        Arrays over time: `mean` and `variance`, and for each of them `_error`, `_bias` and
        `_bias_error`, as from `paths.simulate`.

    Raises
    ------
    SceneError
        If a path diverges, or the envelope is negative.
    """

    def sums(panels, _survival, count):
        half, whole = (panel.data[DELTA, :count].astype(float) for panel in panels)
        one, nothing = np.ones(count), np.zeros(count)
        plain = np.array([one, whole, whole**2, nothing, nothing])
        change = np.array([one, whole - half, whole**2 - half**2, half])
        return np.concatenate([np.ravel(part @ part.T) for part in (plain, change)])

    total = functools.reduce(np.add, _blocks(scene, times, sampling, envelope, sums))
    plain, change = total[:, :25].reshape(-1, 5, 5), total[:, 25:].reshape(-1, 4, 4)
    found, order = moments(plain), registry.scheme(scene, sampling.scheme).weak_order(scene)
    for name, bias in (("mean", mean_bias), ("variance", step_bias)):
        found[f"{name}_bias"], found[f"{name}_bias_error"] = bias(change, order)
    return found


def paths_under_envelope(
    scene: Scene, times: ArrayLike, sampling: Sampling, envelope: str
) -> np.ndarray:
    """Simulate paths as `ensembles.paths_at` does, under an envelope.

    Parameters
    ----------
    scene, times, sampling, envelope
        As for `moments_under_envelope`.

    Returns
    -------
    numpy.ndarray, shape (t + 1, k + 1, paths)
    """
    rows = [row for row, s in zip(STATE, STATE_VARIABLES, strict=True) if s.name in scene.state]
    rows.append(DELTA)
    require_memory(2 * len(rows) * (np.size(times) + 1) * sampling.paths)
    start = new_panel(scene, sampling.seed, 0, sampling.precision).data[rows, :1]

    def state(panels, _survival, count):
        return panels[1].data[rows, :count]

    later = np.concatenate(list(_blocks(scene, times, sampling, envelope, state)), axis=2)
    return np.concatenate([np.broadcast_to(start, (1, *later.shape[1:])), later])


def _blocks(scene, times, sampling, envelope, reduce):
    half = replace(sampling, step=sampling.step / 2)
    return over_blocks(scene, _NOWHERE, times, half, envelope, reduce)
