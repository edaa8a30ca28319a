"""gamma^2, mean and invariant density of a scene with one state variable.

They are integrals, see `poisson_integrals`, summed over Gauss-Legendre elements without any linear
algebra. Elements have their edges on the kinks of the drift and of g and are halved until g m is a
polynomial on each of them to within rounding. All elements are then halved once more: the
difference of the two solutions and an analysis of rounding give the error.
"""

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import SceneError, quoted
from nonsmooth.estimate import require
from nonsmooth.line import tuning
from nonsmooth.line.integrands import Integrands
from nonsmooth.line.poisson_integrals import (
    PoissonIntegrals,
    exponential_rounding,
    formula_error,
    integrate,
)
from nonsmooth.scenes.scene import Scene

_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Solution:
    """The finer of two solutions, and its errors.

    Attributes
    ----------
    integrands : Integrands
    integrals : PoissonIntegrals
    gamma2_error, mean_error : float
        Absolute.
    density_error : float
        Relative error of the normalising constant.
    """

    integrands: Integrands
    integrals: PoissonIntegrals
    gamma2_error: float
    mean_error: float
    density_error: float


def asymptotic_variance(scene: Scene, tol: float = 1e-10) -> tuple[float, float]:
    """Return gamma_g^2, the limit of Var(int_0^t g) / t (Theorem 6 of the paper).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    tol : float
        Requested relative error, "1".

    Returns
    -------
    value, error : float
        The error is the difference of two solutions, the second on elements half as wide, plus
        the rounding error to first order. That of the formula of g is measured against an
        evaluation to 40 digits; those of the exponentials and of the sums are estimated. Neither
        solution sees a feature of g that is narrower than the distance of its points, unless it
        lies where the argument of an absolute value, maximum, logarithm, ... changes its sign.

    Raises
    ------
    SceneError
        If the scene has another state or noise, g is not finite, or not square-integrable.
    ToleranceError
        If `tol` cannot be met; the message has the best value and its error.
    """
    solution = solved(scene)
    value, error = float(solution.integrals.gamma2), float(solution.gamma2_error)
    require(error <= tol * value, value, error, tol)
    return value, error


def mean(scene: Scene) -> tuple[float, float]:
    """Return the mean of the observable under the invariant density.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.

    Returns
    -------
    value, error : float

    Raises
    ------
    SceneError
        As for `asymptotic_variance`.
    """
    solution = solved(scene)
    value = solution.integrands.constant + solution.integrals.mean
    return float(value), float(solution.mean_error)


def density(scene: Scene, y: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Return the invariant density m of the state (section 5 of the paper).

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    y : array_like
        "1".

    Returns
    -------
    value, error : numpy.ndarray, shape of `y`

    Raises
    ------
    SceneError
        As for `asymptotic_variance`.
    """
    solution = solved(scene)
    depth = solution.integrands.depth(np.asarray(y, dtype=float))
    value = np.exp(-depth) / solution.integrals.total
    return value, value * (exponential_rounding(depth) + solution.density_error)


@functools.lru_cache(maxsize=64)
def solved(scene: Scene) -> Solution:
    """Integrate on elements that resolve g m, and on their halves, and compare.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.

    Returns
    -------
    Solution

    Raises
    ------
    SceneError
        As for `asymptotic_variance`.
    """
    integrands, sigma = Integrands.of(scene), scene.noise.sigma
    coarse, rough, elements = _resolved(integrands, sigma)
    fine = integrate(integrands.halved(elements, np.full(len(elements.left), True)), sigma)
    if not fine.tail <= _EPS * fine.gamma2:
        raise SceneError(
            f"g = {quoted(scene.observable)} is not square-integrable, so that gamma^2 may be "
            "infinite; choose one that grows less"
        )
    formula = formula_error(integrands.varying, fine)
    mass = fine.elements.mass / fine.total
    exponential = exponential_rounding(fine.elements.depth)
    spread = np.abs(fine.elements.g - fine.mean)
    return Solution(
        integrands,
        fine,
        abs(fine.gamma2 - coarse.gamma2)
        + np.sum(coarse.misfit[rough])
        + fine.tail
        + fine.rounding
        + np.sum(fine.influence * formula),
        abs(fine.mean - coarse.mean)
        + np.sum(coarse.missed[rough])
        + np.sum(mass * (exponential * spread + formula))
        + _EPS * (abs(integrands.constant) + abs(fine.mean)),
        abs(fine.total / coarse.total - 1) + np.sum(mass * exponential),
    )


def _resolved(integrands, sigma):
    """Halve elements until none adds to the error, or what is left is rounding of g.

    Returns the last integrals, which of their elements are not resolved, and the last elements.
    """
    settings = tuning.QUADRATURE
    elements = integrands.first_elements()
    for _ in range(settings.rounds):
        found = integrate(elements, sigma)
        rough = found.misfit > settings.resolved * found.gamma2
        # where rounding of g is all that is left, halving does not help
        size = np.sum(elements.mass * np.abs(elements.g), 1)
        hopeful = rough & (found.missed > settings.noise * _EPS * size)
        if not hopeful.any() or len(hopeful) > settings.most_elements:
            break
        elements = integrands.halved(elements, hopeful)
    return found, rough, elements
