"""Table 5: gamma^2 of every scene, deterministic and by Monte Carlo."""

import numpy as np
import pandas as pd

from nonsmooth.errors import CheckError
from nonsmooth.scene import Scene
from nonsmooth.tables import scientific, typeset

ALLOWED = 5.0  # standard errors; chance exceeds them with a probability of 6e-7


def growth(solved, sampled, names, scenes):
    """Tabulate both values of each scene and their deviation in standard errors.

    Parameters
    ----------
    solved, sampled : list of xarray.Dataset
        One per name.
    names : list of str
    scenes : dict
        Name -> the scene's parameters and its threshold.

    Returns
    -------
    plain, cells : pandas.DataFrame

    Raises
    ------
    CheckError
        If the two values of a scene contradict each other.
    """
    plain, cells = [], []
    for name, exact, sample in zip(names, solved, sampled, strict=True):
        scene = Scene(**scenes[name]["scene"])
        value, bound = float(exact["gamma2"]), float(exact["gamma2_error"])
        drawn = {key: float(sample[key]) for key in ("gamma2", "gamma2_error", "bias")}
        spread = float(np.hypot(drawn["gamma2_error"], float(sample["bias_error"])))
        corrected = drawn["gamma2"] - drawn["bias"]
        deviation = (corrected - value) / spread
        if abs(corrected - value) > ALLOWED * spread + bound:
            raise CheckError(
                f"gamma^2 of {name} is {value:.6g} +- {bound:.1g}, but {corrected:.6g} +- "
                f"{spread:.1g} by Monte Carlo; one of the two is wrong"
            )
        plain.append(
            {"scene": name, "variables": len(scene.state), "gamma2": value, "gamma2_error": bound}
            | {f"monte_carlo_{key}": number for key, number in drawn.items()}
            | {"monte_carlo_corrected": corrected, "spread": spread, "deviation": deviation}
        )
        digits = max(2, int(np.ceil(-np.log10(bound))))
        cells.append(
            {
                "model": scene.model.replace("_", "-"),
                "noise": scene.noise.kind,
                "state": ", ".join(f"${_symbol(s)}$" for s in scene.state),
                "$g$": f"${_symbol(scene.observable)}$",
                r"$\gamma^2$": f"{value:.{min(digits, 12)}f}",
                "error": scientific(bound, bound=True),
                "Monte Carlo": rf"${corrected:.4f} \pm {spread:.4f}$",
                "deviation": rf"${deviation:+.1f}\,\sigma$",
            }
        )
    return pd.DataFrame(plain), pd.DataFrame(cells)


def _symbol(name):
    return name if len(name) == 1 else rf"\{name}"


if __name__ == "__main__":
    typeset(growth, snakemake)
