"""The derivative of gamma^2 with respect to a parameter of the scene."""

import time

from nonsmooth.checks import require_tolerance
from nonsmooth.errors import ToleranceError, answered
from nonsmooth.estimate import Estimate
from nonsmooth.scenes.scene import Scene, require_scene, require_velocity
from nonsmooth.sensitivity import grids, line, tuning
from nonsmooth.sensitivity.parameters import require_parameter_of, value_of


def asymptotic_variance_sensitivity(
    scene: Scene, parameter: str, tol: float | None = None
) -> Estimate:
    """Return the derivative of gamma^2 with respect to a parameter, without Monte Carlo.

    The equations are differentiated, not their solutions: no step has to be chosen.

    Parameters
    ----------
    scene : Scene
    parameter : {"damping", "n", "sigma"}
        C_b, the penalization, or the intensity of the noise.
    tol : float, optional
        Requested error of the derivative, relative to gamma^2 over the parameter. Unless given, it
        is 1e-8, 1e-5, 2e-3 or 2e-2 for one to four state variables; what misses these is returned
        with a warning.

    Returns
    -------
    Estimate
        Exactly 0 where gamma^2 is, because g is constant or a derivative along paths.

    Raises
    ------
    SceneError
        If there is no such parameter, or g is a function of the noise alone.
    ToleranceError
        If `tol` cannot be met; the best value is its `result`.

    Examples
    --------
    With more damping the displacement of dry friction spreads more slowly:

    >>> import nonsmooth as ns
    >>> slope = ns.asymptotic_variance_sensitivity(ns.Scene("friction"), "damping")
    >>> print(f"{slope.value:.6f}")
    -0.156330
    """
    began = time.perf_counter()
    require_scene(scene)
    parameter = require_parameter_of(scene, parameter)
    wanted = None if tol is None else require_tolerance(tol)
    if not scene.state or scene.primitive_variable is not None:
        return Estimate(0.0, 0.0, "gamma^2 = 0", time.perf_counter() - began)
    require_velocity(scene, "choose a g with y or x")
    accuracy = tuning.GAMMA2.tolerance[scene.dimension - 1] if wanted is None else wanted

    def present(found):
        (value, error), way = found
        return Estimate(float(value), float(error), way, time.perf_counter() - began)

    return answered(lambda: _solved(scene, parameter, accuracy), present, wanted is not None)


def _solved(scene, parameter, tol):
    """Return derivative and error, and the name of the method."""
    if scene.is_line:
        way, method = "differentiated equations", line.slope
    else:
        way, method = "differentiated spectral elements", grids.slope
    unit = 1 / value_of(scene, parameter)
    slope, error, gamma2 = method(scene, parameter, tol)
    value, total = unit * slope, unit * error
    if not error <= tol * gamma2:
        raise ToleranceError(
            f"the derivative {value:.10g} has an error of {total:.1e}, above tol = {tol:g} "
            "relative to gamma^2 over the parameter; loosen tol",
            ((value, total), way),
        )
    return (value, total), way
