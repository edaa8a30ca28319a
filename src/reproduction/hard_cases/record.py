"""A case, its outcome, and how the outcome is judged."""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass

from nonsmooth.errors import AccuracyWarning, AssumptionWarning, NonsmoothError

DEVIATIONS = 5.0  # standard errors; a sampled result is farther off with a probability of 6e-7

MET, REFUSED, WARNED, WRONG = "met", "refused", "warned", "WRONG"


@dataclass(frozen=True)
class Result:
    """A value and the error that is stated with it.

    Attributes
    ----------
    value, error : float
        Of a sampled value the error is the bias of the step, enlarged as if the weak order were
        half an order lower, plus `DEVIATIONS` standard errors.
    """

    value: float
    error: float


@dataclass(frozen=True)
class Case:
    """One method in one hard case.

    Attributes
    ----------
    title, method : str
        LaTeX, and the function called.
    evaluate : callable
        Takes the number of paths, which only Monte Carlo uses, and returns a `Result`.
    reference : callable or None
        Returns an independent `Result`; None where only a refusal or a warning is right.
    """

    title: str
    method: str
    evaluate: Callable[[int | None], Result]
    reference: Callable[[], Result] | None


@dataclass(frozen=True)
class Outcome:
    """The outcome of a case.

    Attributes
    ----------
    verdict : {"met", "refused", "warned", "WRONG"}
        "met" if the value is within its stated error; "refused" if there is a message instead of a
        value; "warned" if there is a warning, and the value is within its stated error where a
        reference is known; "WRONG" in any other case.
    value, error, reference, deviation : float
        Of the result, and its distance to the reference; not a number where there is none.
    message : str
        The error or the warning.
    """

    verdict: str
    value: float = math.nan
    error: float = math.nan
    reference: float = math.nan
    deviation: float = math.nan
    message: str = ""


def examine(case: Case, paths: int) -> Outcome:
    """Run a case and judge it.

    Parameters
    ----------
    case : Case
    paths : int
        Number of paths of Monte Carlo.

    Returns
    -------
    Outcome
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", AssumptionWarning)
        warnings.simplefilter("error", AccuracyWarning)  # what misses its accuracy is refused
        try:
            found = case.evaluate(paths)
        except NonsmoothError as refusal:
            return Outcome(REFUSED, message=str(refusal))
        said = " ".join(dict.fromkeys(str(warning.message) for warning in caught))
        reference = case.reference() if case.reference else None
    value, error = float(found.value), float(found.error)
    finite = math.isfinite(value) and math.isfinite(error)
    if reference is None:
        return Outcome(WARNED if said and finite else WRONG, value, error, message=said)
    deviation = abs(value - reference.value)
    right = finite and deviation <= error + reference.error
    verdict = (WARNED if said else MET) if right else WRONG
    return Outcome(verdict, value, error, float(reference.value), deviation, said)
