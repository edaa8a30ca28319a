"""Derivatives of solved crossing probabilities, by central differences.

The solver is accurate to many digits, so that differences of high order over a long step are, too.
"""

import numpy as np

from nonsmooth.central_differences import central
from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.errors import ToleranceError
from nonsmooth.sensitivity import tuning
from nonsmooth.sensitivity.questions import Question, missed


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
        changed = [question.changed(parameter, k * step) for k in (-1, -2, -3, 1, 2, 3)]
        # levels of one scene are solved together
        groups = [changed] if parameter in ("threshold", "p") else [[one] for one in changed]
        solved = [_solved(group, accuracy) for group in groups]
        W, inexact = (np.concatenate(parts) for parts in zip(*solved, strict=True))
        value, error = central(W[:3], W[3:], inexact[:3] + inexact[3:], step)
        if np.all(error <= tol):
            return value, error
    raise missed(parameter, tol, value, error)


def _solved(questions, tol):
    """Probabilities and errors of questions of one scene."""
    levels = np.array([question.levels for question in questions])
    times = np.unique([question.times for question in questions])
    try:
        found = deterministic_crossing(questions[0].scene, levels, times, tol)
    except ToleranceError as refused:  # its error is part of that of the derivative
        if refused.result is None:
            raise
        found = refused.result
    own = np.array([np.searchsorted(times, question.times) for question in questions])
    probability, error = (found[name] for name in ("probability", "probability_error"))
    return np.take_along_axis(probability, own, 1), np.take_along_axis(error, own, 1)
