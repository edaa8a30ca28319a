"""Table 12: crossing probabilities as n grows, and the exponents of n."""

import pandas as pd

from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.scene import Scene
from reproduction.rendering.tables import scientific, typeset


def crossing_exponents(crossing, scenes, thresholds, names):
    """Tabulate exponents and limits with their errors, and the distances to the limits.

    Parameters
    ----------
    crossing : list of xarray.Dataset
        One per scene, in the order of `names`.
    scenes : dict
        Name -> entry of the configuration.
    thresholds : dict
        Name -> b.
    names : list of str

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain, cells = [], []
    for name, run in zip(names, crossing, strict=True):
        scene, n = Scene(**scenes[name]["scene"], n=1.0), run["n"].values
        last = run.isel(n=-1)
        limit, error = float(run["limit"]), float(run["limit_error"])
        distance = float(last["probability"]) - limit
        row = {
            "scene": name,
            "threshold": thresholds[name],
            "n_first": n[0],
            "n_last": n[-1],
            "probability_at_n_last": float(last["probability"]),
            "probability_at_n_last_error": float(last["probability_error"]),
            "limit": limit,
            "limit_error": error,
            "distance": distance,
            "distance_error": float(last["probability_error"]) + error,
            "exponent": float(run["exponent"]),
            "exponent_error": float(run["exponent_error"]),
        }
        plain.append(row)
        cells.append(
            {
                "model": MODELS[scene.model].title,
                "noise": scene.noise.kind,
                "$b$": f"${thresholds[name]:g}$",
                "$n$": f"{n[0]:g}--{n[-1]:g}",
                "limit $W$": rf"${limit:.6f}$",
                "its error": scientific(error, bound=True),
                "$W^n - W$ at the largest $n$": scientific(distance),
                "exponent": rf"${row['exponent']:.3f} \pm {row['exponent_error']:.3f}$",
            }
        )
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(crossing_exponents, snakemake)
