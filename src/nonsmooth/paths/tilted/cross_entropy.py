"""A guide that is fitted to the paths that have reached the level.

The best law of the noise is that of the paths that reach the level. Among the laws that a guide can
make, the one with the least relative entropy to it (the cross-entropy method; for diffusions W.
Zhang et al., SIAM J. Sci. Comput. 36, 2014) minimises

    E[ L 1 (int theta^2 / 2 dt - int theta dW) ],

1 standing for the level having been reached, L for the likelihood ratio. As theta is linear in the
coefficients, this is a linear system.
"""

from dataclasses import dataclass, replace

import numpy as np

from nonsmooth.paths import tuning
from nonsmooth.paths.kernels.panel import BASE, DELTA, new_panel
from nonsmooth.paths.parallel import parallel
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tilted.loop import (
    REACHED,
    TOTAL_LOG_WEIGHT,
    compile_march_tilted,
    march_tilted,
)
from nonsmooth.paths.tilted.tilt import Aim, Guide
from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class _Record:
    """What the fit knows of one block.

    Attributes
    ----------
    state : numpy.ndarray, shape (records, d, paths)
    delta, noise : numpy.ndarray, shape (records, paths)
        int g before a step, and the increment of the Brownian motion in it.
    on_way : numpy.ndarray of bool, shape (records, paths)
        Whether no level had been reached.
    weight : numpy.ndarray, shape (paths,)
        The likelihood ratio; 0 unless the level was reached first.
    """

    state: np.ndarray
    delta: np.ndarray
    noise: np.ndarray
    on_way: np.ndarray
    weight: np.ndarray


def refitted(
    scene: Scene, guide: Guide, prior: Guide, aim: Aim, sampling: Sampling
) -> tuple[Guide, float]:
    """Fit a guide to paths that another guide has led to a level.

    Parameters
    ----------
    scene : Scene
    guide : Guide
        By which the paths are led.
    prior : Guide
        To which the fit keeps where the paths tell little.
    aim : Aim
    sampling : Sampling

    Returns
    -------
    guide : Guide
        That of the arguments if no path has reached the level.
    effective : float
        Effective number of the paths that have, (sum L)^2 / sum L^2.
    """
    steps = int(np.ceil(aim.time / sampling.step - 1e-9))
    h = aim.time / steps
    stride = -(-steps // tuning.CROSS_ENTROPY.records)
    s = registry.coefficients(scene, sampling.scheme, h, sampling.precision)
    tilt = guide.towards(aim, sampling.precision)
    compile_march_tilted(s, new_panel(scene, sampling.seed, 0, sampling.precision), tilt)

    def run(job):
        block, lanes = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        return _recorded(s, panel, tilt, lanes, steps, stride, aim.levels, guide.basis.rows)

    kept = list(parallel(run, sampling, steps))
    weights = np.concatenate([record.weight for record in kept])
    if not weights.sum() > 0:
        return guide, 0.0
    effective = weights.sum() ** 2 / np.sum(weights**2)
    unit = effective / weights.sum()
    times = h * stride * np.arange(len(kept[0].delta))
    return _fit(scene, guide, prior, aim, kept, times, h, unit, effective), effective


def _recorded(s, panel, tilt, lanes, steps, stride, levels, rows):
    """Lead the paths of a block to the end; look at every so many steps."""
    uncounted = np.zeros(0)
    kept = []
    for k in range(0, steps, stride):
        state = panel.data[list(rows), :lanes].copy()
        delta = panel.data[BASE, :lanes] + panel.data[DELTA, :lanes]
        on_way = panel.data[REACHED, :lanes] == 0
        now = k * float(s.step)
        march_tilted(s, panel, tilt, lanes, 1, now, levels, 0, uncounted)
        kept.append((state, delta, panel.data[0, :lanes].copy(), on_way))
        rest = min(stride, steps - k) - 1
        if rest:
            march_tilted(s, panel, tilt, lanes, rest, now + s.step, levels, 0, uncounted)
    there = panel.data[REACHED, :lanes] == tilt.side
    weight = np.where(there, np.exp(panel.total[TOTAL_LOG_WEIGHT, :lanes]), 0.0)
    return _Record(*map(np.array, zip(*kept, strict=True)), weight)


def _fit(scene, guide, prior, aim, kept, times, h, unit, effective):
    """Solve the linear system for the coefficients of P_1, P_2, P_3."""
    chosen, basis = tuning.CROSS_ENTROPY, prior.basis
    sets = _terms(scene, basis)
    size = sum(map(len, sets))
    gram, everywhere, right = np.zeros((size, size)), np.zeros((size, size)), np.zeros(size)
    arrived = []
    paths = sum(len(record.weight) for record in kept)
    for record in kept:
        weight = unit * record.weight
        for k, now in enumerate(times):
            on_way = record.on_way[k]
            values = basis.values(record.state[k].astype(float))
            u = prior.coefficients[0] @ values
            q = guide.rate(aim, aim.time - now, record.delta[k] + u)
            features = np.concatenate(
                [q ** (power + 1) * values[terms] for power, terms in enumerate(sets)]
            )[:, on_way]
            own = weight[on_way]
            gram += h * (features * own) @ features.T
            everywhere += h * features @ features.T
            right += features @ (own * np.sqrt(h) * record.noise[k][on_way])
            if k > 0:
                now_there = record.on_way[k - 1] & ~on_way & (weight > 0)
                arrived.append([weight[now_there].sum(), weight[now_there] @ u[now_there]])
    before = np.concatenate([prior.coefficients[1][sets[0]], np.zeros(size - len(sets[0]))])
    scale = np.maximum(np.sqrt(np.diag(gram)), np.finfo(float).tiny)
    defended = gram + chosen.defence * effective / paths * everywhere
    matrix = defended / np.outer(scale, scale) + chosen.ridge / effective * np.eye(size)
    change = np.linalg.lstsq(matrix, (right - gram @ before) / scale, rcond=None)[0] / scale
    coefficients = np.zeros_like(prior.coefficients)
    coefficients[0] = prior.coefficients[0]
    parts = np.split(before + change, np.cumsum([len(terms) for terms in sets])[:-1])
    for power, (terms, part) in enumerate(zip(sets, parts, strict=True)):
        coefficients[1 + power, terms] = part
    total, at_level = np.sum(arrived, axis=0) if arrived else (0.0, 0.0)
    kappa = aim.side * at_level / total if total > 0 else guide.kappa
    return replace(guide, coefficients=coefficients, kappa=float(kappa))


def _terms(scene, basis):
    """Return the monomials of P_1, P_2 and P_3; for odd scenes even, odd and even ones."""
    degrees, highest = basis.degrees, basis.degrees.max() - 1
    result = []
    for power in range(3):
        kept = degrees <= (highest if power == 0 else min(highest, tuning.TILT.higher_degree))
        result.append(np.flatnonzero(kept & (degrees % 2 == power % 2) if scene.is_odd() else kept))
    return result
