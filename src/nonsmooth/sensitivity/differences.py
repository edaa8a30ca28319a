"""Derivatives of solved crossing probabilities, by central differences.

The solver is accurate to many digits, so that differences of high order over a long step are, too.
"""

import numpy as np

from nonsmooth.central_differences import central
from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.errors import ToleranceError
from nonsmooth.sensitivity import tuning
from nonsmooth.sensitivity.questions import Question


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
        below, above = (
            [_solved(question.changed(parameter, side * k * step), accuracy) for k in (1, 2, 3)]
            for side in (-1, 1)
        )
        (low, low_error), (high, high_error) = (
            np.moveaxis(np.array(side), 1, 0) for side in (below, above)
        )
        value, error = central(low, high, low_error + high_error, step)
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
