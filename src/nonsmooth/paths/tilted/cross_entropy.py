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
        int g before a few steps, and the sum of the normal numbers of these.
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
    few = min(stride, max(1, round(tuning.CROSS_ENTROPY.look / h)))
    compile_march_tilted(s, new_panel(scene, sampling.seed, 0, sampling.precision), tilt)

    def run(job):
        block, lanes = job
        panel = new_panel(scene, sampling.seed, block, sampling.precision)
        return _recorded(s, panel, tilt, lanes, steps, stride, few, aim.levels, guide.basis.rows)

    kept = list(parallel(run, sampling, steps))
    weights = np.concatenate([record.weight for record in kept])
    if not weights.sum() > 0:
        return guide, 0.0
    even = weights / weights.max()  # squares of tiny weights are 0
    effective = even.sum() ** 2 / np.sum(even**2)
    unit = effective / weights.sum()
    times = h * stride * np.arange(len(kept[0].delta))
    return _fit(scene, guide, prior, aim, kept, times, h, few, unit, effective), effective


def _recorded(s, panel, tilt, lanes, steps, stride, few, levels, rows):
    """Lead the paths of a block to the end; look at a few steps of every so many."""
    uncounted = np.zeros(0)
    kept = []
    for k in range(0, steps, stride):
        state = panel.data[list(rows), :lanes].copy()
        delta = panel.data[BASE, :lanes] + panel.data[DELTA, :lanes]
        on_way = panel.data[REACHED, :lanes] == 0
        noise, last = np.zeros(lanes, panel.data.dtype), min(k + stride, steps)
        seen = min(k + few, last)
        for j in range(k, seen):
            march_tilted(s, panel, tilt, lanes, 1, j * float(s.step), levels, 0, uncounted)
            noise += panel.data[0, :lanes]
        kept.append((state, delta, noise, on_way))
        if last > seen:
            now = seen * float(s.step)
            march_tilted(s, panel, tilt, lanes, last - seen, now, levels, 0, uncounted)
    there = panel.data[REACHED, :lanes] == tilt.side
    weight = np.where(there, np.exp(panel.total[TOTAL_LOG_WEIGHT, :lanes]), 0.0)
    return _Record(*map(np.array, zip(*kept, strict=True)), weight)


def _fit(scene, guide, prior, aim, kept, times, h, few, unit, effective):
    """Fit the coefficients of P_1 to P_4."""
    chosen, basis = tuning.CROSS_ENTROPY, prior.basis
    sets = _terms(scene, basis)
    cuts = np.cumsum([len(terms) for terms in sets])
    before = np.concatenate([prior.coefficients[1][sets[0]], np.zeros(cuts[-1] - cuts[0])])
    information, score = np.zeros((cuts[-1], cuts[-1])), np.zeros(cuts[-1])
    arrived = []
    paths = sum(len(record.weight) for record in kept)
    defence = np.float32(chosen.defence * effective / paths)
    for record in kept:
        weight = unit * record.weight
        for k, now in enumerate(times):
            on_way = record.on_way[k]
            values = basis.values(record.state[k])
            u = prior.coefficients[0] @ values
            q = guide.rate(aim, aim.time - now, record.delta[k] + u)
            late = np.exp(tuning.TILT.haste * (now - aim.time))
            factors = q, q**2, q**3, late * q
            features = np.concatenate(
                [factor * values[terms] for factor, terms in zip(factors, sets, strict=True)],
                dtype=np.float32,
            )[:, on_way]
            own = weight[on_way].astype(np.float32)
            information += few * h * ((features * (own + defence)) @ features.T)
            unexplained = np.sqrt(h) * record.noise[k][on_way] - few * h * (before @ features)
            score += features @ (own * unexplained)
            if k > 0:
                now_there = record.on_way[k - 1] & ~on_way & (weight > 0)
                arrived.append([weight[now_there].sum(), weight[now_there] @ u[now_there]])
    if not np.all(np.isfinite(information)):  # squares of squares overflow
        return guide
    parts = np.split(before + _likeliest(information, score), cuts[:-1])
    coefficients = np.zeros_like(prior.coefficients)
    coefficients[0] = prior.coefficients[0]
    for power, (terms, part) in enumerate(zip(sets, parts, strict=True)):
        coefficients[1 + power, terms] = part
    total, at_level = np.sum(arrived, axis=0) if arrived else (0.0, 0.0)
    kappa = aim.side * at_level / total if total > 0 else guide.kappa
    return replace(guide, coefficients=coefficients, kappa=float(kappa))


def _likeliest(information, score):
    """Return the likeliest coefficients, normal a priori with the variance of greatest evidence.

    The log likelihood of c is score c - c information c / 2. All coefficients are a priori alike in
    the units in which the information has the diagonal 1.
    """
    # a coefficient of which nothing is known stays as it was
    least = np.finfo(np.float32).tiny
    scale = np.sqrt(np.maximum(np.diag(information), least * np.trace(information)))
    known, directions = np.linalg.eigh(information / np.outer(scale, scale))
    known, found = np.maximum(known, 0.0), directions.T @ (score / scale)
    ridges = np.geomspace(*tuning.CROSS_ENTROPY.ridges)[:, None]
    evidence = np.sum(found**2 / (known + ridges) - np.log1p(known / ridges), axis=1)
    ridge = ridges[np.argmax(evidence)]
    return directions @ (found / (known + ridge)) / scale


def _terms(scene, basis):
    """Return the monomials of P_1 to P_4; for odd scenes even, odd, even and even ones."""
    degrees, highest = basis.degrees, basis.degrees.max() - 1
    lower = min(highest, tuning.TILT.higher_degree)
    result = []
    for odd, degree in ((0, highest), (1, lower), (0, lower), (0, lower)):
        kept = degrees <= degree
        result.append(np.flatnonzero(kept & (degrees % 2 == odd) if scene.is_odd() else kept))
    return result
