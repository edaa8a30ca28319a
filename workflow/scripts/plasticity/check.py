"""Evaluate the asymptotic and the corrected formula, and compare them with Monte Carlo."""

import numpy as np

from nonsmooth.crossing.brownian import asymptotic_crossing
from reproduction.agreement import standard_errors
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

DESCRIPTIONS = {
    "probability": "W_star(limit / gamma, duration)",
    "probability_error": "error inherited from gamma^2",
    "difference": "formula less Monte Carlo",
    "difference_error": "standard error of the difference",
    "corrected": "W_star((limit + kappa) / gamma, duration)",
    "corrected_error": "error inherited from gamma^2 and kappa",
    "corrected_difference": "corrected formula less Monte Carlo",
    "corrected_difference_error": "standard error of that difference",
}


def compare(variance, monte_carlo):
    """Subtract Monte Carlo from W_star(limit / gamma, duration), and with limit + kappa.

    The differences are properties of the formulas as long as the bias of the time step is not
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
    kappa, kappa_error = float(variance["kappa"]), float(variance["kappa_error"])
    limits = np.array([float(run["limit"]) for run in monte_carlo])
    durations = monte_carlo[0]["duration"].values
    z = standard_errors(len(limits) * len(durations))
    found = []
    for limit, run in zip(limits, monte_carlo, strict=True):
        excess = np.abs(run["bias"]) - z * run["bias_error"]
        if np.any(excess > run["probability_error"].max()):
            raise CheckError(
                f"the time step's bias at the limit {limit:g} is above the standard error; "
                "reduce plasticity.step"
            )
        value, error = asymptotic_crossing(limit, durations, gamma2, gamma2_error)
        corrected, corrected_error = asymptotic_crossing(
            limit + kappa, durations, gamma2, gamma2_error
        )
        farther, _ = asymptotic_crossing(
            limit + kappa + kappa_error, durations, gamma2, gamma2_error
        )
        corrected_error = corrected_error + np.abs(farther - corrected)
        sampled, standard_error = run["probability"].values, run["probability_error"].values
        found.append(
            {
                "probability": value,
                "probability_error": error,
                "difference": value - sampled,
                "difference_error": np.hypot(error, standard_error),
                "corrected": corrected,
                "corrected_error": corrected_error,
                "corrected_difference": corrected - sampled,
                "corrected_difference_error": np.hypot(corrected_error, standard_error),
            }
        )
    return artifact.dataset(
        "Probability of exceeding a permanent deformation by the asymptotic formulas",
        "W_star(limit / gamma, duration), with limit + kappa, and differences to Monte Carlo",
        {
            "limit": ("limit", limits, "limit of the permanent deformation"),
            "duration": ("duration", durations, "duration of the earthquake"),
        },
        {
            name: (("limit", "duration"), np.array([run[name] for run in found]), text)
            for name, text in DESCRIPTIONS.items()
        },
    )


if __name__ == "__main__":
    produce(compare, snakemake)
