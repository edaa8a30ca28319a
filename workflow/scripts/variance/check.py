"""Check that the three methods of figure 2a agree within their stated errors."""

import numpy as np

from reproduction.agreement import FALSE_ALARM, deviation, require_telling, standard_errors
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

CURES = {
    "finite_difference": "enlarge variance.finite_difference.half_width or nodes, or reduce "
    "time_step; else look for a mistake",
    "monte_carlo": "reduce variance.monte_carlo.step; else look for a mistake",
}


def deviations(spectral, finite_difference, monte_carlo):
    """Compare the methods at every plotted tau, in units of what is allowed.

    The finite differences may deviate by the sum of both error bounds, and theirs must be small
    against the largest v/tau. Monte Carlo may, once its
    estimated bias is subtracted, deviate by z standard errors, which are those of the sample and of
    the bias together. By Bonferroni's inequality over all tau, z follows from the probability of a
    false alarm. Besides, the bias of the time step must not be significantly above the standard
    error.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    CheckError
        If a deviation exceeds what is allowed, or the errors of the finite differences are large.
    """
    tau, v = spectral["tau"].values, spectral["v"].values
    z = standard_errors(len(tau))
    allowed = {
        "finite_difference": finite_difference["v_error"].values,
        "monte_carlo": z * np.hypot(monte_carlo["v_error"], monte_carlo["bias_error"]).values,
    }
    values = {
        "finite_difference": finite_difference["v"].values,
        "monte_carlo": (monte_carlo["v"] - monte_carlo["bias"]).values,
    }
    places = [f"tau = {time:g}" for time in tau]
    ratio = {
        name: deviation(
            name, places, value, v, allowed[name] + spectral["v_error"].values, CURES[name]
        )
        for name, value in values.items()
    }
    require_telling(
        "finite_difference", allowed["finite_difference"] / tau, v / tau, CURES["finite_difference"]
    )
    bias, bias_error = np.abs(monte_carlo["bias"].values), monte_carlo["bias_error"].values
    if np.any(bias - z * bias_error > monte_carlo["v_error"].values):
        raise CheckError(
            "the time step's bias is above the standard error; reduce variance.monte_carlo.step"
        )
    return artifact.dataset(
        "Agreement of the three methods",
        "deviation from the spectral elements divided by the allowed error; all at most 1",
        {"tau": ("tau", tau, "time tau")},
        {name: ("tau", r, f"relative deviation of {name}") for name, r in ratio.items()}
        | {
            "threshold": ((), z, "allowed Monte Carlo deviation in standard errors"),
            "false_alarm": ((), FALSE_ALARM, "probability of exceeding the threshold by chance"),
        },
    )


if __name__ == "__main__":
    produce(deviations, snakemake)
