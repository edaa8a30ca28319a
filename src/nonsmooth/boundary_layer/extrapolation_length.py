"""The extrapolation length kappa of a scene's thresholds."""

import time

from nonsmooth.boundary_layer import two_variables
from nonsmooth.boundary_layer.asymmetric_line import walls
from nonsmooth.boundary_layer.sampled import sampled_length
from nonsmooth.boundary_layer.symmetric_line import EXACT, expansion
from nonsmooth.estimate import Estimate


def extrapolation_length(scene, tol=None, seed=0, threads=None):
    """Distance kappa by which the threshold of the Brownian limit lies beyond the scene's.

    Parameters
    ----------
    scene : Scene
        With the state y, white noise, and E g = 0; with two variables, finite n and odd g; or any
        other with odd g, by Monte Carlo.
    tol : float, optional
        Absolute error wanted, "1"; 1e-8, 1e-3 for two variables, or by Monte Carlo a fifth of
        kappa, unless given.
    seed, threads
        Of Monte Carlo: int or tuple; all cores unless given.

    Returns
    -------
    Estimate or (Estimate, Estimate)
        For odd g one kappa, the same at both thresholds; otherwise those of the lower and of the
        upper threshold. The error is the difference of two polynomial degrees, or of two tensor
        grids; of Monte Carlo, see `overshoot.sampled_length`.

    Raises
    ------
    SceneError
        If the scene is of another kind.
    ToleranceError
        If `tol` is not met; the message has the best value and its error.
    """
    began = time.perf_counter()
    if two_variables.applies(scene):
        constants, errors = two_variables.leading(scene, **({} if tol is None else {"tol": tol}))
        seconds = time.perf_counter() - began
        return Estimate(constants.length, errors.length, "tensor grids", seconds)
    if not scene.is_line:
        return sampled_length(scene, tol, seed, threads)
    tol = EXACT if tol is None else tol
    if not scene.is_odd():
        constants, errors = walls(scene, tol)
        seconds = time.perf_counter() - began
        return tuple(
            Estimate(getattr(constants, side), getattr(errors, side), "discrete ordinates", seconds)
            for side in ("lower", "upper")
        )
    constants, errors = expansion(scene, tol)
    return Estimate(
        constants.length, errors.length, "discrete ordinates", time.perf_counter() - began
    )
