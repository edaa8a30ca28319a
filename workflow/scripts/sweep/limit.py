"""The asymptotic crossing formula of every scene, from its gamma^2."""

import numpy as np

from nonsmooth.crossing.brownian import asymptotic_crossing
from nonsmooth.paths import time_grids
from reproduction.errors import CheckError
from reproduction.gamma2 import require_agreement
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

ALLOWED = 5.0  # standard errors; chance exceeds them with a probability of 6e-7


def limit(variance, solved, scenes, names, horizon, outputs):
    """Evaluate W_star(b / gamma, T) with the error it inherits from gamma^2.

    Parameters
    ----------
    variance : list of xarray.Dataset
        By Monte Carlo, one per scene, in the order of `scenes`.
    solved : list of xarray.Dataset
        Without Monte Carlo, for the scenes in `names`; preferred.
    scenes : dict
        Name -> the scene's parameters and its threshold.
    names : list of str
    horizon, outputs
        Last T and number of equidistant T.

    Returns
    -------
    xarray.Dataset
        Over (scene, horizon); with the gamma^2 that all later steps of the workflow use.

    Raises
    ------
    CheckError
        If the observable is not centred, gamma^2 is not settled, cannot be told from 0 or differs
        from that of the Poisson equation, or the bias of the time step is above its error.
    """
    horizons = time_grids.equidistant(horizon, outputs)
    rates, errors, curves = [], [], []
    exact = dict(zip(names, solved, strict=True))
    for (name, parameters), run in zip(scenes.items(), variance, strict=True):
        value = {key: float(run[key]) for key in run.data_vars}
        if abs(value["mean"]) > ALLOWED * value["mean_error"]:
            raise CheckError(
                f"the asymptotic formula needs E g = 0, but {name} has the mean "
                f"{value['mean']:.3g}; subtract it from the scene's observable"
            )
        if abs(value["settling"]) > ALLOWED * value["settling_error"]:
            raise CheckError(
                f"the variance of {name} does not yet grow linearly; lengthen sweep.variance.times"
            )
        if abs(value["bias"]) > ALLOWED * (value["bias_error"] + value["gamma2_error"]):
            raise CheckError(
                f"the time step's bias of {name} is above the standard error; reduce sweep.step"
            )
        error = np.linalg.norm([value[k] for k in ("gamma2_error", "bias", "bias_error")])
        if not value["gamma2"] > ALLOWED * error:
            raise CheckError(
                f"gamma^2 of {name} is {value['gamma2']:.2g} +- {error:.1g} and may be 0; increase "
                "sweep.variance.paths, or choose another observable if int_0^t g stays bounded"
            )
        if name in exact:
            require_agreement(name, exact[name], value)
            value["gamma2"], error = (float(exact[name][k]) for k in ("gamma2", "gamma2_error"))
        rates.append(value["gamma2"])
        errors.append(error)
        curves.append(asymptotic_crossing(parameters["threshold"], horizons, rates[-1], error))
    probability, probability_error = np.swapaxes(curves, 0, 1)
    over = ("scene", "horizon")
    return artifact.dataset(
        "Limits of the threshold crossing probabilities",
        "W_star(b / gamma, T) with gamma^2 from the Poisson equation, else by Monte Carlo",
        {
            "scene": ("scene", list(scenes), "name of the scene"),
            "horizon": ("horizon", horizons, "T"),
        },
        {
            "probability": (over, probability, "W_star(b / gamma, T)"),
            "probability_error": (over, probability_error, "error inherited from gamma^2"),
            "gamma2": ("scene", rates, "gamma^2, asymptotic variance of int_0^t g"),
            "gamma2_error": (
                "scene",
                errors,
                "error bound, or standard error and bias by the time step",
            ),
            "allowed": ((), ALLOWED, "standard errors that a mean of zero may be off"),
        },
    )


if __name__ == "__main__":
    produce(limit, snakemake)
