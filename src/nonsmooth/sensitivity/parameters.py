"""The parameters of a scene, and the derivatives of its equations with respect to them."""

import math
from collections.abc import Callable

import numpy as np
import sympy

from nonsmooth.checks import require_choice
from nonsmooth.errors import SceneError
from nonsmooth.grids.generator import Change
from nonsmooth.line.potential import depth
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.scene import Scene

PARAMETERS = ("damping", "n", "sigma")
_MEANT = {"c_b": "damping", "b": "threshold"}  # what other names stand for
_SYMBOLS = {"damping": symbols.damping, "n": penalization}


def require_parameter_of(scene: Scene, parameter: str, more: tuple[str, ...] = ()) -> str:
    """Return the name of a parameter with respect to which the scene can be differentiated."""
    name = require_choice("parameter", parameter, PARAMETERS + more, _MEANT)
    if name == "n" and math.isinf(scene.n):
        raise SceneError(
            "n = inf has no derivative with respect to n; choose a finite n or another parameter"
        )
    return name


def value_of(scene: Scene, parameter: str) -> float:
    """Return the value of a parameter of the scene."""
    return scene.noise.sigma if parameter == "sigma" else getattr(scene, parameter)


def change(scene: Scene, parameter: str) -> Change:
    """Return the derivatives of the drift and of the diffusion.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    parameter : str
        One of `PARAMETERS`.

    Returns
    -------
    Change
    """
    if parameter == "sigma":
        return Change(dict.fromkeys(scene.drift, sympy.Integer(0)), scene.noise.sigma)
    drift = {s: derivative(scene, expression, parameter) for s, expression in scene.drift.items()}
    return Change(drift, 0.0)


def derivative(scene: Scene, expression: sympy.Expr, parameter: str) -> sympy.Expr:
    """Differentiate a formula in n and C_b, and put the scene's numbers in their place."""
    if parameter == "sigma":
        return sympy.Integer(0)
    slope = sympy.diff(expression, _SYMBOLS[parameter])
    numbers = {penalization: sympy.Float(scene.n), symbols.damping: sympy.Float(scene.damping)}
    return slope.subs(numbers)


def change_of_depth(scene: Scene, parameter: str) -> Callable[[np.ndarray], np.ndarray]:
    """Return the derivative of Phi, see `nonsmooth.line.potential`.

    Parameters
    ----------
    scene : Scene
        With the state y and white noise.
    parameter : str
        One of `PARAMETERS`.

    Returns
    -------
    callable
        Of arrays of velocities.
    """
    sigma = scene.noise.sigma
    if parameter == "sigma":
        phi = depth(scene)
        return lambda at: -2 / sigma * phi(at)
    if parameter == "damping":
        return lambda at: (at / sigma) ** 2
    penalty = scene.mechanics.penalty.potential(symbols.y) if scene.mechanics.is_friction else 0
    slope = sympy.diff(penalty, penalization).subs(penalization, sympy.Float(scene.n))
    return vectorised(2 * slope / sigma**2, (symbols.y,))
