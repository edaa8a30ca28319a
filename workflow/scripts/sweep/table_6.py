"""Table 6: gamma^2 and crossing probabilities of every scene by Monte Carlo."""

import pandas as pd

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.tables import described, typeset


def sweep(variance, crossing, limit, check, scenes, p):
    """Tabulate one row per scene; probabilities at the last horizon.

    Parameters
    ----------
    variance : list of xarray.Dataset
        One per scene, in the order of `scenes`.
    crossing : list of xarray.Dataset
        One per scene and p, p changing fastest.
    limit : xarray.Dataset
        Over (scene, horizon).
    check : xarray.Dataset
        The bias of the step is small, or it would not exist.
    scenes : dict
        Name -> the scene's parameters and its threshold.
    p : list of float

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain, cells = [], []
    for k, (name, parameters) in enumerate(scenes.items()):
        scene = Scene(**parameters["scene"])
        gamma2 = {
            key.replace("_error", "_standard_error"): float(variance[k][key])
            for key in variance[k].data_vars
        }
        last = [run.isel(horizon=-1) for run in crossing[k * len(p) : (k + 1) * len(p)]]
        star = limit.sel(scene=name).isel(horizon=-1)
        row = {"scene": name, "threshold": parameters["threshold"]} | gamma2
        for scale, run in zip(p, last, strict=True):
            row[f"W_{scale:g}"] = float(run["probability"])
            row[f"W_{scale:g}_standard_error"] = float(run["probability_error"])
            row[f"W_{scale:g}_bias"] = float(run["bias"])
            row[f"W_{scale:g}_bias_standard_error"] = float(run["bias_error"])
        row["W_star"] = float(star["probability"])
        row["W_star_error"] = float(star["probability_error"])
        plain.append(row)
        cells.append(
            described(scene)
            | {"$b$": f"${parameters['threshold']:g}$"}
            | {f"$p = {scale:g}$": f"{row[f'W_{scale:g}']:.3f}" for scale in p}
            | {r"$W_\star$": f"{row['W_star']:.3f}"}
        )
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(sweep, snakemake)
