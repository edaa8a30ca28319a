"""The stationary mean E g of an observable, without Monte Carlo where it can.

It is 0 by symmetry if g and the drift are odd, and if g is the derivative of a function of the
state along paths. Elsewhere g is integrated over the invariant measure: that of the velocity alone
by quadrature, any other as discretised on tensor grids.
"""

import math
import time
from collections.abc import Callable
from functools import partial

import numpy as np

from nonsmooth.checks import require_choice, require_seed, require_threads, require_tolerance
from nonsmooth.errors import ToleranceError, answered, first_answer
from nonsmooth.estimate import Estimate
from nonsmooth.grids import uniform_refinement
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.mesh import box
from nonsmooth.grids.tensor_grid import Grid, depth_for, fitted, invariant_measure
from nonsmooth.line import quadrature
from nonsmooth.scenes.scene import Scene, require_scene, require_velocity
from nonsmooth.statistics import tuning
from nonsmooth.statistics.combined_grids import combined
from nonsmooth.statistics.sampled_gamma2 import sampled_mean


def mean(
    scene: Scene,
    tol: float | None = None,
    method: str | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
) -> Estimate:
    """Stationary mean E g of the observable, the rate at which int_0^t g drifts.

    Limit theorems and formulas for crossing probabilities are about a g of mean 0.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Absolute error wanted, in units of g. Unless given, it is 1e-6, 1e-3 or 1e-2 times the root
        mean square of g for two to four state variables; what misses this is returned with a
        warning. By Monte Carlo any error is returned unless it is given.
    method : {"deterministic", "monte_carlo"}, optional
        ``"deterministic"`` unless given; ``"monte_carlo"`` for a g of the noise alone, and where
        the other fails.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.

    Returns
    -------
    Estimate
        Exactly 0 by symmetry, or if g is the derivative of a function of the state along paths.
        For the state y with white noise the error is that of the quadrature, else that of the
        grids. By Monte Carlo it is the bias of the time step, what has not settled, and the
        standard error together; `tol` bounds the former two and three standard errors.

    Raises
    ------
    SceneError
        If an argument is out of range, there is no such method, or the solvers do not take g.
    ToleranceError
        If `tol` cannot be met; the best value is its `result`.
    """
    began = time.perf_counter()
    require_scene(scene)
    tol = None if tol is None else require_tolerance(tol)
    method = None if method is None else require_choice("method", method, METHODS)
    seed, threads = require_seed(seed), require_threads(threads)
    known = method != "monte_carlo" or not scene.state  # a constant g is not sampled
    if known and (exact := exact_mean(scene)) is not None:
        return exact
    ways = [method] if method else list(METHODS)
    if method is None and not box.suits(scene):
        ways = ["monte_carlo"]

    def present(found):
        value, error, solver = found
        return Estimate(float(value), float(error), solver, time.perf_counter() - began)

    return answered(
        lambda: first_answer(
            (partial(METHODS[way], scene, tol, seed, threads) for way in ways),
            error=lambda found: found[1],
            # what solvers have reached by default is not worse than a sample
            good_enough=lambda found: tol is None,
        ),
        present,
        tol_given=tol is not None,
    )


def exact_mean(scene: Scene) -> Estimate | None:
    """Return E g where it is known without grids and without Monte Carlo, else None.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Estimate or None
    """
    began = time.perf_counter()
    if not scene.state:
        return Estimate(float(scene.numerical_observable()), 0.0, "g is constant", 0.0)
    if scene.is_odd():
        return Estimate(0.0, 0.0, "symmetry", 0.0)
    if scene.primitive_variable is not None:
        return Estimate(0.0, 0.0, f"g is a derivative in {scene.primitive_variable}", 0.0)
    if not scene.is_line:
        return None
    value, error = quadrature.mean(scene)
    return Estimate(value, error, "quadrature", time.perf_counter() - began)


def _deterministic(scene, tol, _seed, _threads):
    require_velocity(scene, "use method='monte_carlo'")
    return answered(lambda: mean_on_grids(scene, tol), lambda found: (*found, "spectral elements"))


def _sampled(scene, tol, seed, threads):
    return answered(
        lambda: sampled_mean(scene, tol, seed, threads), lambda found: (*found, "Monte Carlo")
    )


METHODS: dict[str, Callable] = {"deterministic": _deterministic, "monte_carlo": _sampled}


def mean_on_grids(scene: Scene, tol: float | None = None) -> tuple[float, float]:
    """Integrate g over the invariant measure as discretised on tensor grids.

    Parameters
    ----------
    scene : Scene
        With two to four state variables.
    tol : float, optional
        Absolute; what `mean` says unless given.

    Returns
    -------
    value, error : float
        The errors are those of `uniform_refinement.refined` and, where it fails, of
        `combined_grids.combined`.

    Raises
    ------
    ToleranceError
        If `tol` is not met.
    """
    accuracy = tuning.MEAN.tolerance[scene.dimension]
    size = _size(scene, accuracy)
    rounding = tuning.MEAN.rounding * size
    relative = accuracy if tol is None else min(tol / size, 1.0)
    if uniform_refinement.applies(scene):
        found = uniform_refinement.refined(
            fitted(scene, depth_for(relative), 1),
            lambda grid: (np.array([mean_on(scene, grid, relative)[0]]), np.zeros(1)),
            lambda error, _: error[0] / (relative * size),
        )
        if found.met:
            return float(found.value[0]), float(found.error[0]) + rounding
    best = combined(
        scene,
        relative,
        lambda scene, grid: lambda accuracy: mean_on(scene, grid, accuracy)[0],
        lambda value, tol: tol * size,
    )
    if not best.error <= relative * size:
        raise ToleranceError(
            f"E g = {best.value:.10g} has an error of {best.error:.1e}, above tol = "
            f"{relative * size:.2g}; loosen tol",
            (best.value, best.error + rounding),
        )
    return best.value, best.error + rounding


def _size(scene, tol):
    """Return the root mean square of g, roughly."""
    soft = scene.with_n(min(scene.n, tuning.MEAN.soft))
    level = tuning.GAMMA2_ON_GRIDS.fitted[scene.dimension]
    _, square = mean_on(soft, fitted(soft, depth_for(tol), level), tol)
    return math.sqrt(abs(square))


def mean_on(scene: Scene, grid: Grid, accuracy: float) -> tuple[float, float]:
    """Compute the mean and the mean square of g on one grid.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    grid : Grid
    accuracy : float
        Residual of an iterative solver.

    Returns
    -------
    mean, square : float
    """
    axes, masses = invariant_measure(scene, grid, accuracy)
    g = evaluate(scene.numerical_observable(), axes)
    masses = masses.ravel()
    return float(masses @ g), float(masses @ g**2)
