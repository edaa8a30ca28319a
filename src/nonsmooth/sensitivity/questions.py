"""A crossing question whose parameters can be changed."""

from dataclasses import dataclass, replace

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.scenes.scene import Scene
from nonsmooth.sensitivity.parameters import value_of


@dataclass(frozen=True)
class Question:
    """Does int g leave (sqrt(p) lower, sqrt(p) upper) before p T.

    Attributes
    ----------
    scene : Scene
    lower, upper : float
    horizons : numpy.ndarray, shape (k,)
    p : float
    """

    scene: Scene
    lower: float
    upper: float
    horizons: np.ndarray
    p: float

    @property
    def levels(self) -> tuple[float, float]:
        """Levels of int g."""
        return float(np.sqrt(self.p)) * self.lower, float(np.sqrt(self.p)) * self.upper

    @property
    def times(self) -> np.ndarray:
        """Times by which int g shall have crossed."""
        return self.p * self.horizons

    def value(self, parameter: str) -> float:
        """Return a parameter; of two levels, the distance of the nearer one."""
        if parameter == "p":
            return self.p
        if parameter == "threshold":
            return min(-self.lower, self.upper)
        return value_of(self.scene, parameter)

    def changed(self, parameter: str, part: float) -> "Question":
        """Return the question with a parameter changed by a part of its value."""
        value = self.value(parameter)
        if parameter == "p":
            return replace(self, p=(1 + part) * value)
        if parameter == "threshold":  # both levels move outwards by the same distance
            return replace(self, lower=self.lower - part * value, upper=self.upper + part * value)
        return replace(self, scene=self.scene.with_parameter(parameter, (1 + part) * value))


def missed(
    parameter: str,
    tol: float,
    value: np.ndarray,
    error: np.ndarray,
    bound: np.ndarray | None = None,
) -> ToleranceError:
    """Return the refusal of a derivative whose error is above the tolerance.

    Parameters
    ----------
    parameter : str
    tol : float
    value, error : numpy.ndarray, shape (k,)
        Its `result`.
    bound : numpy.ndarray, shape (k,), optional
        What the tolerance bounds, if that is not the error itself.

    Returns
    -------
    ToleranceError
    """
    worst = np.max(error if bound is None else bound)
    return ToleranceError(
        f"the derivative by {parameter} has an error of {worst:.1e} times the parameter, "
        f"above tol = {tol:g}; loosen tol",
        (value, error),
    )
