"""Samples of Xi_p(1) and of the running maximum of |Xi_p| of one scene, for every p."""

import numpy as np

from nonsmooth.paths.sampling import Sampling
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.limit_theorem import scaled_integrals


def simulate(scene, p, steps, paths, seed, threads):
    """Simulate every p in one job, because to start a job takes longer than to simulate a small p.

    Returns
    -------
    xarray.Dataset
    """
    scene = Scene(**scene)
    sampling = Sampling(max(steps), paths, (seed, "limit theorem"), threads=threads)
    final, maximum = scaled_integrals(scene, p, steps, sampling)
    over = ("p", "path")
    return artifact.dataset(
        "Samples of the scaled integral of the observable",
        f"{paths} paths of {scene}",
        {"p": ("p", np.array(p, dtype=float), "scale p")},
        {
            # single precision, as the maximum is simulated
            "final": (over, final.astype(np.float32), "Xi_p(1)"),
            "maximum": (over, maximum.astype(np.float32), "max over t <= 1 of |Xi_p(t)|"),
        },
    )


if __name__ == "__main__":
    produce(simulate, snakemake, threads=snakemake.threads)
