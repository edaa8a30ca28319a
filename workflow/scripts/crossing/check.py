"""Check figure 2b: the time step's bias is below the standard error, and W tends to W_star."""

import numpy as np

from reproduction.agreement import standard_errors
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.rendering.tables import sorted_by


def compare(monte_carlo, asymptotic, gamma2):
    """Bound the bias of the time step and measure the distance to the limit.

    For large p the relative bias of the first-passage times is minus that of gamma^2, which is
    known precisely. The bias of W that follows from it must be below the largest standard error of
    W. The bias of W that is measured directly must not be significantly above the standard error at
    any p, nor contradict the precise one at p >= 10.

    Parameters
    ----------
    monte_carlo : list of xarray.Dataset
        One per p.
    asymptotic : xarray.Dataset
    gamma2 : xarray.Dataset
        Its relative bias by the same step.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    CheckError
        If the bias is not below the standard error, or the two measurements contradict.
    """
    monte_carlo = sorted_by("p", monte_carlo)
    p = np.array([float(d["p"]) for d in monte_carlo])
    column = {
        name: np.array([float(d[name]) for d in monte_carlo])
        for name in ("bias", "bias_error", "slope")
    }
    standard_error = np.array([float(d["probability_error"].max()) for d in monte_carlo])
    relative, relative_error = float(gamma2["bias"]), float(gamma2["bias_error"])
    expected, expected_error = relative * column["slope"], relative_error * column["slope"]
    z = standard_errors(len(p))
    contradiction = np.abs(column["bias"] - expected) / np.hypot(
        column["bias_error"], expected_error
    )
    distance = np.array(
        [float(np.abs(d["probability"] - asymptotic["probability"]).max()) for d in monte_carlo]
    )
    if np.any(contradiction[p >= 10] > z):
        raise CheckError(
            "two measurements of the time step's bias contradict each other; "
            "look for a mistake in the splitting"
        )
    direct = np.abs(column["bias"]) - z * column["bias_error"]
    if np.any(np.maximum(direct, np.abs(expected) + 1.96 * expected_error) > standard_error):
        raise CheckError(
            "the time step's bias is not below the standard error; reduce crossing.step"
        )
    return artifact.dataset(
        "Time step bias and distance to the limit",
        "for each p, the largest over T",
        {"p": ("p", p, "scale p")},
        {
            "distance": ("p", distance, "largest distance to W_star"),
            "standard_error": ("p", standard_error, "largest standard error of W"),
            "bias": ("p", column["bias"], "bias of W from the shift of first-passage times"),
            "bias_error": ("p", column["bias_error"], "its standard error"),
            "limit_bias": ("p", expected, "bias of W from that of gamma^2"),
            "limit_bias_error": ("p", expected_error, "its standard error"),
        },
    )


if __name__ == "__main__":
    produce(compare, snakemake)
