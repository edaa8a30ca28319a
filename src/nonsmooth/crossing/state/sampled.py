"""Crossings of the state by Monte Carlo; a tolerance decides on paths and time step."""

import math
from collections.abc import Sequence

import numpy as np

from nonsmooth.crossing import tuning as crossing_tuning
from nonsmooth.crossing.monte_carlo import distance, outcome, paths_wanted
from nonsmooth.crossing.state import tuning
from nonsmooth.crossing.state.problem import StateCrossing
from nonsmooth.errors import ToleranceError
from nonsmooth.paths.absorption.survival import crossed
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.paths.moments import fine_bias_over_change
from nonsmooth.paths.resolution import first_step, refined_step, require_possible
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.tuning import MONTE_CARLO


def sampled_state_crossing(
    asked: Sequence[StateCrossing],
    times: np.ndarray,
    seed: int | tuple,
    threads: int | None,
    tol: float = MONTE_CARLO.tolerance,
    step: float | None = None,
    paths: int | None = None,
    precision: str = "float32",
    envelope: str | None = None,
) -> tuple[dict, dict]:
    """Average the probabilities of paths to have left intervals.

    One set of paths serves all intervals; the one that needs most paths and the shortest step
    decides. All paths are also run with twice the step on the same noise, from which follows the
    bias. A pilot with a coarse step tells how many paths and which step the tolerance takes, unless
    they are given.

    Parameters
    ----------
    asked : sequence of StateCrossing
        Of one variable of one scene.
    times : numpy.ndarray, shape (t,)
        Increasing, positive.
    seed, threads, tol, step, paths, precision, envelope
        As for `state_crossing_probability`.

    Returns
    -------
    values : dict
        As from `crossing.monte_carlo.sampled_crossing`.
    attributes : dict
        `step`, `paths`.

    Raises
    ------
    SceneError
        If a path diverges.
    ToleranceError
        If `tol` takes too many steps.
    """
    own_step = _coarsest(asked, times) if step is None else step
    own_paths = paths or min(
        MONTE_CARLO.pilot_paths, math.ceil(crossing_tuning.COUNTING.pilot / tol)
    )
    label = seed if step and paths else labelled(seed, "pilot")
    for _ in range(tuning.SAMPLED.attempts):
        sampling = Sampling(own_step, own_paths, label, threads=threads, precision=precision)
        counts, found = _sample(asked, times, sampling, envelope)
        off = distance(counts, own_paths)
        bias, error = found[0]["step_bias"], found[0]["step_bias_error"]
        share = MONTE_CARLO.spread_share * tol
        enough = paths is not None or off <= share
        known = np.max(np.abs(bias) - MONTE_CARLO.sigmas * error)
        if enough and (step is not None or known <= tol - share):
            return found
        if step is None:
            worst = np.max(np.abs(bias) + error)
            refined = refined_step(own_step, worst, tol - share, tuning.SAMPLED.order)
            own_step = max(refined, own_step / tuning.SAMPLED.finer)
        if not enough:
            own_paths = max(own_paths, paths_wanted(counts, own_paths, tol))
        label = seed
        value = found[0]["probability"].flat[-1]
        told = f"W = {value:.3g} has an error of {off:.1g}"
        steps = 3 / 2 * times[-1] / own_step
        require_possible(own_paths, steps, told, tol, result=found)
    raise ToleranceError(
        f"W = {value:.3g} has an error of {off:.1g} and a bias of {np.max(np.abs(bias)):.1e} by "
        "the step; loosen tol or choose step and paths",
        found,
    )


def _coarsest(asked, times):
    """Longest step of the pilot: rough paths must not pass the interval in one."""
    step = first_step(asked[0].scene, times)
    if asked[0].driven:
        way = min(min(one.upper - one.start, one.start - one.lower) for one in asked)
        step = min(step, (tuning.SAMPLED.part_of_way * way / asked[0].scene.noise.sigma) ** 2)
    return step


def _sample(asked, times, sampling, envelope):
    """Return the sums of the probabilities to have left, and values and attributes."""
    levels = [(one.lower, one.upper) for one in asked]
    sums = crossed(asked[0].scene, asked[0].followed, levels, times, sampling, envelope)
    counts, change, square = sums.transpose(1, 2, 0)
    paths = sampling.paths
    counts, change, square = np.clip(counts, 0.0, paths), change / paths, square / paths
    # if no path shows a change, the error is that of a single path with different outcomes
    factor = fine_bias_over_change(tuning.SAMPLED.order)
    error = factor * np.sqrt(np.maximum(square - change**2, 1 / paths) / paths)
    return counts, outcome(counts, paths, sampling.step, factor * change, error)
