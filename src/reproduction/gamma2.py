"""gamma^2 of a scene by two methods that share nothing, side by side."""

from collections.abc import Mapping

import numpy as np

from nonsmooth.scenes.scene import Scene
from reproduction.errors import CheckError
from reproduction.rendering.tables import scientific

ALLOWED = 5.0  # standard errors; chance exceeds them with a probability of 6e-7


def compared(name: str, scene: Scene, solved: Mapping, sampled: Mapping) -> tuple[dict, dict]:
    """Compare gamma^2 from the Poisson equation with that by Monte Carlo.

    Parameters
    ----------
    name : str
    scene : Scene
    solved : mapping
        `gamma2` and its error bound `gamma2_error`.
    sampled : mapping
        `gamma2`, its standard error `gamma2_error`, the `bias` of the time step, which is
        subtracted, and its standard error `bias_error`.

    Returns
    -------
    plain, cells : dict
        A table's row of numbers, and its cells of text without those that name the scene.

    Raises
    ------
    CheckError
        If the two values contradict each other.
    """
    value, bound = float(solved["gamma2"]), float(solved["gamma2_error"])
    drawn = {key: float(sampled[key]) for key in ("gamma2", "bias")}
    errors = {key: float(sampled[f"{key}_error"]) for key in drawn}
    corrected, spread = require_agreement(name, solved, sampled)
    deviation = (corrected - value) / spread
    plain = (
        {"scene": name, "variables": scene.dimension, "gamma2": value, "gamma2_error": bound}
        | {f"monte_carlo_{key}": number for key, number in drawn.items()}
        | {f"monte_carlo_{key}_standard_error": error for key, error in errors.items()}
        | {"monte_carlo_corrected": corrected, "monte_carlo_corrected_standard_error": spread}
        | {"deviation": deviation, "deviation_standard_error": 1.0}
    )
    shown = _decimals(spread) + 1
    cells = {
        r"$\gamma^2$": f"{value:.{min(_decimals(bound), 12)}f}",
        "error": scientific(bound, bound=True),
        "Monte Carlo": rf"${corrected:.{shown}f} \pm {spread:.{shown}f}$",
        "deviation": rf"${deviation:+.1f}\,\sigma$",
    }
    return plain, cells


def require_agreement(name: str, solved: Mapping, sampled: Mapping) -> tuple[float, float]:
    """Refuse two values of gamma^2 that contradict each other.

    Parameters
    ----------
    name, solved, sampled
        As for `compared`.

    Returns
    -------
    corrected, spread : float
        gamma^2 by Monte Carlo without the bias of the step, and its standard error.

    Raises
    ------
    CheckError
    """
    value, bound = float(solved["gamma2"]), float(solved["gamma2_error"])
    corrected = float(sampled["gamma2"]) - float(sampled["bias"])
    spread = float(np.hypot(float(sampled["gamma2_error"]), float(sampled["bias_error"])))
    if not abs(corrected - value) <= ALLOWED * spread + bound:
        raise CheckError(
            f"gamma^2 of {name} is {value:.6g} +- {bound:.1g}, but {corrected:.6g} +- "
            f"{spread:.1g} by Monte Carlo; one of the two is wrong"
        )
    return corrected, spread


def _decimals(error):
    return max(2, int(np.ceil(-np.log10(error))))
