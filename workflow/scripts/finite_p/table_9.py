"""Table 9: exact crossing probability, Monte Carlo, and errors of the formulas, for growing p."""

import numpy as np
import pandas as pd

from reproduction.rendering.tables import scientific, typeset


def comparison(formulas, monte_carlo, check, horizon):
    """Tabulate the probabilities at one T with the error of each formula.

    Parameters
    ----------
    formulas : xarray.Dataset
    monte_carlo : list of xarray.Dataset
        One per p of figure 2b.
    check : xarray.Dataset
        They agree with exact probabilities, or it would not exist.
    horizon : float
        T.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    sampled = {
        float(run["p"]): run.sel(horizon=horizon, method="nearest", tolerance=1e-9)
        for run in monte_carlo
    }
    names = list(formulas["formula"].values)
    header = ["$p$", "exact", "Monte Carlo", *names]
    plain, cells = [], []
    for p in formulas["p"].values:
        here = formulas.sel(p=p, horizon=horizon)
        exact, exact_error = float(here["exact"]), float(here["exact_error"])
        row = {"p": p, "exact": exact, "exact_error": exact_error}
        cell = [_scale(p), f"${exact:.6f}$", "--"]
        if p in sampled:
            value, error = (float(sampled[p][q]) for q in ("probability", "probability_error"))
            row |= {"monte_carlo": value, "monte_carlo_standard_error": error}
            cell[-1] = rf"${value:.4f} \pm {error:.4f}$"
        for name in names:
            value, stated = (
                float(here[q].sel(formula=name)) for q in ("probability", "probability_error")
            )
            row |= {name: value, f"{name}_error": stated}
            row |= {f"{name}, off": value - exact, f"{name}, off_error": exact_error}
            cell.append(
                scientific(value - exact)
                if here["resolved"].sel(formula=name)
                else f"$<$ {scientific(abs(value - exact) + exact_error, bound=True)}"
            )
        plain.append(row)
        cells.append(cell)
    return pd.DataFrame(plain), pd.DataFrame(cells, columns=header)


def _scale(p):
    """Spell p; powers of ten from 1e4 on as powers."""
    exponent = round(np.log10(p))
    return f"$10^{{{exponent}}}$" if p >= 1e4 and p == 10.0**exponent else f"${p:g}$"


if __name__ == "__main__":
    typeset(comparison, snakemake)
