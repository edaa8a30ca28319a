"""Derivatives of solved crossing probabilities, by central differences of the orders 4 and 6.

The solver is accurate to many digits, so that differences of high order over a long step are, too.
What the order 6 changes is far above its error and is stated.
"""

import numpy as np

from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.errors import ToleranceError
from nonsmooth.sensitivity import tuning
from nonsmooth.sensitivity.questions import Question

_FOURTH = np.array([8, -1, 0]) / 12  # weights of f(x + k h) - f(x - k h), k = 1, 2, 3, over h
_SIXTH = np.array([45, -9, 1]) / 60


def logarithmic_derivative(
    question: Question, parameter: str, tol: float
) -> tuple[np.ndarray, np.ndarray]:
    """Differentiate W with respect to the logarithm of a parameter.

    Parameters
    ----------
    question : Question
    parameter : str
    tol : float
        Absolute error wanted.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
        The error is that of the difference and those of the solutions.

    Raises
    ------
    SceneError
        If the scene has no deterministic solver.
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    for step in tuning.DIFFERENCES.steps:
        accuracy = tol * step * tuning.DIFFERENCES.share
        solved = [
            [_solved(question.changed(parameter, side * k * step), accuracy) for side in (1, -1)]
            for k in (1, 2, 3)
        ]
        rise = np.array([above[0] - below[0] for above, below in solved]) / step
        inexact = np.array([above[1] + below[1] for above, below in solved]) / step
        value = _SIXTH @ rise
        error = np.abs(value - _FOURTH @ rise) + np.abs(_SIXTH) @ inexact
        if np.all(error <= tol):
            return value, error
    raise ToleranceError(
        f"the derivative by {parameter} has an error of {error.max():.1e} times the parameter, "
        f"above tol = {tol:g}; loosen tol",
        (value, error),
    )


def _solved(question, tol):
    try:
        found = deterministic_crossing(question.scene, *question.levels, question.times, tol)
    except ToleranceError as refused:  # its error is part of that of the derivative
        if refused.result is None:
            raise
        found = refused.result
    return found["probability"], found["probability_error"]
