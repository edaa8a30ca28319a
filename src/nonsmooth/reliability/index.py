"""The reliability index beta of a crossing probability."""

import numpy as np
import xarray as xr
from scipy.special import ndtri

from nonsmooth.errors import SceneError, quoted
from nonsmooth.results import between_limits

_NEEDED = "probability", "probability_error", "lower", "upper"


def reliability_index(crossing: xr.Dataset) -> xr.Dataset:
    """Turn crossing probabilities into reliability indices beta = -Phi^-1(W).

    Parameters
    ----------
    crossing : xarray.Dataset
        From `crossing_probability` or `state_crossing_probability`.

    Returns
    -------
    xarray.Dataset
        Over the same dimensions and with the same attributes: `reliability_index`, beta, "1";
        `lower` and `upper`, the indices of the upper and of the lower limit of W; and
        `reliability_index_error`, the largest change of beta if W changes by its error, inf where
        that leaves it open.

    Raises
    ------
    SceneError
        If it is no such dataset, an empty one, or one that has been changed: numbers outside of
        [0, 1], negative errors, lower limits above the upper ones, other dimensions.
    """
    if not isinstance(crossing, xr.Dataset) or not set(_NEEDED) <= set(crossing.data_vars):
        raise SceneError(
            f"crossing is {quoted(crossing)}; give what crossing_probability has returned"
        )
    W, error, lower, upper = (crossing[name] for name in _NEEDED)
    if not W.size:
        raise SceneError("crossing has no probabilities; give what crossing_probability returned")
    probabilities = W, lower, upper
    numbers = all(part.dtype.kind in "iuf" for part in (*probabilities, error))
    alike = all(part.dims == W.dims for part in (lower, upper, error))
    inside = (part.clip(0, 1) == part for part in probabilities)
    own_error = crossing.get("survival_error", error)
    if not (numbers and alike) or not all(
        condition.all() for condition in (*inside, error >= 0, own_error >= 0, lower <= upper)
    ):
        raise SceneError(
            "crossing has numbers that are no probabilities; give what crossing_probability "
            "returned, unchanged"
        )
    # near W = 1 the complement has more digits
    own = W >= 0.5 if "survival_error" in crossing else xr.zeros_like(W, dtype=bool)
    survival = crossing.get("survival", 1 - W)
    beta = xr.where(W < 0.5, -ndtri(W), ndtri(survival))
    # where W is 0 or 1 itself, so is beta infinite, and its error
    with np.errstate(invalid="ignore"):
        ends = [
            xr.where(
                own,
                ndtri((survival - sign * own_error).clip(0, 1)),
                -ndtri((W + sign * error).clip(0, 1)),
            )
            for sign in (-1, 1)
        ]
        moved = [abs(end - beta) for end in ends]
    found = between_limits(
        {},
        W.dims,
        "reliability_index",
        "reliability index",
        (
            beta.values,
            np.maximum(*moved).fillna(np.inf).values,
            xr.where(own, ends[1], -ndtri(upper)).values,
            xr.where(own, ends[0], -ndtri(lower)).values,
        ),
        **crossing.attrs,
    )
    return found.assign_coords(crossing.coords)
