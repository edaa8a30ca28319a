"""Derivatives of crossing probabilities by paths that share their noise.

Two questions whose parameters differ a little are asked of paths with the same random numbers: few
of them answer differently, so that the difference of both probabilities has a small spread. What
doubling the difference changes tells its bias, and what doubling the time step changes that of the
step.
"""

import numpy as np

from nonsmooth.crossing import tuning as crossing_tuning
from nonsmooth.paths.absorption.passages import coupled_passages
from nonsmooth.paths.kernels.random_numbers import BLOCK, labelled
from nonsmooth.paths.moments import fine_bias_over_change
from nonsmooth.paths.resolution import first_step, paths_for, refined_step, require_possible
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.sensitivity import tuning
from nonsmooth.sensitivity.questions import Question, missed


def logarithmic_derivative(
    question: Question, parameter: str, tol: float, seed: int | tuple, threads: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """Estimate the derivative of W with respect to the logarithm of a parameter.

    Parameters
    ----------
    question : Question
    parameter : str
    tol : float
        It bounds three standard errors, and the biases.
    seed, threads
        As for `crossing_probability`.

    Returns
    -------
    value, error : numpy.ndarray, shape (k,)
        The error is the biases and the standard error together.

    Raises
    ------
    ToleranceError
        If `tol` is not met; the best is its `result`.
    """
    step, paths = first_step(question.scene, question.times), MONTE_CARLO.pilot_paths
    order = registry.scheme(question.scene).weak_order(question.scene)
    apart: float = tuning.COMMON_NOISE.apart
    own: int | tuple = labelled(seed, "pilot")
    aim = tuning.COMMON_NOISE.aim * tol
    share = MONTE_CARLO.spread_share * aim
    for _ in range(crossing_tuning.COUNTING.attempts + 1):
        found = _sample(question, parameter, apart, Sampling(step, paths, own, threads=threads))
        value, spread, biases, unsure = found
        error = np.abs(biases).sum(axis=0) + np.hypot(spread, unsure)
        bound = np.abs(biases).sum(axis=0) + MONTE_CARLO.sigmas * spread
        if np.all(bound <= tol):
            return value, error
        by_step, by_difference = np.max(np.abs(biases), axis=1)
        step = refined_step(step, max(2 * by_step, 1e-300), tol - share, order)
        nearer = apart * min(1.0, np.sqrt((tol - share) / max(2 * by_difference, 1e-300)))
        nearer = max(nearer, tuning.COMMON_NOISE.nearest)
        # of nearer questions fewer paths answer differently: the variance grows like 1 / apart
        wanted = paths_for(np.max(spread) * np.sqrt(paths * apart / nearer), aim)
        paths = BLOCK * -(-max(wanted, paths) // BLOCK)
        apart, own = nearer, seed
        told = f"the derivative by {parameter} has an error of {np.max(bound):.1e}"
        steps = 6 * question.times[-1] / step
        require_possible(paths, steps, told, tol, result=(value, error))
    raise missed(parameter, tol, value, error, bound)


def _sample(question, parameter, apart, sampling):
    """Return value, standard error, the biases by step and difference, and their standard error."""
    near, wide = (_difference(question, parameter, k * apart, sampling) for k in (1, 2))
    order = registry.scheme(question.scene).weak_order(question.scene)
    (fine, coarse), (fine_wide, _) = near, wide
    by_step = fine_bias_over_change(order) * (coarse - fine)
    by_difference = (fine_wide - fine) / 3  # the bias of a central difference is of the order 2
    count = sampling.paths

    def error(sample):
        return np.sqrt(np.maximum(sample.var(axis=1), 1 / (count * apart**2)) / count)

    biases = np.array([by_step.mean(axis=1), by_difference.mean(axis=1)])
    unsure = np.hypot(error(by_step), error(by_difference))
    return fine.mean(axis=1), error(fine), biases, unsure


def _difference(question, parameter, apart, sampling):
    """Central difference of the outcomes of each path, with a step and with twice the step."""
    outcome = []
    for side in (1, -1):
        other = question.changed(parameter, side * apart)
        # the number of steps must not depend on p
        step = 2 * sampling.step * other.times[-1] / question.times[-1]
        own = Sampling(step, sampling.paths, sampling.seed, threads=sampling.threads)
        passage = coupled_passages(other.scene, other.times, own, other.levels, question.scene)
        outcome.append([own[None, :] <= other.times[:, None] for own in passage])
    return [
        (above.astype(float) - below) / (2 * apart) for above, below in zip(*outcome, strict=True)
    ]
