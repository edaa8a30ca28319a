"""A value together with its error."""

import html
import math
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from nonsmooth.errors import ToleranceError
from nonsmooth.results import dataset


@dataclass(frozen=True)
class Estimate:
    """A number and what is known about it.

    Attributes
    ----------
    value : float
    error : float
        Absolute: an estimated bound if the method is deterministic, else the standard error, with
        what else is not exact.
    method : str
        Name of the method that found it.
    seconds : float
        Time it took.
    """

    value: float
    error: float
    method: str
    seconds: float

    def __str__(self) -> str:
        return f"{self._digits()} +- {self.error:.1e} ({self.method}, {self.seconds:.2g} s)"

    def _repr_html_(self) -> str:
        """Summary for notebooks."""
        return (
            f"<b>{self._digits()}</b> ± {self.error:.1e}"
            f"<br><small>{html.escape(self.method)}, {self.seconds:.2g} s</small>"
        )

    def _digits(self):
        """Write the value with as many digits as its error leaves, and one more."""
        if not 0 < self.error < math.inf or self.value == 0:
            return f"{self.value:.12g}"
        sure = math.floor(math.log10(abs(self.value))) - math.floor(math.log10(self.error))
        return f"{self.value:.{min(max(sure + 2, 1), 16)}g}"

    def to_dataset(self) -> xr.Dataset:
        """Return a dataset of `value` and `value_error`, which has the method `to_netcdf`."""
        variables = {
            "value": ((), self.value, "value"),
            "value_error": ((), self.error, "error of the value"),
        }
        return dataset({}, variables, method=self.method, seconds=self.seconds)

    @classmethod
    def from_dataset(cls, data: xr.Dataset) -> "Estimate":
        """Return the estimate of which `to_dataset` has made a dataset."""
        value, error = float(data["value"]), float(data["value_error"])
        return cls(value, error, str(data.attrs["method"]), float(data.attrs["seconds"]))


def not_negative(value: ArrayLike, error: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Take negative values of what cannot be negative to 0.

    Parameters
    ----------
    value, error : array_like

    Returns
    -------
    value, error : numpy.ndarray
        0 is nearer to the truth than a negative value, so that the error still holds; where it is
        smaller than what a value is below 0, it is at least that.
    """
    value, error = np.asarray(value), np.asarray(error)
    return np.maximum(value, 0.0), np.maximum(error, 0.0 - value)


def require(met: bool, value: float, error: float, tol: float, cure: str = "loosen tol") -> None:
    """Raise an error unless gamma^2 was found to a relative tolerance.

    Parameters
    ----------
    met : bool
        Whether it was.
    value, error : float
        gamma^2 and its absolute error.
    tol : float
        The relative tolerance.
    cure : str
        What the user is told to do.

    Raises
    ------
    ToleranceError
        With both as its `result`.
    """
    if not met:
        if not value > error:
            cure += " or, if int_0^t g stays bounded, so that gamma^2 = 0, choose another g"
        raise ToleranceError(
            f"gamma^2 = {max(value, 0.0):.16g} has an error of {error:.1e}, above tol = {tol:g} "
            f"relative; {cure}",
            (value, error),
        )
