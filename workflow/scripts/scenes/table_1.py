"""Table 1: variational inequality, convex function, its regularisation and penalty force."""

import pandas as pd
import sympy

from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.symbols import x, y
from reproduction.rendering.tables import typeset


def penalties():
    """Tabulate the three models' penalties from their definitions.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain, cells = [], []
    for model in MODELS.values():
        z, penalty = model.argument, model.penalty
        arguments = "y, x" if model.inequality == "SVI-1" else "x"
        force = [model.penalty_force if model.equation == s else sympy.Integer(0) for s in (y, x)]
        plain.append(
            {
                "model": model.name,
                "inequality": model.inequality,
                "phi": penalty.limit % z,
                "phi_n": str(penalty.potential(z)),
                "f_n,y": str(force[0]),
                "f_n,x": str(force[1]),
            }
        )
        cells.append(
            {
                "model": model.title,
                "SVI": model.inequality,
                r"$\varphi$": rf"$\varphi({arguments}) = {penalty.limit % z}$",
                r"$\varphi_n$": rf"${penalty.name}({z}) = {sympy.latex(penalty.potential(z))}$",
                "$f_n$": rf"${sympy.latex(sympy.Matrix(force))}$",
            }
        )
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(penalties, snakemake)
