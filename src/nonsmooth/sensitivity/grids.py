"""Derivatives of gamma^2 with two to four state variables, by the differentiated equations.

gamma^2 = 2 E[(g - E g) u] with -A u = g - E g. Let A' and g' be the derivatives of the generator
and of g, -A h = 2 (g - E g) u - gamma^2, and -A v = A' u + g' - E[...]. As E[A f] = 0 for every f,
the derivative of the mean of f is E[A' w], w the Poisson solution of f. Hence

    (gamma^2)' = E[A' h + 2 (g - E g) v + 2 (g' - (E g)') u],  (E g)' = E[A' u + g'].

On a grid this is the derivative of the gamma^2 of that grid.
"""

import numpy as np

from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.grids import uniform_refinement
from nonsmooth.grids.generator import assemble, evaluate
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.grids.tensor_grid import Grid, depth_for, fitted, solver
from nonsmooth.scenes.scene import Scene
from nonsmooth.sensitivity import tuning
from nonsmooth.sensitivity.parameters import change, derivative, value_of
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.combined_grids import combined


def slope(scene: Scene, parameter: str, tol: float) -> tuple[float, float, float]:
    """Return the derivative of gamma^2 with respect to the logarithm of a parameter.

    Parameters
    ----------
    scene : Scene
        With two to four state variables.
    parameter : str
    tol : float
        Error wanted, relative to gamma^2.

    Returns
    -------
    value, error : float
        The error is that of `uniform_refinement.refined`, at least that of gamma^2 there, or that
        of `combined`. It may be above `tol`.
    gamma2 : float
        Only as exact as a tolerance has to be.
    """
    if uniform_refinement.applies(scene):

        def solve(grid):
            found = with_gamma2(scene, parameter, grid, tol)
            return found, tuning.GRIDS.rounding * abs(found[1])

        def share(error, value):
            # the derivative may agree on several grids by chance, but hardly gamma^2, too
            return np.max(error) / (tol * value[1]) if value[1] > 0 else np.inf

        found = uniform_refinement.refined(fitted(scene, depth_for(tol), 1), solve, share)
        if found.met:
            return float(found.value[0]), float(np.max(found.error)), float(found.value[1])
    gamma2 = _roughly(scene)

    def on(scene, grid):
        return lambda accuracy: float(with_gamma2(scene, parameter, grid, accuracy)[0])

    rest = combined(
        scene,
        tol,
        on,
        lambda value, tol: tol * gamma2,
    )
    return rest.value, rest.error, gamma2


def _roughly(scene):
    """Return gamma^2, to have a measure of its derivative."""
    try:
        found = asymptotic_variance(scene, tuning.GRIDS.roughly, "deterministic")
    except ToleranceError as refused:  # a derivative, if it is found, is exact all the same
        found = refused.result
    if not isinstance(found, Estimate) or not found.value > 0:
        raise ToleranceError(
            "gamma^2 is not found to a tenth, to which a tolerance of its derivative is relative; "
            "use a smaller n or a damping closer to 1"
        )
    return found.value


def with_gamma2(scene: Scene, parameter: str, grid: Grid, accuracy: float) -> np.ndarray:
    """Compute the derivative of gamma^2 on one grid, by the logarithm of a parameter, and gamma^2.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    parameter : str
    grid : Grid
    accuracy : float
        Residual of the Poisson solver.

    Returns
    -------
    numpy.ndarray, shape (2,)
    """
    axes, solve = solver(scene, grid)
    generator = assemble(scene, axes, change=change(scene, parameter))

    def changed(f, parity):
        return solve.fold(generator @ solve.unfold(f, parity))

    g = solve.fold(evaluate(scene.numerical_observable(), axes))
    own = evaluate(derivative(scene, scene.observable_expression, parameter), axes)
    u, mean = solve.solve(g, ODD, accuracy)
    g = g - mean
    h, half = solve.solve(g * u, EVEN, accuracy)
    own = solve.fold(own)
    v, mean = solve.solve(changed(u, ODD) + own, ODD, accuracy)
    _, rate = solve.solve(changed(h, EVEN) + g * v + (own - mean) * u, EVEN, accuracy)
    return 2 * np.array([value_of(scene, parameter) * rate, half])
