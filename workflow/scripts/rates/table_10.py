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
    names = [
        f"{kind}_exponent{suffix}" for kind in ("pathwise", "weak") for suffix in ("", "_error")
    ]
    plain = rates[names].to_dataframe().reset_index()
    cells = []
    for name, entry in scenes.items():
        run, scene = rates.sel(scene=name), Scene(**entry["scene"], n=1.0)
        last = run.isel(point=-1)

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
    return plain, pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(exponents, snakemake)
