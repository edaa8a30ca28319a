"""Measure the distance of every scene to its limit, and check that it falls as p grows."""

import numpy as np

from reproduction.agreement import FALSE_ALARM
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.limit_theorem import (
    allowed_distance,
    distance_to_limit,
    error_bound,
    maximum_law,
    normal_law,
    sampling_bound,
)

LAWS = {
    "final": (normal_law, "Xi_p(1)/gamma to the standard normal law"),
    "maximum": (maximum_law, "max |Xi_p|/gamma to the law of the maximum of |W|"),
}


def distances(samples, limit, scenes, level):
    """Compare the samples with the laws of W(1) and of the maximum of |W|.

    A distance should fall like p^(-1/2). At the largest p it must not be above what the smaller p
    then allow, with their errors (`allowed_distance`). The errors hold for all scenes, laws and p
    at once, by Bonferroni's inequality. That of gamma^2 includes the bias of the time step.

    Parameters
    ----------
    samples : list of xarray.Dataset
        One per scene.
    limit : xarray.Dataset
        gamma^2 over scene.
    scenes : list of str
        Names, in the order of the samples.
    level : float
        Probability with which a distance misses its published error bound by chance.

    Returns
    -------
    xarray.Dataset
        Over (scene, p).

    Raises
    ------
    CheckError
        If a distance does not fall as it should.
    """
    p = samples[0]["p"].values
    paths = samples[0].sizes["path"]
    count = len(scenes) * len(LAWS) * len(p)
    over, variables = ("scene", "p"), {}
    for name, (law, text) in LAWS.items():
        found = np.array(
            [
                distance_to_limit(
                    sample[name].sel(p=scale).values,
                    law,
                    *(float(limit[key].sel(scene=scene)) for key in ("gamma2", "gamma2_error")),
                )
                for scene, sample in zip(scenes, samples, strict=True)
                for scale in p
            ]
        )
        distance, sensitivity = found.T.reshape(2, len(scenes), len(p))
        bound = error_bound(paths, sensitivity, FALSE_ALARM / count)
        allowed = allowed_distance(p, distance, bound)
        ratio = distance[:, -1] / allowed
        worst = np.argmax(ratio)
        if not ratio[worst] <= 1:
            raise CheckError(
                f"{scenes[worst]}: at p = {p[-1]:g} the distance of {text} is "
                f"{distance[worst, -1]:.4f}, above the {allowed[worst]:.4f} that smaller p allow; "
                "look for a mistake in gamma^2"
            )
        variables |= {
            name: (over, distance, f"Kolmogorov distance of {text}"),
            f"{name}_error": (
                over,
                error_bound(paths, sensitivity, level),
                f"{1 - level:.0%} bound on its error, by the sample and by gamma^2",
            ),
            f"{name}_allowed": ("scene", allowed, "what smaller p allow at the largest"),
        }
    return artifact.dataset(
        "Distances to the limits of the functional central limit theorem",
        f"{paths} paths per scene; at the largest p none is above what smaller p allow",
        {"scene": ("scene", scenes, "name of the scene"), "p": ("p", p, "scale p")},
        variables
        | {
            "floor": (
                (),
                sampling_bound(paths, level),
                f"what a sample's distance to its own law exceeds in {level:.0%} of all cases",
            ),
            "false_alarm": ((), FALSE_ALARM, "probability that the check fails by chance"),
        },
    )


if __name__ == "__main__":
    produce(distances, snakemake)
