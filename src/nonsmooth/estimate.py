"""A value together with its error."""

from dataclasses import dataclass

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
        With the best value and its error.
    """
    if not met:
        raise ToleranceError(
            f"gamma^2 = {value:.16g} has an error of {error:.1e}, above tol = {tol:g} relative; "
            f"{cure}"
        )
