"""Whether a method agrees with the reference beside it, and is accurate enough to tell."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri

from reproduction.errors import CheckError

FALSE_ALARM = 1e-6  # probability that a check fails although nothing is wrong
TELLING = 0.1  # a bound above this part of the largest value says nothing of use


def standard_errors(count: int) -> float:
    """Return how many standard errors a number may be off.

    By Bonferroni's inequality, chance makes any of `count` numbers with normal errors, which may
    depend on each other, differ by more with the probability `FALSE_ALARM` at most.
    """
    return -ndtri(FALSE_ALARM / 2 / count)


def deviation(
    name: str,
    places: Sequence[str],
    value: ArrayLike,
    reference: ArrayLike,
    allowed: ArrayLike,
    cure: str,
) -> np.ndarray:
    """Compare values with those of a reference, in units of what is allowed.

    Parameters
    ----------
    name : str
        Of the method.
    places : sequence of str
        What each value belongs to, as in "tau = 1".
    value, reference, allowed : array_like, one for each place
    cure : str
        What to do where they disagree.

    Returns
    -------
    numpy.ndarray
        At most 1.

    Raises
    ------
    CheckError
        If a value is further from the reference than allowed, or not a number.
    """
    ratio = np.abs(np.asarray(value) - reference) / allowed
    worst = int(np.argmax(ratio))  # that of nan, if there is one
    if not ratio[worst] <= 1:
        raise CheckError(
            f"{name} deviates from the reference by {ratio[worst]:.2f} times its allowed error at "
            f"{places[worst]}; {cure}"
        )
    return ratio


def require_telling(name: str, error: ArrayLike, value: ArrayLike, cure: str) -> None:
    """Refuse errors that are no longer small against the values.

    Parameters
    ----------
    name : str
        Of the method.
    error, value : array_like
    cure : str

    Raises
    ------
    CheckError
    """
    share = np.max(error) / np.max(np.abs(value))
    if not share <= TELLING:
        raise CheckError(
            f"the stated error of {name} is {share:.0%} of its largest value, above {TELLING:.0%}; "
            f"{cure}"
        )
