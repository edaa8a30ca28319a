"""Table 5b: gamma^2 of scenes by formula, deterministic and by Monte Carlo."""

import pandas as pd
import sympy

from nonsmooth.scenes.scene import by_formulas
from reproduction.gamma2 import compared
from reproduction.rendering.tables import symbol, typeset

SAMPLED = {"gamma2": "monte_carlo", "gamma2_error": "monte_carlo_error"}
DIGITS = 2  # of the correlation time


def potentials(found, scenes):
    """Tabulate both values of each scene, their deviation, and the correlation time.

    Parameters
    ----------
    found : xarray.Dataset
        Over `scene`.
    scenes : list of dict

    Returns
    -------
    plain, cells : pandas.DataFrame

    Raises
    ------
    CheckError
        If the two values of a scene contradict each other.
    """
    plain, cells = [], []
    for number, parameters in enumerate(scenes):
        scene, run = by_formulas(parameters), found.isel(scene=number)
        sampled = {key: run[SAMPLED.get(key, key)] for key in (*SAMPLED, "bias", "bias_error")}
        row, values = compared(str(scene), scene, run, sampled)
        time = {key: float(run[key]) for key in ("correlation_time", "correlation_time_error")}
        plain.append(row | time)
        cells.append(
            {
                "model": scene.model.replace("_", "-"),
                "potentials": ", ".join(_formulas(scene)),
                "$g$": symbol(scene.observable),
            }
            | values
            | {r"$\tau_g$": f"{time['correlation_time']:#.{DIGITS}g}"}
        )
    cells = pd.DataFrame(cells)
    cells.attrs["widths"] = ["auto", "1fr"] + ["auto"] * (len(cells.columns) - 2)
    return pd.DataFrame(plain), cells


def _formulas(scene):
    """Spell the formulas that make the scene, as far as its state depends on them."""
    noise = scene.noise
    named = {"U": scene.potential_expression} if "x" in scene.state else {}
    if noise.kind == "langevin":
        named["v"] = noise.potential_expression
    elif noise.kind == "hamiltonian":
        named |= {"H": noise.energy, "F": noise.dissipation}
    return [
        f"${name} = {sympy.latex(formula, fold_short_frac=True)}$"
        for name, formula in named.items()
    ]


if __name__ == "__main__":
    typeset(potentials, snakemake)
