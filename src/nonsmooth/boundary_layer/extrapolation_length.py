"""The extrapolation length kappa of a scene's thresholds."""

import time

from nonsmooth.boundary_layer.milne import mean_of_line, solved_constants
from nonsmooth.boundary_layer.sampled import sampled_kappa
from nonsmooth.checks import require_choice, require_seed, require_threads, require_tolerance
from nonsmooth.errors import answered
from nonsmooth.estimate import Estimate
from nonsmooth.scenes.scene import Scene, require_random, uncentred

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
        tenth of kappa by Monte Carlo; what misses these is returned with a warning.
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
        If an argument is out of range, or the scene of another kind.
    ToleranceError
        If `tol` is not met; the best value is its `result`.
    """
    began = time.perf_counter()
    require_random(scene)
    tol = None if tol is None else require_tolerance(tol)
    side = require_choice("side", side, SIDES)
    seed, threads = require_seed(seed), require_threads(threads)

    def solve():
        if (mean := mean_of_line(scene)) != 0:
            raise uncentred("the extrapolation length", scene, mean)
        solved = solved_constants(scene.with_start({}), tol)  # kappa does not depend on the start
        return sampled_kappa(scene, tol, seed, threads) if solved is None else solved

    def present(found):
        if isinstance(found, Estimate):
            return found
        kappa, error = (numbers.kappa[SIDES.index(side)] for numbers in found)
        method = "discrete ordinates" if scene.is_line else "tensor grids"
        return Estimate(kappa, error, method, time.perf_counter() - began)

    return answered(solve, present, tol_given=tol is not None)
