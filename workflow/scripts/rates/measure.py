"""Distances of penalized scenes to their non-smooth limits, and the exponents of n."""

import numpy as np

from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.rates import (
    gamma2_difference,
    largest_distances,
    slope,
    variance_difference,
)
from reproduction.time_scales import contact_time

KINDS = {
    "pathwise": "mean of the largest distance up to T, on the same Brownian path",
    "weak": "difference of Var D(T)/T, or of gamma^2 where that is in closed form",
}


def measure(scenes, horizon, resolution, longest, paths, weak, level, seed, threads):
    """Measure every scene with a step and with twice the step.

    The ensembles of different n are independent, so that the points of a fit are.

    Parameters
    ----------
    scenes : dict
        Name -> scene, the variable compared, the list of n.
    horizon : float
        T of the paths.
    resolution, longest : float
        The step in units of the penalty's time scale, and the longest step.
    paths : int
    weak : dict
        Horizon, step and paths of the variances.
    level : float
        Probability with which an exponent misses its published error by chance.
    seed, threads : int

    Returns
    -------
    xarray.Dataset
        Over (scene, point).
    """
    found = {kind: [] for kind in KINDS}
    for name, entry in scenes.items():
        n = np.array(entry["n"], dtype=float)
        chain = [Scene(**entry["scene"], n=k) for k in n]

        def distances(factor, chain=chain, entry=entry, name=name):
            steps = [factor * min(longest, resolution * contact_time(one)) for one in chain]
            samplings = [
                Sampling(step, paths, (seed, "rates", name, one.n), threads=threads)
                for one, step in zip(chain, steps, strict=True)
            ]
            return _distances(chain, entry["variable"], horizon, samplings)

        def differences(factor, chain=chain, name=name):
            step, own = factor * weak["step"], (seed, "weak rates", name)
            samplings = [
                Sampling(step, weak["paths"], (*own, one.n), threads=threads) for one in chain
            ]
            return _differences(chain, weak["horizon"], samplings)

        found["pathwise"].append(_fitted(n, distances, level))
        found["weak"].append(_fitted(n, differences, level))
    over = ("scene", "point")
    variables = {"n": (over, [entry["n"] for entry in scenes.values()], "penalization")}
    for kind, text in KINDS.items():
        value, error, coarse, fit = map(np.array, zip(*found[kind], strict=True))
        variables |= {
            kind: (over, value, text),
            f"{kind}_error": (over, error, "its standard error, or error bound"),
            f"{kind}_coarse": (over, coarse, "the same with twice the step"),
            f"{kind}_exponent": ("scene", fit[:, 0], f"exponent of n, {kind}"),
            f"{kind}_exponent_error": (
                "scene",
                fit[:, 1],
                f"half a {1 - level:.0%} interval, and what twice the step changes",
            ),
        }
    return artifact.dataset(
        "Distances to the non-smooth limit",
        f"{paths} paths up to {horizon:g}; {weak['paths']} paths up to {weak['horizon']:g}",
        {"scene": ("scene", list(scenes), "name of the scene")},
        variables,
    )


def _distances(chain, variable, horizon, samplings):
    """Mean largest distance to the limit and its standard error, for each scene."""
    samples = [
        largest_distances(one, variable, horizon, sampling)
        for one, sampling in zip(chain, samplings, strict=True)
    ]
    return np.array([[s.mean(), s.std(ddof=1) / np.sqrt(len(s))] for s in samples]).T


def _differences(chain, horizon, samplings):
    """Difference of the variance to that of the limit and its error, for each scene."""
    if chain[0].is_line:
        return np.array([gamma2_difference(one) for one in chain]).T
    pairs = zip(chain, samplings, strict=True)
    return np.array([variance_difference(one, horizon, sampling) for one, sampling in pairs]).T


def _fitted(n, run, level):
    """Values, errors, values with twice the step, and the exponent of n with its error."""
    (value, error), (coarse, coarse_error) = run(1.0), run(2.0)
    exponent, half_width = slope(n, value, error, level)
    other, _ = slope(n, coarse, coarse_error, level)
    return value, error, coarse, [exponent, half_width + abs(other - exponent)]


if __name__ == "__main__":
    produce(measure, snakemake, threads=snakemake.threads)
