"""The extrapolation length kappa of a scene's thresholds."""

import time

from nonsmooth.boundary_layer.milne import solved_constants
from nonsmooth.boundary_layer.sampled import sampled_kappa
from nonsmooth.errors import SceneError
from nonsmooth.estimate import Estimate
from nonsmooth.scenes.scene import Scene

SIDES = ("lower", "upper")


def extrapolation_length(
    scene: Scene,
    tol: float | None = None,
    side: str = "upper",
    seed: int | tuple = 0,
    threads: int | None = None,
) -> Estimate:
    """Distance kappa by which the threshold of the Brownian limit lies beyond the scene's.

    Parameters
    ----------
    scene : Scene
        With the state y, white noise, and E g = 0; or with two variables, finite n and odd g and
        drift; or any other with odd g, by Monte Carlo.
    tol : float, optional
        Absolute error wanted, "1". Unless given, it is 1e-8 for one variable, 1e-3 for two, and a
        fifth of kappa by Monte Carlo.
    side : {"upper", "lower"}, optional
        Of the threshold. For odd g kappa is the same on both sides.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.

    Returns
    -------
    Estimate
        kappa, "1". The error is the difference of the results of two polynomial degrees; for two
        variables see `two_variables.layer_constants`, for Monte Carlo `sampled.sampled_kappa`.

    Raises
    ------
    SceneError
        If the scene is of another kind, or the side is unknown.
    ToleranceError
        If `tol` is not met; the message has the best value and its error.
    """
    if side not in SIDES:
        raise SceneError(f"unknown side {side!r}; choose {' or '.join(map(repr, SIDES))}")
    began = time.perf_counter()
    solved = solved_constants(scene, tol)
    if solved is None:
        return sampled_kappa(scene, tol, seed, threads)
    kappa, error = (numbers.kappa[SIDES.index(side)] for numbers in solved)
    method = "discrete ordinates" if scene.is_line else "tensor grids"
    return Estimate(kappa, error, method, time.perf_counter() - began)
