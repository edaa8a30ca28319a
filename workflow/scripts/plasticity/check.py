"""Evaluate the asymptotic formula from gamma^2 alone, and compare it with Monte Carlo."""

import numpy as np
from scipy.special import ndtri

from nonsmooth import artifact
from nonsmooth.brownian import asymptotic_crossing
from nonsmooth.errors import CheckError
from nonsmooth.jobs import produce

FALSE_ALARM = 1e-6  # probability that this check fails although nothing is wrong


def compare(variance, monte_carlo):
    """Subtract Monte Carlo from W_star(limit / gamma, duration).

    The difference is a property of the formula as long as the bias of the time step is not
    significantly above the standard error, which is checked.

    Parameters
    ----------
    variance : xarray.Dataset
    monte_carlo : list of xarray.Dataset
        One per limit.

    Returns
    -------
    xarray.Dataset
        Over (limit, duration).

    Raises
    ------
    CheckError
        If the time step's bias is significantly above the standard error.
    """
    gamma2, gamma2_error = float(variance["gamma2"]), float(variance["gamma2_error"])
    limits = np.array([float(run["limit"]) for run in monte_carlo])
    durations = monte_carlo[0]["duration"].values
    z = -ndtri(FALSE_ALARM / 2 / (len(limits) * len(durations)))
    formula, differences = [], []
    for limit, run in zip(limits, monte_carlo, strict=True):
        excess = np.abs(run["bias"]) - z * run["bias_error"]
        if np.any(excess > run["probability_error"].max()):
            raise CheckError(
                f"the time step's bias at the limit {limit:g} is above the standard error; "
                "reduce plasticity.step"
            )
        value, error = asymptotic_crossing(limit, durations, gamma2, gamma2_error)
        formula.append((value, error))
        differences.append(
            (value - run["probability"].values, np.hypot(error, run["probability_error"].values))
        )
    (value, error), (difference, difference_error) = (
        np.swapaxes(pairs, 0, 1) for pairs in (formula, differences)
    )
    over = ("limit", "duration")
    return artifact.dataset(
        "Probability of exceeding a permanent deformation by the asymptotic formula",
        "W_star(limit / gamma, duration), and its difference to Monte Carlo",
        {
            "limit": ("limit", limits, "limit of the permanent deformation"),
            "duration": ("duration", durations, "duration of the earthquake"),
        },
        {
            "probability": (over, value, "W_star(limit / gamma, duration)"),
            "probability_error": (over, error, "error inherited from gamma^2"),
            "difference": (over, difference, "formula less Monte Carlo"),
            "difference_error": (over, difference_error, "standard error of the difference"),
        },
    )


if __name__ == "__main__":
    produce(compare, snakemake)
