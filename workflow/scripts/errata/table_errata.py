"""Table of errata: what is printed, what is meant, and the evidence."""

import numpy as np
import pandas as pd

from reproduction.rendering.tables import scientific, typeset

RELATION = {"equal": "", "at least": r"\geq ", "at most": r"\leq "}
WIDTHS = ("auto", "1.2fr", "2fr", "2fr", "1.8fr", *["auto"] * 5)
# chosen: relative, of what is compared without an error; processors differ by some 1e-12
ROUNDING = 1e-10
TEXTS = ("place", "wrong", "right", "quantity", "relation", "kind")


def errata(evidence):
    """Tabulate the errata.

    Parameters
    ----------
    evidence : xarray.Dataset
        Values by entry.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    cells = []
    for entry in evidence["entry"].values:
        row = evidence.sel(entry=entry)
        text = {name: str(row[name].item()) for name in TEXTS}
        sign = RELATION[text["relation"]]
        error = float(row["reference_error"])
        cells.append(
            {
                "": str(entry),
                "where": text["place"],
                "printed": text["wrong"],
                "mended": text["right"],
                "quantity": text["quantity"],
                "value, printed": _number(row["printed"]),
                "value, mended": _number(row["mended"]),
                "reference": _number(row["reference"], sign, digits=8),
                r"$\pm$": scientific(error) if error else "$0$",
                "evidence": text["kind"],
            }
        )
    cells = pd.DataFrame(cells)
    cells.attrs["widths"] = WIDTHS
    plain = evidence.to_dataframe().reset_index()[["entry", *TEXTS, *sorted(evidence.data_vars)]]
    for name in ("printed", "mended"):  # it is the error of the comparison, or rounding
        plain[f"{name}_error"] = np.maximum(plain["reference_error"], ROUNDING * plain[name].abs())
    return plain, cells


def _number(value, sign="", digits=6):
    """Spell significant digits; powers of ten where they are shorter."""
    value = float(value)
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return f"${sign}{scientific(value, 4).strip('$')}$"
    return f"${sign}{value:.{digits}g}$"


if __name__ == "__main__":
    typeset(errata, snakemake)
