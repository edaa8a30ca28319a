"""Check figure 6 and table 6: the time step's bias is not above the standard error."""

import numpy as np

from reproduction.agreement import FALSE_ALARM, standard_errors
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


def biases(crossing, scenes, p):
    """Compare the bias of the step with the largest standard error of each curve.

    By Bonferroni's inequality over all scenes, p and T, the bias is not significantly above it.

    Parameters
    ----------
    crossing : list of xarray.Dataset
        One per scene and p, p changing fastest.
    scenes : dict
        Name -> the scene's parameters and its threshold.
    p : list of float

    Returns
    -------
    xarray.Dataset
        Over (scene, p).

    Raises
    ------
    CheckError
        If a bias is above the standard error.
    """
    z = standard_errors(sum(run.sizes["horizon"] for run in crossing))
    places = [(name, scale) for name in scenes for scale in p]
    excess = []
    for (name, scale), run in zip(places, crossing, strict=True):
        certain = np.abs(run["bias"].values) - z * run["bias_error"].values
        excess.append(certain.max() / float(run["probability_error"].max()))
        if not excess[-1] <= 1:
            raise CheckError(
                f"the time step's bias of {name} at p = {scale:g} is above the standard error; "
                "reduce sweep.step"
            )
    return artifact.dataset(
        "Bias of the time step in the crossing probabilities of every scene",
        "the part of it that is certain, in units of the standard error; all at most 1",
        {"scene": ("scene", list(scenes), "name of the scene"), "p": ("p", p, "scale p")},
        {
            "excess": (
                ("scene", "p"),
                np.reshape(excess, (len(scenes), len(p))),
                "largest bias less what may be chance, over the standard error",
            ),
            "threshold": ((), z, "standard errors of the bias that may be chance"),
            "false_alarm": ((), FALSE_ALARM, "probability that the check fails by chance"),
        },
    )


if __name__ == "__main__":
    produce(biases, snakemake)
