"""Permanent deformation of a yielding structure in an earthquake: an example of the theory.

The structure is the elasto-plastic oscillator, the ground a Kanai-Tajimi filter of white noise.
With g the plastic strain rate, int_0^t g is the permanent deformation at time t.
"""

from nonsmooth.scenes.noises import KanaiTajimi
from nonsmooth.scenes.scene import Scene


def yielding_oscillator(ground: dict, oscillator: dict) -> Scene:
    """Return the scene whose integrated observable is the permanent deformation.

    Parameters
    ----------
    ground : dict
        `stiffness`, `damping` and `sigma` of the Kanai-Tajimi noise.
    oscillator : dict
        `n`, `damping` and `potential` of the structure, whose yield displacement is 1.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError, ExpressionError
        If a parameter is out of range or U cannot be read.
    """
    return Scene(
        "elasto_plastic", KanaiTajimi(**ground), observable="plastic_strain_rate", **oscillator
    )


def relaxation_time(oscillator: dict) -> float:
    """Time in which the amplitude of the structure's elastic vibration falls by e.

    2/C_b, the reciprocal of the spectral gap of the underdamped linear oscillator; yielding adds
    to the damping.
    """
    return 2 / oscillator["damping"]
