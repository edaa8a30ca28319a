"""Derivatives of gamma^2 with one state variable.

With Phi = -log m, a = sigma^2 / 2 and the Poisson solution u of mean 0, gamma^2 is the largest
value of 4 E[(g - E g) u] - 2 a E[u'^2] over all u. The derivative of a largest value is that of the
expression at a fixed u:

    d gamma^2 = 4 E[dg u] - E[(dPhi - E dPhi) (4 (g - E g) u - 2 a u'^2)] - 2 da E[u'^2].

It is exact also on elements, where u is the largest among piecewise polynomials.
"""

import numpy as np

from nonsmooth.line import spectral_elements
from nonsmooth.line.potential import depth
from nonsmooth.refine import until_agreement
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import y
from nonsmooth.sensitivity import tuning
from nonsmooth.sensitivity.parameters import change_of_depth, derivative, value_of


def slope(scene: Scene, parameter: str, tol: float) -> tuple[float, float, float]:
    """Return the derivative of gamma^2 with respect to the logarithm of a parameter.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    parameter : str
    tol : float
        Error wanted, relative to gamma^2.

    Returns
    -------
    value, error : float
        The error is what raising the degree of the elements changes, gamma^2 included, and
        rounding. It may be above `tol`.
    gamma2 : float
    """
    settings, scene = tuning.LINE, scene.with_start({})
    value = value_of(scene, parameter)

    def error(found):
        (coarse, before), (gamma2, last) = found[-2:]
        # the derivative may agree for two degrees by chance, but hardly gamma^2, too
        change = max(value * abs(last - before), abs(gamma2 - coarse))
        return settings.safety * change + settings.rounding * gamma2

    found = until_agreement(
        settings.degrees,
        lambda degree: _gamma2_and_derivative(scene, parameter, degree),
        error,
        lambda solution, error: error <= tol * solution[0],
    )
    gamma2, last = found.value
    return value * last, found.error, gamma2


def _gamma2_and_derivative(scene, parameter, degree):
    """Both on elements of one degree."""
    sigma = scene.noise.sigma
    elements = spectral_elements.weighted(spectral_elements.mesh(scene), depth(scene), degree)
    at, weight = elements.points, elements.weights
    place = np.arange(len(at))[:, None] * degree + np.arange(degree + 1)
    g = vectorised(scene.numerical_observable(), (y,))(at)
    total = weight.sum()
    g = g - np.sum(weight * g) / total
    stiffness = sigma**2 / 2 * elements.energies()
    right = np.zeros(len(stiffness))
    np.add.at(right, place, weight * g @ elements.values)
    u = _solution(stiffness, right)[place]
    slope = u @ elements.slopes.T / elements.half[:, None]
    u = u @ elements.values.T
    u = u - np.sum(weight * u) / total

    def mean(f):
        return np.sum(weight * f) / total

    bend = change_of_depth(scene, parameter)(at)
    own = vectorised(derivative(scene, scene.observable_expression, parameter), (y,))(at)
    spread = 4 * g * u - sigma**2 * slope**2
    change = 4 * mean(own * u) - mean((bend - mean(bend)) * spread)
    if parameter == "sigma":
        change -= 2 * sigma * mean(slope**2)
    return 2 * mean(g * u), change


def _solution(stiffness, right):
    """Solve a balanced system in which the value at the middle is 0."""
    middle = len(stiffness) // 2
    free = np.delete(np.arange(len(stiffness)), middle)
    scale = 1 / np.sqrt(np.diag(stiffness)[free])
    matrix = stiffness[np.ix_(free, free)] * np.outer(scale, scale)
    found = np.zeros(len(stiffness))
    found[free] = scale * np.linalg.solve(matrix, scale * right[free])
    return found
