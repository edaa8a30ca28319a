"""Table of the hard cases: the true error beside the stated one, or the message."""

import math

import pandas as pd

from reproduction.rendering.tables import scientific, typeset

WIDTHS = ("1.2fr", "1fr", "auto", "auto", "auto", "2.6fr")


def hard_cases(outcomes):
    """Tabulate the outcomes.

    Parameters
    ----------
    outcomes : xarray.Dataset
        By case.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain = pd.DataFrame(
        {name: outcomes[name].values for name in ("title", "method", "verdict", "message")}
    )
    for name in ("value", "value_error", "reference", "deviation"):
        plain[name] = pd.Series(outcomes[name].values, index=outcomes["of_case"].values)
    cells = pd.DataFrame(
        [
            {
                "case": row.title,
                "method": row.method.replace("_", " "),
                "value": _number(row.value),
                "off by": "--" if math.isnan(row.deviation) else scientific(row.deviation),
                "says": "--" if math.isnan(row.value_error) else scientific(row.value_error),
                "message": row.message.replace("_", " ").replace("**", "^") or row.verdict,
            }
            for row in plain.itertuples()
        ]
    )
    cells.attrs["widths"] = WIDTHS
    return plain, cells


def _number(value):
    if math.isnan(value):
        return "--"
    return f"${value:.6g}$" if value == 0 or abs(value) >= 1e-3 else scientific(value, 5)


if __name__ == "__main__":
    typeset(hard_cases, snakemake)
