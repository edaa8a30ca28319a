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
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics import tuning
from nonsmooth.statistics.density.found import Density, Found, keys, relative_error
from nonsmooth.statistics.sampled_gamma2 import short_step


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
    and blocks of paths start in all wells of the potentials.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Relative to the largest value of each density; 2e-2 unless given.
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
        independent, in the cell itself and in all cells.

    Raises
    ------
    SceneError
        If the points do not increase.
    ToleranceError
        If `tol` is not met; the last densities are its `result`.
    """
    if not are_cells(points):
        raise SceneError(
            "densities by Monte Carlo are averages over cells; give at least two increasing points "
            "of each variable"
        )
    chosen = tuning.SAMPLED_DENSITY
    aim = chosen.tolerance if tol is None else tol
    step, time = short_step(scene), chosen.first_time
    for attempt in range(chosen.attempts):
        sampling = Sampling(step, chosen.blocks * BLOCK, labelled(seed, attempt), threads=threads)
        found, bias = _histograms(scene, time, points, sampling)
        error = max(relative_error(density) for density in found.values())
        if error <= aim:
            return found
        if bias > aim / 2:
            step /= 2
        elif time >= chosen.longest_time:
            break
        time = min(time * max((chosen.spare * error / aim) ** 2, 1.0), chosen.longest_time)
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
    fine, coarse = (_shares(scene, time, edges, own) for own in (sampling, coarser))
    found, bias = {}, 0.0
    for key in keys(scene):
        size = math.prod(np.ix_(*(np.diff(edges[name]) for name in key)))
        (share, chance), (other, of_other) = _pooled(fine[key]), _pooled(coarse[key])
        change = np.abs(share - other) / (chosen.coarser - 1)
        found[key] = Density(share / size, float(np.max((change + chance) / size)), True)
        beyond = change - np.hypot(chance, of_other) / (chosen.coarser - 1)
        bias = max(bias, float(np.max(beyond / size) / np.max(share / size)))
    return found, bias


def _edges(points):
    """Return the middles between points, and as much beyond the first and the last."""
    middle = (points[1:] + points[:-1]) / 2
    return np.concatenate([[2 * points[0] - middle[0]], middle, [2 * points[-1] - middle[-1]]])


def _shares(scene, time, edges, sampling):
    """Return the share of its time that each block spends in each cell."""
    chosen = tuning.SAMPLED_DENSITY
    times = np.arange(chosen.dropped * time, time, chosen.spacing)[1:]
    starts = [scene.with_start(start) for start in potential_wells.starts(scene)]
    counts = list(occupation(starts, times, sampling, edges, keys(scene)))
    shares = {
        key: np.array([block[key] for block in counts]) / (BLOCK * len(times))
        for key in keys(scene)
    }
    if scene.is_odd() and all(np.allclose(z, -z[::-1]) for z in edges.values()):
        for key, share in shares.items():  # the law is that of the mirrored state
            shares[key] = (share + np.flip(share, axis=range(1, share.ndim))) / 2
    return shares


def _pooled(shares):
    """Return mean and error of the shares of cells, from those of independent blocks."""
    chosen, blocks = tuning.SAMPLED_DENSITY, len(shares)
    mean, variance = shares.mean(axis=0), shares.var(axis=0, ddof=1)
    binomial = mean * (1 - mean)
    least = np.sum(variance) / max(np.sum(binomial), np.finfo(float).tiny) * binomial
    reach = student.isf(chosen.false_alarm / 2 / mean.size, blocks - 1)
    return mean, reach * np.sqrt(np.maximum(variance, least) / blocks)
