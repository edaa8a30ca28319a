"""Check that histograms and solved densities of figure 7 agree."""

import numpy as np

from reproduction.agreement import FALSE_ALARM, deviation
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

CURE = (
    "lengthen density.time, reduce density.step or tighten density.tolerances; else look for a "
    "mistake"
)


def agreement(densities, names, paths):
    """Compare every bin of every scene.

    The bias of the time step is subtracted from the histogram. What is left may deviate by the
    error of the solved average and by chance, as far as Bernstein's inequality allows, which holds
    for small counts, too; over all bins by that of Bonferroni.

    Parameters
    ----------
    densities : list of xarray.Dataset
        One per name.
    names : list of str
    paths : int
        Of each histogram.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    CheckError
        If a bin deviates by more.
    """
    bins = sum(sum(found.sizes.values()) for found in densities)
    largest = []
    for name, found in zip(names, densities, strict=True):
        ratios = [
            deviation(
                f"the histogram of {variable} of {name}",
                [f"{variable} = {z:.3g}" for z in found[variable].values],
                (found[f"histogram_{variable}"] - found[f"histogram_{variable}_bias"]).values,
                found[f"density_{variable}"].values,
                _allowed(found, variable, paths, FALSE_ALARM / bins),
                CURE,
            ).max()
            for variable in found.dims
        ]
        largest.append(max(ratios))
    return artifact.dataset(
        "Agreement of histograms and solved densities",
        "deviation less the bias of the step, divided by what is allowed; all at most 1",
        {"scene": ("scene", names, "name of the scene")},
        {
            "deviation": ("scene", largest, "largest relative deviation of a bin"),
            "false_alarm": ((), FALSE_ALARM, "probability that the check fails by chance"),
        },
    )


def _allowed(found, variable, paths, level):
    """Error of the solved average, and what chance exceeds with a probability of `level`."""
    width = np.diff(found[variable].values)[0]
    solved, error = (found[f"density_{variable}{part}"].values for part in ("", "_error"))
    likely = np.clip((solved + error) * width, 0.0, 0.5)  # p (1 - p) is largest at 1/2
    # a path counts (1 - factor) in the histogram, and `factor` in that with half the step
    factor, log = float(found["factor"]), np.log(2 / level)
    variance = paths * likely * (1 - likely) * ((1 - factor) ** 2 + factor**2)
    reach = factor * log / 3
    return error + (reach + np.sqrt(reach**2 + 2 * variance * log)) / paths / width


if __name__ == "__main__":
    produce(agreement, snakemake)
