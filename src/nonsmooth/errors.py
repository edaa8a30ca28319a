"""The errors a user can cause: each message is one line that says what is wrong and what helps.

A method that misses a tolerance raises a `ToleranceError` with what it has reached as `result`, in
the form in which it returns what meets it. Public functions hand both through `answered`.
"""

import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any, TypeVar

from threadpoolctl import ThreadpoolController

Found = TypeVar("Found")
Answer = TypeVar("Answer")


class NonsmoothError(Exception):
    """Base of every error whose message is meant for the user and needs no traceback."""


class ExpressionError(NonsmoothError):
    """A potential, Hamiltonian or observable that cannot be read."""


class SceneError(NonsmoothError):
    """A scene that is impossible, or outside the theory or the method asked for."""


class AssumptionWarning(UserWarning):
    """A scene that can be computed but that the paper's theorems do not cover."""


class ToleranceError(NonsmoothError):
    """A tolerance that the method could not meet.

    Attributes
    ----------
    result : object
        The best that was reached, with its own error: what the function would have returned. None
        if nothing is known.
    """

    def __init__(self, message: str, result: object = None):
        super().__init__(message)
        self.result = result


class AccuracyWarning(UserWarning, NonsmoothError):
    """A result that is less accurate than its method aims at, where no `tol` was asked for.

    Where warnings are made errors, it is one that is told in one line.
    """


def answered(
    solve: Callable[[], Found], present: Callable[[Found], Answer], tol_given: bool = True
) -> Answer:
    """Solve and present what is found, also if it misses the tolerance.

    Meanwhile dense linear algebra has one thread. Its threads wait actively for each other, which
    takes many times as long where something else runs, and their number changes the last digits.

    Parameters
    ----------
    solve : callable
        Without arguments; returns what is found, or raises a `ToleranceError`.
    present : callable
        Turns what is found, or the `result` of the error, into the answer.
    tol_given : bool
        Whether somebody asked for the tolerance. If so, the error is raised again, with the answer
        as its `result`; otherwise the answer is returned with a warning.

    Returns
    -------
    object
        What `present` returns.

    Raises
    ------
    ToleranceError
        If the tolerance was asked for, or nothing is known, or the memory is too small.
    """
    try:
        with _threads().limit(limits=1, user_api="blas"):
            return present(solve())
    except MemoryError:
        raise ToleranceError(
            "the memory does not hold what this takes; choose fewer paths or times or a larger "
            "tol, or free memory"
        ) from None
    except ToleranceError as refused:
        if refused.result is None:
            raise
        message, answer = str(refused), present(refused.result)  # type: ignore[arg-type]
    if tol_given:
        raise ToleranceError(message, answer)
    warnings.warn(
        f"{message}; it is returned, because no tol was given", AccuracyWarning, stacklevel=3
    )
    return answer


@cache
def _threads():
    """Return what sets the number of threads: the search for libraries takes milliseconds."""
    # it has a library of its own
    import scipy.linalg  # noqa: F401

    return ThreadpoolController()


@contextmanager
def of_another_quantity() -> Iterator[None]:
    """Within, drop the `result` of a `ToleranceError`: it is not what the caller computes."""
    try:
        yield
    except ToleranceError as refused:
        raise ToleranceError(str(refused)) from None


def first_answer(
    attempts: Iterable[Callable[[], Found]],
    error: Callable[[Any], float],
    good_enough: Callable[[Any], bool] = lambda found: False,
) -> Found:
    """Try one way after another until one meets its tolerance.

    Parameters
    ----------
    attempts : iterable of callable
        As `solve` of `answered`.
    error : callable
        Takes what is found; returns the size of its error, by which results are compared.
    good_enough : callable
        Takes what is found, too; returns whether no other way is to be tried after this one.

    Returns
    -------
    object
        What the first successful attempt returns.

    Raises
    ------
    ToleranceError
        The one of the attempt that has the smallest error.
    """
    best, least = None, float("inf")
    for attempt in attempts:
        try:
            return attempt()
        except ToleranceError as refused:
            reached = float("inf") if refused.result is None else error(refused.result)
            if best is None or reached < least:
                best, least = refused, reached
            if refused.result is not None and good_enough(refused.result):
                break
    assert best is not None  # there is at least one attempt
    raise best


def quoted(value: object, length: int = 80) -> str:
    """Quote what a user gave, for a message of one line.

    Parameters
    ----------
    value : object
        Text, whose white space becomes single blanks, or anything else, which is shown as `repr`
        shows it.
    length : int
        Most characters; what is longer is cut and ends with dots.

    Returns
    -------
    str
        In ASCII: other characters are escaped, so that look-alikes are told apart and every
        terminal can show them.
    """
    try:
        text = ascii(" ".join(value.split()) if isinstance(value, str) else value)
    except Exception:  # an object may fail in any way when it is asked for its repr
        text = object.__repr__(value)
    text = " ".join(text.split())
    end = text[-1] if isinstance(value, str) else ""
    return text if len(text) <= length else f"{text[: length - 3 - len(end)]}...{end}"
