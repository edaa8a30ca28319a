"""A value together with its error."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Estimate:
    """A number and what is known about it.

    Attributes
    ----------
    value : float
    error : float
        Bound on the absolute error of a deterministic method, or the standard error.
    method : str
    seconds : float
        Time it took; never written to an artifact.
    """

    value: float
    error: float
    method: str
    seconds: float
