"""Checks of arguments: what public functions accept, and what they say about anything else.

Each function takes the name of an argument and its value. It returns the value in its usual form,
or raises a SceneError of one line, "X is Y; do Z".

A number is an int, a float, a fraction, a decimal, a numpy scalar or an array without dimensions;
texts, booleans and complex numbers are none. A count is a whole number, also as a float (1e6
paths). Several numbers are a list, a tuple, a range or any array, and one number stands for a list
of one.
"""

import difflib
import math
from collections.abc import Iterable, Mapping
from decimal import Decimal
from numbers import Real
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import SceneError, quoted

MOST_THREADS = 1024  # more than any machine has cores; each takes memory of the system
# Numbers between them are in single precision, in which paths are simulated, and products of
# several are in double precision.
SMALLEST, LARGEST = 1e-30, 1e30
# In units in which the mass, the slip force and the yield limit are 1, parameters of a scene are
# seldom far from 1. Beyond these limits the square of a part of the equations is lost in rounding.
PARAMETERS = 1e-9, 1e9
# the limits n -> 0 and n -> inf, up to rounding
PENALIZATIONS = 1e-15, 1e15
LONGEST = 5_000  # longest list of times, thresholds or probabilities; more take memory and minutes
NO_OTHERS: Mapping[str, str] = {}


def _refuse(name: str, value: object, cure: str) -> NoReturn:
    raise SceneError(f"{name} is {quoted(value)}; {cure}")


def as_number(value: Any) -> float | None:
    """Convert to float what is a number; None stands for what is not."""
    if isinstance(value, np.ma.MaskedArray):
        return None
    if getattr(value, "ndim", None) == 0 and hasattr(value, "dtype"):
        value = value.item() if value.dtype.kind in "iufO" else None
    if not isinstance(value, Real | Decimal) or isinstance(value, bool):
        return None
    try:
        return float(value)
    except (OverflowError, ValueError):  # beyond double precision, a signalling NaN
        return None


def require_number(name: str, value: Any, most: float = LARGEST) -> float:
    """Return a number of at most a certain size, as a float."""
    number = as_number(value)
    if number is None or not math.isfinite(number):
        _refuse(name, value, "give a finite number")
    if abs(number) > most:
        _refuse(name, value, f"give a number from {-most:g} to {most:g}")
    return number


def require_positive(
    name: str, value: Any, least: float = SMALLEST, most: float = LARGEST
) -> float:
    """Return a number that is positive and within limits, as a float."""
    number = as_number(value)
    if number is None or not 0 < number < math.inf:
        _refuse(name, value, "give a positive finite number")
    if not least <= number <= most:
        _refuse(name, value, f"give a number from {least:g} to {most:g}")
    return number


def require_parameter(name: str, value: Any) -> float:
    """Return a parameter of a scene, such as its damping, as a float."""
    return require_positive(name, value, *PARAMETERS)


def require_tolerance(value: Any) -> float:
    """Return a tolerance as a float."""
    return require_positive("tol", value)


def require_count(name: str, value: Any, most: float = math.inf) -> int:
    """Return a positive whole number as an int."""
    number = as_number(value)
    if number is None or not (number >= 1 and number.is_integer()):
        _refuse(name, value, "give a positive whole number")
    if number > most:
        _refuse(name, value, f"give at most {most:g}")
    return int(number)


def require_threads(value: Any) -> int | None:
    """Return a number of threads, or None, which stands for all cores."""
    return None if value is None else require_count("threads", value, MOST_THREADS)


def require_seed(value: Any) -> int | tuple:
    """Return a seed: a whole number >= 0 or a tuple of one and of labels.

    A float is no seed, because it does not hold large ones.
    """
    entropy, *labels = value if isinstance(value, tuple) and value else (value,)
    whole = isinstance(entropy, int | np.integer) and not isinstance(entropy, bool | np.timedelta64)
    if not (whole and entropy >= 0):
        _refuse("seed", value, "give a whole number >= 0, or a tuple of one and of labels")
    if not all(isinstance(label, str | int | float) for label in labels):
        _refuse("seed", value, "label it by texts and numbers")
    return (int(entropy), *labels) if labels else int(entropy)


def require_choice(
    name: str, value: Any, choices: Iterable[str], meant: Mapping[str, str] = NO_OTHERS
) -> str:
    """Return one of some names; the message has the one that is `meant` by another, or near."""
    known = list(choices)
    if not isinstance(value, str) or value not in known:
        word = value.lower() if isinstance(value, str) else ""
        near = [meant[word]] if meant.get(word) in known else []
        near += difflib.get_close_matches(word, known, n=1)
        _refuse(
            name, value, f"did you mean {near[0]!r}?" if near else f"choose from {', '.join(known)}"
        )
    return str(value)


def require_numbers(
    name: str, values: Any, least: float = SMALLEST, most: float = LARGEST
) -> np.ndarray:
    """Return numbers as an array of floats of the same shape; some may be 0 or infinite."""
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        _refuse(name, values, "fill in what is masked")
    try:
        found = np.asarray(values)
    except (ValueError, TypeError):  # a ragged list, a dataset
        _refuse(name, values, "give numbers in a list or an array")
    if found.dtype.kind == "O":
        numbers = [as_number(value) for value in found.ravel()]
        if None not in numbers:
            found = np.array(numbers, dtype=float).reshape(found.shape)
    if found.dtype.kind not in "iuf":
        _refuse(name, values, "give numbers in a list or an array")
    with np.errstate(over="ignore"):
        found = found.astype(float)
    if np.any(np.isnan(found)):
        _refuse(name, values, "remove what is not a number")
    size = np.abs(found)
    if not np.all((size == 0) | (size == np.inf) | ((size >= least) & (size <= most))):
        _refuse(name, values, f"give numbers of sizes from {least:g} to {most:g}")
    return found


def require_list(name: str, values: Any) -> np.ndarray:
    """Return one finite number or several as an array of one dimension."""
    found = require_numbers(name, values)
    if found.ndim > 1 or found.size == 0:
        _refuse(name, values, "give one number or a list of them")
    if found.size > LONGEST:
        raise SceneError(f"{name} has {found.size} numbers; give at most {LONGEST}")
    if not np.all(np.isfinite(found)):
        _refuse(name, values, "give finite numbers")
    return np.atleast_1d(found)


def require_increasing(name: str, values: ArrayLike) -> np.ndarray:
    """Return positive, finite and increasing numbers as an array of one dimension."""
    found = require_list(name, values)
    if not (found[0] > 0 and np.all(np.diff(found) > 0)):
        _refuse(name, values, "give positive numbers that increase")
    return found
