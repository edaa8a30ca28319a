"""Table 3: penalty functions and potential of each model."""

import pandas as pd
import sympy

from nonsmooth.scenes.equations import U
from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.symbols import x
from reproduction.rendering.tables import typeset


def forces():
    """Tabulate f_{n,y}, f_{n,x} and the potential from the models' definitions.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    entries = [
        {
            "model": model,
            "f_{n,y}": model.velocity_penalty,
            "f_{n,x}": model.displacement_penalty,
            "potential": U(x) + model.added_potential,
        }
        for model in MODELS.values()
    ]
    plain = [{k: str(v) for k, v in row.items()} | {"model": row["model"].name} for row in entries]
    cells = [
        {"model": row["model"].title}
        | {
            f"${k}$" if k.startswith("f") else k: f"${sympy.latex(v)}$"
            for k, v in row.items()
            if k != "model"
        }
        for row in entries
    ]
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(forces, snakemake)
