"""One shard of figure 2a's Monte Carlo: power sums of int_0^tau g."""

from functools import partial

from nonsmooth import artifact, times
from nonsmooth.jobs import produce
from nonsmooth.scene import Scene
from nonsmooth.trajectories import simulate


def shard(scene, first_time, horizon, points, step, paths, shard, index, seed, threads):
    """Simulate the paths number `index * shard` onwards, `shard` of them or what is left.

    Returns
    -------
    xarray.Dataset
    """
    tau = times.logarithmic(first_time, horizon, points)
    first = index * shard
    result = simulate(
        Scene(**scene),
        horizon,
        step,
        min(shard, paths - first),
        seed,
        times=tau,
        first_path=first,
        threads=threads,
    )
    return artifact.dataset(
        "Power sums of the integrated observable",
        f"shard {index} of {Scene(**scene)}",
        {
            "time": ("time", tau, "tau"),
            "power": ("power", result["power"].values, "power"),
        },
        {"power_sum": (("power", "time"), result["power_sum"].values, "sum over the paths")},
    )


if __name__ == "__main__":
    produce(partial(shard, threads=snakemake.threads), snakemake)
