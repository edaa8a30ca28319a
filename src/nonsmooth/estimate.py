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
        Bound on the absolute error of a deterministic method, or the standard error.
    method : str
    seconds : float
        Time it took; never written to an artifact.
    """

    value: float
    error: float
    method: str
    seconds: float


def require(met: bool, value: float, error: float, tol: float, cure: str = "loosen tol") -> None:
    """Raise unless a relative tolerance of gamma^2 has been met.

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
