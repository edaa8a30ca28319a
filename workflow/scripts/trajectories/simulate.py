"""One path of a model for several penalizations, all driven by the same Brownian path."""

import xarray as xr

from nonsmooth.paths import time_grids
from nonsmooth.paths.simulation import simulate
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def same_noise(model, potential, damping, n, horizon, step, outputs, seed, path):
    """Simulate the oscillator with white noise for each penalization.

    Returns
    -------
    xarray.Dataset
        y and x over (n, t); n = inf is the non-smooth limit.
    """
    scene = Scene(model=model, potential=potential, damping=damping, observable="x")
    times = time_grids.equidistant(horizon, outputs)
    runs = [
        simulate(
            scene.with_n(k),
            horizon,
            step=step,
            paths=1,
            seed=(seed, path),
            times=times,
            keep="paths",
        )
        for k in n
    ]
    joined = xr.concat(runs, dim="n").isel(path=0)
    return artifact.dataset(
        f"Trajectories of the {scene.mechanics.title.lower()} model",
        f"{scene.with_n(float('inf'))} and its penalizations on one Brownian path",
        {
            "n": ("n", [float(k) for k in n], "penalization; inf is the non-smooth limit"),
            "t": ("t", joined["time"].values, "time"),
        },
        {
            "y": (("n", "t"), joined["y"].values, "velocity"),
            "x": (("n", "t"), joined["x"].values, "displacement"),
        },
    )


if __name__ == "__main__":
    produce(same_noise, snakemake)
