"""Check that the two methods of table 4 agree, and with what the paper prints."""

import numpy as np

from reproduction.agreement import deviation, require_telling
from reproduction.convergence import printed_in_table_4
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.rendering.tables import sorted_by

# The paper rounds or truncates to six decimals; its entry of n = 50 is lower by another unit of
# the last, see the errata.
PRINTED = 2e-6
REFINE = (
    "enlarge convergence.finite_difference.half_width or nodes, or reduce time_step; else look for "
    "a mistake"
)
REREAD = "correct paper/printed.yaml, or look for a mistake in the spectral elements"


def agreement(spectral, finite_difference, scene, horizon):
    """Compare v(0, T)/T of both methods, and the reference with the printed values, at every n.

    The finite differences may deviate by the sum of both error bounds, and theirs must be small
    against v/T. Printed values are compared where the scene and T are those of the paper.

    Parameters
    ----------
    spectral, finite_difference : list of xarray.Dataset
        One per n; the finite differences have no n = inf.
    scene : dict
        Parameters without n.
    horizon : float

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    CheckError
        If a deviation exceeds what is allowed, or the errors of the finite differences are large.
    """
    spectral = {float(run["n"]): run for run in sorted_by("n", spectral)}
    finite_difference = sorted_by("n", finite_difference)
    n = [float(run["n"]) for run in finite_difference]
    value, bound, reference, reference_bound = (
        np.array([float(run[key]) for run in runs])
        for runs in (finite_difference, [spectral[k] for k in n])
        for key in ("v_over_time", "v_over_time_error")
    )
    ratio = deviation(
        "finite_difference",
        [f"n = {k:g}" for k in n],
        value,
        reference,
        bound + reference_bound,
        REFINE,
    )
    require_telling("finite_difference", bound, reference, REFINE)
    printed = {k: v for k, v in printed_in_table_4(scene, horizon).items() if k in spectral}
    if printed:
        deviation(
            "what table 4 prints",
            [f"n = {k:g}" for k in printed],
            list(printed.values()),
            [float(spectral[k]["v_over_time"]) for k in printed],
            PRINTED,
            REREAD,
        )
    return artifact.dataset(
        "Agreement of the paper's scheme with the spectral elements",
        "deviation divided by the allowed error, at most 1; the printed values agree, too",
        {"n": ("n", n, "penalization")},
        {
            "finite_difference": ("n", ratio, "relative deviation of the finite differences"),
            "printed": ((), len(printed), "how many of the printed values were compared"),
            "printed_allowed": ((), PRINTED, "what a printed value may deviate"),
        },
    )


if __name__ == "__main__":
    produce(agreement, snakemake)
