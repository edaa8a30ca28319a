"""Table of figure 2b's time step bias, standard error and distance to the limit."""

import pandas as pd

from reproduction.rendering.tables import scientific, typeset


def time_step(check):
    """Tabulate for each p the largest bias over T beside the largest standard error.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    table = check.to_dataframe().reset_index()
    cells = [
        {
            "$p$": f"${row.p:g}$",
            "standard error": scientific(row.standard_error),
            "bias, passage times": rf"{scientific(row.bias)} $\pm$ {scientific(row.bias_error)}",
            "bias, variance": rf"{scientific(row.limit_bias)} $\pm$ "
            rf"{scientific(row.limit_bias_error)}",
            r"distance to $W_\star$": f"{row.distance:.4f}",
        }
        for row in table.itertuples()
    ]
    errors = [name for name in table if name.endswith("_error") and name != "standard_error"]
    plain = table.rename(columns={q: q.replace("_error", "_standard_error") for q in errors})
    plain["distance_standard_error"] = plain["standard_error"]
    return plain, pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(time_step, snakemake)
