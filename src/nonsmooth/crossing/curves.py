"""Probabilities of a crossing over horizons, as the public functions return them."""

from collections.abc import Callable, Iterable, Mapping

import numpy as np
import xarray as xr

from nonsmooth.errors import ToleranceError
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
_BETWEEN_0_AND_1 = "probability_error", "survival_error"


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
    # whatever a method states, a probability is between 0 and 1
    capped = {name: np.minimum(values[name], 1.0) for name in _BETWEEN_0_AND_1 if name in values}
    value, error = values["probability"], capped["probability_error"]
    limits = {"lower": np.maximum(value - error, 0), "upper": np.minimum(value + error, 1)}
    dimensions = ("horizon",) if levels is None else ("threshold", "horizon")
    every = limits | dict(values) | capped
    variables = {name: (dimensions, own, _TITLES[name]) for name, own in every.items()}
    return dataset(
        {"horizon": ("horizon", horizons, "horizon T")} | dict(levels or {}),
        variables,
        about={"probability": variables},
        method=method,
        **attributes,
    )


def coordinates(thresholds: np.ndarray) -> dict[str, tuple]:
    """Return the coordinates of a dimension of thresholds.

    Parameters
    ----------
    thresholds : numpy.ndarray, shape (m, 2)
        Lower and upper levels.

    Returns
    -------
    dict
        As for `results.dataset`.
    """
    levels = {
        f"threshold_{word}": ("threshold", side, f"{word} level")
        for word, side in zip(("lower", "upper"), thresholds.T, strict=True)
    }
    lower, upper = thresholds.T
    if np.all(lower == -upper):
        levels["threshold"] = "threshold", upper, "threshold b"
    return levels


def one_by_one(solvers: Iterable[Callable[[], dict]]) -> dict[str, np.ndarray]:
    """Solve for one threshold after the other.

    Parameters
    ----------
    solvers : iterable of callable
        Return the `values` of `curves` for one threshold each, shape (k,).

    Returns
    -------
    dict
        The values of all, shape (m, k).

    Raises
    ------
    ToleranceError
        If some miss the tolerance: the error of the first, with all answers as its `result`.
    """
    found, missed = [], []
    for solve in solvers:
        try:
            found.append(solve())
        except ToleranceError as refused:
            if refused.result is None:
                raise
            found.append(refused.result)  # type: ignore[arg-type]
            missed.append(refused)
    values = {name: np.array([own[name] for own in found]) for name in found[0]}
    if missed:
        raise ToleranceError(str(missed[0]), values)
    return values
