"""Table 10: exponents of n in the distance to the non-smooth limit."""

import pandas as pd

from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.scene import Scene
from reproduction.rendering.tables import scientific, typeset


def exponents(rates, scenes):
    """Tabulate the exponents with their errors, and the distances at the largest n.

    Parameters
    ----------
    rates : xarray.Dataset
    scenes : dict
        Name -> entry of the configuration.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain, cells = [], []
    for name, entry in scenes.items():
        run, scene = rates.sel(scene=name), Scene(**entry["scene"], n=1.0)
        last = run.isel(point=-1)
        row = {"scene": name, "n_first": entry["n"][0], "n_last": entry["n"][-1]}
        for kind in ("pathwise", "weak"):
            row |= {
                f"{kind}_exponent": float(run[f"{kind}_exponent"]),
                f"{kind}_exponent_half_interval": float(run[f"{kind}_exponent_error"]),
                f"{kind}_at_n_last": float(last[kind]),
                f"{kind}_at_n_last_standard_error": float(last[f"{kind}_error"]),
            }
        plain.append(row)

        def exponent(kind, run=run):
            value, half = (float(run[f"{kind}_exponent{suffix}"]) for suffix in ("", "_error"))
            return rf"${value:.2f} \pm {half:.2f}$"

        cells.append(
            {
                "model": MODELS[scene.model].title,
                "noise": scene.noise.kind,
                "$n$": f"{entry['n'][0]:g}--{entry['n'][-1]:g}",
                "paths of": f"${entry['variable']}$",
                "exponent, paths": exponent("pathwise"),
                "at the largest $n$": scientific(last["pathwise"]),
                "exponent, law": exponent("weak"),
                "at the largest $n$ ": scientific(last["weak"]),
            }
        )
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(exponents, snakemake)
