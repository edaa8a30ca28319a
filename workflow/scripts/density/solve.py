"""Invariant densities of velocity and displacement of one scene, solved and as histograms."""

import numpy as np

from nonsmooth.paths.ensembles import paths_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import x
from nonsmooth.statistics.invariant_density import bin_averages
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

TITLES = {"y": "velocity", "x": "displacement"}


def densities(scene, tolerances, bins, reach, step, time, paths, seed, threads):
    """Average the density over the bins of a histogram, and fill the histogram.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    sampling = Sampling(step, paths, (seed, "density"), threads=threads)
    state = paths_at(scene, [time], sampling)[-1]
    samples = {name: z for name, z in zip(scene.state, state, strict=False) if name in TITLES}
    edges = {name: _edges(scene, name, z, bins, reach) for name, z in samples.items()}
    solved = bin_averages(scene, edges, tolerances[scene.dimension - 1])
    coords, variables = {}, {}
    for name, z in samples.items():
        ends, title = edges[name], TITLES[name]
        share, width = np.histogram(z, ends)[0] / paths, np.diff(ends)
        value, error = solved[name]
        coords[name] = (name, (ends[1:] + ends[:-1]) / 2, f"{title}, middle of a bin")
        variables |= {
            f"density_{name}": (name, value, f"invariant density of the {title}"),
            f"density_{name}_error": (name, error, "error, by two resolutions"),
            f"histogram_{name}": (name, share / width, f"histogram of the {title}"),
            f"histogram_{name}_error": (
                name,
                np.sqrt(share * (1 - share) / paths) / width,
                "standard error",
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
