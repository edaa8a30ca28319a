"""A value together with its error."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import ToleranceError


@dataclass(frozen=True)
class Estimate:
    """A number and what is known about it.

    Attributes
    ----------
    value : float
    error : float
        Absolute: an estimated bound if the method is deterministic, else the standard error.
    method : str
        Name of the method that found it.
    seconds : float
        Time it took.
    """

    value: float
    error: float
    method: str
    seconds: float


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
    return np.maximum(value, 0.0), np.maximum(error, -value)


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
