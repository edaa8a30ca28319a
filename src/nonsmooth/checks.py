"""Checks of arguments that several functions share."""

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import SceneError


def require_increasing(name: str, values: ArrayLike) -> None:
    """Raise a SceneError unless the values are positive, finite and increasing."""
    values = np.asarray(values, dtype=float)
    if values.ndim != 1 or not (
        values.size and values[0] > 0 and np.all(np.diff(values) > 0) and np.isfinite(values[-1])
    ):
        raise SceneError(f"the {name} must be positive and increase; sort them")


def require_count(name: str, value: object) -> None:
    """Raise a SceneError unless the value is a positive whole number."""
    if not (isinstance(value, int | np.integer) and value > 0):
        raise SceneError(
            f"the simulation needs {name} > 0, a whole number, got {value!r}; choose one"
        )


def require_positive(name: str, value: float) -> None:
    """Raise a SceneError unless the value is a positive finite number."""
    if not 0 < value < np.inf:
        raise SceneError(f"the simulation needs {name} > 0, got {value}; choose a positive number")
