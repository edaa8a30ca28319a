"""Table 11: rare crossings of every scene by importance sampling."""

import pandas as pd

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.tables import described, scientific, typeset

PLAIN = 0.1  # larger probabilities are spelt without exponents


def rare(sampled, scenes):
    """Tabulate W at every threshold, one row per scene.

    Parameters
    ----------
    sampled : list of xarray.Dataset
        One per scene, in the order of `scenes`.
    scenes : dict
        Name -> the scene's parameters and its thresholds.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain, cells = [], []
    for (name, parameters), run in zip(scenes.items(), sampled, strict=True):
        row, words = {"scene": name}, described(Scene(**parameters["scene"]))
        cell = {key: words[key] for key in ("model", "noise")}
        for k, b in enumerate(run["threshold"].values, start=1):
            point = run.sel(threshold=b)
            row |= {
                f"b_{k}": float(b),
                f"W_{k}": float(point["probability"]),
                f"W_{k}_error": float(point["probability_error"]),
                f"effective_{k}": round(float(point["effective_sample_size"])),
            }
            cell |= {f"$b_{k}$": f"${b:g}$", f"$W(b_{k})$": _spelt(row[f"W_{k}"])}
        plain.append(row)
        cells.append(cell)
    return pd.DataFrame(plain), pd.DataFrame(cells).fillna("")


def _spelt(probability):
    """Spell a probability with two digits."""
    return f"${probability:.2f}$" if probability > PLAIN else scientific(probability)


if __name__ == "__main__":
    typeset(rare, snakemake)
