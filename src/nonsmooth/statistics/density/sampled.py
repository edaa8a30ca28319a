"""Invariant densities as histograms of simulated paths, for every scene and n = inf.

Averages over cells need no density: there is none where walls or friction hold a share of the mass.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.stats import t as student

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.grids import potential_wells
from nonsmooth.paths.ensembles import occupation
from nonsmooth.paths.kernels.random_numbers import BLOCK, labelled
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning
from nonsmooth.statistics.density.found import Density, Found, keys, relative_error
from nonsmooth.statistics.sampled_gamma2 import first_times, short_step


def are_cells(points: Mapping[str, np.ndarray]) -> bool:
    """Whether there are cells around points: at least two of them, which increase."""
    return all(len(z) > 1 and bool(np.all(np.diff(z) > 0)) for z in points.values())


def sampled_densities(
    scene: Scene,
    tol: float | None,
    points: Mapping[str, np.ndarray],
    seed: int | tuple = 0,
    threads: int | None = None,
) -> Found:
    """Average densities over the cells around points.

    The first attempt tells how long the second must be. The first fifth of each path is left out,
    five relaxation times of the slowest drift at least, and blocks of paths start in all wells of
    the potentials.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Relative to the largest value of each density; 5e-2 unless given.
    points : dict
        Of all variables; `are_cells`.
    seed : int or tuple
    threads : int, optional

    Returns
    -------
    dict
        Names of variables -> `Density`. The error is the bias of the step, a third of what four
        times the step changes, as for a scheme of order 1 or more; and what chance exceeds in some
        cell with a probability of 1e-3. This is known from the spread of the blocks, which are
        independent, in the cell itself and in all cells. What the second half of the time changes
        beyond chance is added.

    Raises
    ------
    SceneError
        If the points do not increase.
    ToleranceError
        If `tol` is not met; the last densities are its `result`. Without one if paths take too many
        steps to forget their start.
    """
    if not are_cells(points):
        raise SceneError(
            "densities by Monte Carlo are averages over cells; give at least two increasing points "
            "of each variable"
        )
    chosen = tuning.SAMPLED_DENSITY
    aim = chosen.tolerance if tol is None else tol
    if aim < chosen.least_tolerance:
        raise ToleranceError(
            f"Monte Carlo cannot reach tol = {tol:g} for densities; use tol >= "
            f"{chosen.least_tolerance:g}"
        )
    step = min(short_step(scene), chosen.stable * registry.longest_step(scene) / chosen.coarser)
    time = chosen.relaxed * first_times(scene)[0] / chosen.dropped
    if time > chosen.hopeless * step:
        raise ToleranceError(
            f"densities by Monte Carlo need a time of {time:.2g}, until paths have forgotten their "
            f"start, in steps of {step:.1g}: too many; choose parameters of more similar sizes"
        )
    longest = max(min(chosen.longest_time, chosen.most_steps * step), time)
    found: Found = {}
    for attempt in range(chosen.attempts):
        sampling = Sampling(step, chosen.blocks * BLOCK, labelled(seed, attempt), threads=threads)
        try:
            found, bias = _histograms(scene, time, points, sampling)
        except ToleranceError:
            if not found:
                raise
            break
        error = max(relative_error(density) for density in found.values())
        if error <= aim:
            return found
        if bias > aim / 2:
            step /= 2
        elif time >= longest:
            break
        time = min(time * max((chosen.spare * error / aim) ** 2, 1.0), longest)
    worst = max(found, key=lambda key: relative_error(found[key]))
    raise ToleranceError(
        f"the invariant density of {', '.join(worst)}, with averages up to "
        f"{np.max(found[worst].value):.3g}, has a relative error of "
        f"{relative_error(found[worst]):.1e} by Monte Carlo, above {aim:g}; loosen tol or choose "
        "fewer points",
        found,
    )


def _histograms(scene, time, points, sampling):
    """Estimate all densities up to a time; return them and the largest bias beyond chance."""
    chosen = tuning.SAMPLED_DENSITY
    edges = {name: _edges(z) for name, z in points.items()}
    coarser = replace(sampling.labelled("bias"), step=chosen.coarser * sampling.step)
    # whole steps of either length, so that one is `coarser` times the other
    spacing = coarser.step * max(round(chosen.spacing / coarser.step), 1)
    dropped = math.ceil(chosen.dropped * time / spacing)
    # an even number, so that both halves of the time have as many
    count = max(2 * math.floor((time / spacing - dropped) / 2), 2)
    times = spacing * (dropped + np.arange(1, count + 1))
    observed = BLOCK * len(times)  # in each block
    fine, coarse = (_shares(scene, times, edges, own) for own in (sampling, coarser))
    found, bias = {}, 0.0
    for key in keys(scene):
        size = math.prod(np.ix_(*(np.diff(edges[name]) for name in key)))
        share, chance = _pooled(fine[key].sum(axis=1), observed)
        other, of_other = _pooled(coarse[key].sum(axis=1), observed)
        change = np.abs(share - other) / (chosen.coarser - 1)
        error = np.max((change + chance + _drift(fine[key], observed)) / size)
        found[key] = Density(share / size, float(error), True)
        beyond = change - np.hypot(chance, of_other) / (chosen.coarser - 1)
        largest = max(float(np.max(share / size)), np.finfo(float).tiny)
        bias = max(bias, float(np.max(beyond / size)) / largest)
    return found, bias


def _drift(halves, observed):
    """Return what the second half of the time changes, if it is more than chance."""
    (first, of_first), (second, of_second) = (
        _pooled(2 * halves[:, half], observed / 2) for half in (0, 1)
    )
    change = np.abs(second - first)
    return change if np.any(change > np.hypot(of_first, of_second)) else 0.0


def _edges(points):
    """Return the middles between points, and as much beyond the first and the last."""
    middle = (points[1:] + points[:-1]) / 2
    return np.concatenate([[2 * points[0] - middle[0]], middle, [2 * points[-1] - middle[-1]]])


def _shares(scene, times, edges, sampling):
    """Return the share of its time that each block spends in each cell, by halves of the time."""
    counts = list(occupation(_starts(scene), times, sampling, edges, keys(scene)))
    shares = {
        key: np.array([block[key] for block in counts]) / (BLOCK * len(times))
        for key in keys(scene)
    }
    if scene.is_odd() and all(map(_is_symmetric, edges.values())):
        for key, share in shares.items():  # the law is that of the mirrored state
            shares[key] = (share + np.flip(share, axis=range(2, share.ndim))) / 2
    return shares


def _starts(scene):
    """Return the scene with a start in each well, or its own where the wells are not known."""
    try:
        return [scene.with_start(start) for start in potential_wells.starts(scene)]
    except SceneError:
        return [scene]


def _is_symmetric(edges):
    rounding = tuning.SAMPLED_DENSITY.symmetric * np.min(np.diff(edges))
    return bool(np.max(np.abs(edges + edges[::-1])) <= rounding)


def _pooled(shares, observed):
    """Return mean and error of the shares of cells, from those of independent blocks.

    The spread of counts is that of so many times fewer observations in all cells. In a cell that
    was never visited there is less than what would have been seen but for the false alarm.
    """
    chosen, blocks = tuning.SAMPLED_DENSITY, len(shares)
    mean, variance = shares.mean(axis=0), shares.var(axis=0, ddof=1)
    binomial = mean * (1 - mean)
    fewer = np.sum(variance) / max(np.sum(binomial), np.finfo(float).tiny)
    reach = student.isf(chosen.false_alarm / 2 / mean.size, blocks - 1)
    seen = reach * np.sqrt(np.maximum(variance, fewer * binomial) / blocks)
    unseen = math.log(mean.size / chosen.false_alarm) * max(fewer, 1 / observed) / blocks
    return mean, np.where(mean > 0, seen, unseen)
