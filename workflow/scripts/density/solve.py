"""Invariant densities of velocity and displacement of one scene, solved and as histograms."""

import numpy as np

from nonsmooth.paths.ensembles import paths_at
from nonsmooth.paths.moments import bias_over_change
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import x
from nonsmooth.statistics.density.bins import bin_averages
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

TITLES = {"y": "velocity", "x": "displacement"}


def densities(scene, tolerances, bins, reach, step, time, paths, seed, threads):
    """Average the density over the bins of a histogram, and fill the histogram.

    The bias of the time step follows from an independent histogram with half the step.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)

    def sampled(step, label):
        sampling = Sampling(step, paths, (seed, label), threads=threads)
        state = paths_at(scene, [time], sampling)[-1]
        return {name: z for name, z in zip(scene.state, state, strict=False) if name in TITLES}

    samples, halved = sampled(step, "density"), sampled(step / 2, "density, halving")
    factor = bias_over_change(registry.scheme(scene).weak_order(scene))
    edges = {name: _edges(scene, name, z, bins, reach) for name, z in samples.items()}
    solved = bin_averages(scene, edges, tolerances[scene.dimension - 1])
    coords = {}
    variables = {"factor": ((), factor, "bias of a step over what halving it changes")}
    for name, z in samples.items():
        ends, title = edges[name], TITLES[name]
        width = np.diff(ends)
        share, fine = (np.histogram(sample, ends)[0] / paths for sample in (z, halved[name]))
        spread, own = (np.sqrt(part * (1 - part) / paths) / width for part in (fine, share))
        value, error = solved[name]
        coords[name] = (name, (ends[1:] + ends[:-1]) / 2, f"{title}, middle of a bin")
        variables |= {
            f"density_{name}": (name, value, f"invariant density of the {title}"),
            f"density_{name}_error": (name, error, "error, by two resolutions"),
            f"histogram_{name}": (name, share / width, f"histogram of the {title}"),
            f"histogram_{name}_error": (name, own, "standard error"),
            f"histogram_{name}_bias": (name, factor * (share - fine) / width, "bias of the step"),
            f"histogram_{name}_bias_error": (
                name,
                factor * np.hypot(own, spread),
                "standard error of the bias",
            ),
        }
    summary = f"averages over bins; {paths} paths at t = {time:g} of {scene}"
    return artifact.dataset("Invariant marginal densities", summary, coords, variables)


def _edges(scene, name, sample, bins, reach):
    """Edges symmetric about 0; those of a displacement between walls lie on the walls."""
    if name == "x" and scene.mechanics.argument == x:
        beyond = max(1, np.ceil((np.max(np.abs(sample)) - 1) * bins / 2))
        return np.arange(-bins / 2 - beyond, bins / 2 + beyond + 0.5) * 2 / bins
    end = reach * np.std(sample)
    return np.linspace(-end, end, bins + 1)


if __name__ == "__main__":
    produce(densities, snakemake, threads=snakemake.threads)
