"""Probabilities of a crossing over horizons, as the public functions return them."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from nonsmooth.results import dataset

_TITLES = {
    "probability": "probability of a crossing",
    "probability_error": "distance to the probability asked for",
    "lower": "lower limit of the probability",
    "upper": "upper limit of the probability",
    "survival": "probability of no crossing",
    "survival_error": "error of the probability of no crossing",
    "limit_error": "error inherited from gamma^2",
    "standard_error": "standard error",
    "step_bias": "bias of the time step",
    "step_bias_error": "standard error of the bias",
    "effective_sample_size": "effective number of the paths that cross",
}


def curves(
    values: Mapping[str, np.ndarray],
    horizons: np.ndarray,
    method: str,
    attributes: Mapping,
    levels: Mapping[str, tuple] | None = None,
) -> xr.Dataset:
    """Assemble the answer of a method.

    Parameters
    ----------
    values : mapping
        `probability`, `probability_error` and whatever else the method knows, by their names: of
        the shape (k,), or (thresholds, k) if `levels` are given. `lower` and `upper` follow from
        the error unless they are among them.
    horizons : numpy.ndarray, shape (k,)
    method : str
    attributes : mapping
        Besides the method.
    levels : mapping, optional
        Coordinates of the dimension `threshold`, as for `results.dataset`.

    Returns
    -------
    xarray.Dataset
    """
    value, error = values["probability"], values["probability_error"]
    limits = {"lower": np.maximum(value - error, 0), "upper": np.minimum(value + error, 1)}
    dimensions = ("horizon",) if levels is None else ("threshold", "horizon")
    variables = {
        name: (dimensions, own, _TITLES[name]) for name, own in (limits | dict(values)).items()
    }
    return dataset(
        {"horizon": ("horizon", horizons, "horizon T")} | dict(levels or {}),
        variables,
        about={"probability": variables},
        method=method,
        **attributes,
    )
