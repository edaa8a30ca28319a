"""The constants of a scene's boundary layer, by the best method that applies."""

from dataclasses import replace
from functools import lru_cache

from nonsmooth.boundary_layer import asymmetric_line, poisson, symmetric_line, two_variables
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.boundary_layer.sampled import sampled_kappa, sampled_poisson
from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.paths.kernels.random_numbers import labelled
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import limit_variance


def highest_order(scene: Scene) -> int:
    """Return the highest order of the corrected formula for which `layer_constants` suffices."""
    return 3 if scene.is_line or two_variables.applies(scene) else 1


def solved_constants(
    scene: Scene, tol: float | None = None, higher: bool = False
) -> tuple[LayerConstants, LayerConstants] | None:
    """Compute the constants without Monte Carlo.

    Parameters
    ----------
    scene : Scene
    tol : float, optional
        Absolute error wanted, "1"; 1e-8 for one variable and 1e-3 for two, unless given.
    higher : bool, optional
        Whether the constants of the orders 2 and 3 are wanted even where they cost much more.

    Returns
    -------
    constants, errors : LayerConstants
        None instead of both if the scene needs Monte Carlo.

    Raises
    ------
    SceneError
        If gamma^2 is 0, or g of two variables is not centred.
    ToleranceError
        If `tol` is not met; the message has the best value and its error.
    """
    mean = mean_of_line(scene)
    if mean != 0:
        scene = scene.with_observable(f"{scene.observable} - ({mean!r})")
    if two_variables.applies(scene):
        return two_variables.layer_constants(scene, tol, higher)
    for method in (symmetric_line, asymmetric_line):
        if method.applies(scene):
            constants, errors = method.layer_constants(scene, tol)
            return replace(constants, mean=mean), errors
    return None


def mean_of_line(scene: Scene) -> float:
    """Return E g for one variable, 0 if it is rounding; 0 for other scenes."""
    # it does not depend on the start
    return asymmetric_line.mean(scene.with_start({})) if asymmetric_line.applies(scene) else 0.0


@lru_cache(maxsize=16)  # the constants serve every p and every interval
def layer_constants(
    scene: Scene,
    seed: int | tuple = 0,
    threads: int | None = None,
    tol: float | None = None,
    higher: bool = False,
) -> tuple[LayerConstants, LayerConstants]:
    """Compute the constants, by Monte Carlo where nothing else applies.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise, or with odd g.
    seed, threads
        For Monte Carlo: an int or a tuple; the number of threads, all cores unless given.
    tol : float, optional
        Absolute error wanted of kappa, as for `extrapolation_length`.
    higher : bool, optional
        As for `solved_constants`.

    Returns
    -------
    constants, errors : LayerConstants

    Raises
    ------
    SceneError, ToleranceError
        As `extrapolation_length`; by Monte Carlo only if `tol` is given.
    """
    solved = solved_constants(scene, tol, higher)
    if solved is not None:
        return solved
    kappa = _length(scene, tol, labelled(seed, "length"), threads)
    gamma2 = limit_variance(scene, seed, threads)
    u = _poisson_at_start(scene, abs(kappa.value), labelled(seed, "start"), threads)
    return (
        LayerConstants(gamma2.value / 2, (kappa.value, kappa.value), u.value),
        LayerConstants(gamma2.error / 2, (kappa.error, kappa.error), u.error),
    )


def _poisson_at_start(scene, unit, seed, threads):
    """Compute u at the start; at the origin it is 0, because drift and g are odd."""
    if not any(scene.start.values()):
        return Estimate(0.0, 0.0, "symmetry", 0.0)
    return poisson.at_start(scene, unit) or sampled_poisson(scene, seed, threads)


def _length(scene, tol, seed, threads):
    """Sample kappa; unless an error was asked for, its own is enough, for formulas inherit it."""
    try:
        return sampled_kappa(scene, tol, seed, threads)
    except ToleranceError as refused:
        if tol is not None:
            raise
        return refused.result
