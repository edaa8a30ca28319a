"""Table 7: the smallest margins of the drift condition for every kind of scene."""

import pandas as pd
from sympy import latex

from nonsmooth.scenes.formulas import parse
from nonsmooth.scenes.symbols import eta
from reproduction.rendering.printed import numbered
from reproduction.rendering.tables import scientific, typeset

COLUMNS = {
    "drift": r"$1 - \sup / C$",
    "boxed": r"\ref{An2V2epsV2-bound}, \ref{An3V3epsV3-bound}, \ref{An4V4epsV4-bound}",
    "mechanical": "$S_1$, $S_2$",
    "forcing": "$S_3$, $S_4$",
    "forcing_printed": "$S_4$ printed",
    "lower": "(HV1)",
}


def smallest(drift_condition):
    """Tabulate, for every model and noise, the minimum over potentials, damping and n.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    table = drift_condition.to_dataframe().reset_index(drop=True)
    kinds = table.groupby(["model", "noise", "v"], sort=False)
    plain = kinds[[*COLUMNS, "coefficient"]].min()
    plain.insert(0, "scenes", kinds.size())
    for name in COLUMNS:
        plain[f"{name}_error"] = kinds[f"{name}_error"].max()
    plain["coefficient_error"] = plain["coefficient"] * plain["drift_error"]
    plain = plain.reset_index()
    cells = []
    for row in plain.itertuples():
        shown = {
            numbered(label): _margin(getattr(row, name), row.drift_error)
            for name, label in COLUMNS.items()
        }
        if row.noise != "hamiltonian":
            shown[COLUMNS["forcing_printed"]] = "--"  # Claim 9 of the paper is right as printed
        c = row.coefficient
        v = ", $v = " + latex(parse(row.v, (eta,))) + "$" if row.v else ""
        cells.append(
            {
                "model": row.model.replace("_", "-"),
                "noise": row.noise + v,
                "scenes": str(row.scenes),
            }
            | shown
            | {"$c$": scientific(c, 2) if c >= 1000 else f"${c:.3g}$"}
        )
    return plain, pd.DataFrame(cells)


def _margin(value, rounding):
    """Spell a margin: 0 if it is below rounding, a dash for 1, which stands for no claim."""
    if value == 1:
        return "--"
    if abs(value) <= rounding:
        return "$0$"
    return f"${value:.3f}$" if abs(value) >= 0.01 else scientific(value)


if __name__ == "__main__":
    typeset(smallest, snakemake)
