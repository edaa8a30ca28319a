"""Rare crossings of one scene by importance sampling, beside exact values where these are known."""

import numpy as np

from nonsmooth.crossing.probability import crossing_probability
from nonsmooth.scenes.scene import Scene
from reproduction.agreement import standard_errors
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

EXACT = 1e-8  # error wanted of exact values; where they are small, it is far below themselves

DESCRIPTIONS = {
    "probability": "probability of crossing sqrt(p) b by p T",
    "probability_error": "the bias of the time step and the standard error together",
    "standard_error": "standard error of the probability",
    "step_bias": "bias of the probability by the time step",
    "step_bias_error": "standard error of the bias",
    "lower": "lower 95 % limit",
    "upper": "upper 95 % limit",
    "effective_sample_size": "number of equally weighted paths that would tell as much",
}


def sample(scene, thresholds, p, horizon, seed, threads):
    """Sample to a tenth of each probability.

    Returns
    -------
    xarray.Dataset
        Over `threshold`; with `exact` for one variable.

    Raises
    ------
    CheckError
        If a probability is too far from the exact one.
    """
    scene = Scene(**scene)
    found = crossing_probability(
        scene,
        thresholds,
        [horizon],
        p,
        method="importance_sampling",
        seed=(seed, "rare crossings"),
        threads=threads,
    ).isel(horizon=0)
    variables = {
        name: ("threshold", found[name].values, text) for name, text in DESCRIPTIONS.items()
    }
    if scene.dimension == 1:
        exact = crossing_probability(
            scene, thresholds, [horizon], p, method="deterministic", tol=EXACT
        ).isel(horizon=0)
        _require_agreement(found, exact)
        variables |= {
            "exact": ("threshold", exact["probability"].values, "solved probability"),
            "exact_error": (
                "threshold",
                exact["probability_error"].values,
                "difference of two resolutions",
            ),
        }
    return artifact.dataset(
        "Rare threshold crossings by importance sampling",
        f"{found.attrs['paths']} paths at most of {scene}, p = {p}, T = {horizon}",
        {"threshold": ("threshold", np.array(thresholds, dtype=float), "threshold b")},
        variables | {"paths": ((), found.attrs["paths"], "largest number of paths")},
    )


def _require_agreement(found, exact):
    """Compare, less the bias of the step, with exact values; by Bonferroni's inequality."""
    spread = np.sqrt(
        found["standard_error"] ** 2
        + found["step_bias_error"] ** 2
        + exact["probability_error"] ** 2
    )
    off = np.abs(found["probability"] - found["step_bias"] - exact["probability"]) / spread
    if not np.all(off.values <= standard_errors(off.size)):
        raise CheckError(
            "rare_crossings: the probability by importance sampling is "
            f"{float(off.max()):.1f} standard errors from the exact one; look for a mistake"
        )


if __name__ == "__main__":
    produce(sample, snakemake, threads=snakemake.threads)
