"""The asymptotic variance gamma^2 of Theorem 6 of the paper.

The method is chosen by the scene and the tolerance.
"""

import math
import time
from collections.abc import Callable
from functools import lru_cache, partial

from nonsmooth.checks import require_choice, require_seed, require_threads, require_tolerance
from nonsmooth.errors import ToleranceError, answered, first_answer
from nonsmooth.estimate import Estimate, not_negative
from nonsmooth.grids.mesh import box
from nonsmooth.line import quadrature
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.paths.tuning import MONTE_CARLO
from nonsmooth.scenes import symbols
from nonsmooth.scenes.scene import Scene, require_scene, require_velocity
from nonsmooth.statistics import gamma2_on_grids, tuning
from nonsmooth.statistics.sampled_gamma2 import sampled_gamma2

SAMPLED = "Monte Carlo"


def asymptotic_variance(
    scene: Scene,
    tol: float | None = None,
    method: str | None = None,
    seed: int | tuple = 0,
    threads: int | None = None,
) -> Estimate:
    """gamma_g^2 of Theorem 6 of the paper: the rate at which the variance of int_0^t g grows.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Requested relative error. Unless given, it is 1e-2 by Monte Carlo, and by the deterministic
        method 1e-10, 1e-6, 2e-4 or 3e-3 for one to four state variables; what misses these is
        returned with a warning.
    method : {"deterministic", "monte_carlo"}, optional
        Unless given, the one that should be the faster for `tol`; with four variables and no
        `tol`, Monte Carlo. If it fails, or would take many paths, the other method is tried.
        Monte Carlo with many paths comes last, for a `tol` that is a percent or more, or a third
        of that with four variables; or if none is given and it is more accurate than what has been
        reached.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.

    Returns
    -------
    Estimate
        Exactly 0 if g is constant, or the derivative of a function of x (or of another variable)
        along paths, as g = y with obstacles is: int_0^t g stays bounded then, and another g, such
        as x, tells more. Deterministic for the state y with white noise by closed form
        (dry friction, g = y) or quadrature, in every other scene by spectral elements. By Monte
        Carlo the error is the bias of the time step, what has not settled, and the standard error
        together; `tol` bounds the former two and three standard errors.

    Raises
    ------
    SceneError
        If an argument is out of range, there is no such method, or g is a function of the noise
        alone.
    ToleranceError
        If `tol` cannot be met; the best value is its `result`.
    """
    began = time.perf_counter()
    require_scene(scene)
    tol = None if tol is None else require_tolerance(tol)
    method = None if method is None else require_choice("method", method, METHODS)
    seed, threads = require_seed(seed), require_threads(threads)
    if not scene.state:
        return Estimate(0.0, 0.0, "g is constant", time.perf_counter() - began)
    if scene.primitive_variable is not None:
        way = f"g is a derivative in {scene.primitive_variable}"
        return Estimate(0.0, 0.0, way, time.perf_counter() - began)
    ways = _fastest_first(scene, tol) if method is None else [METHODS[method]]

    def error(found):
        return found[1] / found[0] if found[0] > 0 else math.inf

    def solve():
        return first_answer(
            (partial(way, scene, tol, seed, threads) for way in ways),
            error=error,
            good_enough=lambda found: (
                tol is None and found[2] != SAMPLED and error(found) <= MONTE_CARLO.tolerance
            ),
        )

    def present(found):
        value, error, solver = found
        value, error = map(float, not_negative(value, error))
        return Estimate(value, error, solver, time.perf_counter() - began)

    return answered(solve, present, tol_given=tol is not None)


def _fastest_first(scene, tol):
    """Choose the methods to try in turn: few paths may be the fastest, and many the last resort."""
    if not box.suits(scene):
        return [_sampled]
    chosen, kind = tuning.GAMMA2, scene.dimension - 1
    accuracy = chosen.tolerance[kind] if tol is None else tol
    loose = accuracy >= chosen.faster_sampled[kind]
    few = [partial(_sampled, most=chosen.few_steps[kind])] if loose else []
    many = [_sampled] if loose or tol is None or tol >= MONTE_CARLO.tolerance else []
    return [*few, _deterministic, *many]


def _sampled(scene, tol, seed, threads, most=math.inf):
    accuracy = MONTE_CARLO.tolerance if tol is None else tol
    return answered(
        lambda: sampled_gamma2(scene, accuracy, seed, threads, most),
        lambda found: (*found, SAMPLED),
    )


def _deterministic(scene, tol, _seed, _threads):
    require_velocity(scene, "use method='monte_carlo'")
    tol = tuning.GAMMA2.tolerance[scene.dimension - 1] if tol is None else tol
    if not scene.is_line:
        return answered(
            lambda: gamma2_on_grids.gamma2(scene, tol), lambda found: (*found, "spectral elements")
        )
    if (
        scene.mechanics.is_dry_friction
        and scene.observable_expression == symbols.y
        and scene.noise.sigma == 1.0
    ):
        value, error = friction_variance(scene.n, scene.damping)
        if error <= tol * value:  # for a tiny C_b the closed form loses its digits
            return value, error, "closed form"
    return answered(
        lambda: quadrature.asymptotic_variance(scene, tol), lambda found: (*found, "quadrature")
    )


METHODS: dict[str, Callable] = {"deterministic": _deterministic, "monte_carlo": _sampled}


def limit_variance(scene: Scene, seed: int | tuple = 0, threads: int | None = None) -> Estimate:
    """gamma^2 as accurately as formulas for crossing probabilities need it.

    Parameters
    ----------
    scene : Scene
    seed, threads
        For Monte Carlo.

    Returns
    -------
    Estimate
    """
    # From three variables on, sampling is faster than solving, and a percent is enough for W_star.
    sampled = not box.suits(scene) or scene.dimension > 2
    found, refusal = _limit_variance(scene, sampled, seed, threads)

    def solve():
        if refusal is not None:
            raise ToleranceError(refusal, found)
        return found

    return answered(solve, lambda estimate: estimate, tol_given=not (sampled or scene.is_line))


@lru_cache(maxsize=16)  # formulas and the constants that correct them ask for the same
def _limit_variance(scene, sampled, seed, threads):
    """Return gamma^2, and what tells that it is not as accurate as it should be."""
    if sampled:
        method, accuracy = "monte_carlo", MONTE_CARLO.tolerance
    else:
        method, accuracy = "deterministic", tuning.GAMMA2.tolerance[0] if scene.is_line else 2e-3
    try:
        return asymptotic_variance(scene, accuracy, method, seed, threads), None
    except ToleranceError as refused:
        return refused.result, str(refused)
