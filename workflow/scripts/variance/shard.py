"""One shard of figure 2a's Monte Carlo: power sums of int_0^tau g."""

from functools import partial

from nonsmooth import artifact, times
from nonsmooth.jobs import produce
from nonsmooth.scene import Scene
from nonsmooth.trajectories import simulate


def shard(scene, first_time, horizon, points, step, part, seed, threads):
    """Simulate a part of the ensemble: (number of its first path, number of paths).

    Returns
    -------
    xarray.Dataset
    """
    tau = times.logarithmic(first_time, horizon, points)
    first, paths = part
    result = simulate(
        Scene(**scene),
        horizon,
        step,
        paths,
        seed,
        times=tau,
        first_path=first,
        threads=threads,
    )
    return artifact.dataset(
        "Power sums of the integrated observable",
        f"{paths} paths from number {first} of {Scene(**scene)}",
        {
            "time": ("time", tau, "tau"),
            "power": ("power", result["power"].values, "power"),
        },
        {"power_sum": (("power", "time"), result["power_sum"].values, "sum over the paths")},
    )


if __name__ == "__main__":
    produce(partial(shard, threads=snakemake.threads), snakemake)
