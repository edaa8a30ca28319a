"""Tables of the work-precision diagrams: time for an error, order of an error, growth of a time."""

import pandas as pd

from reproduction.rendering.tables import scientific, typeset
from reproduction.speed_against_error.work_precision import exponent, front


def tabulate(measurements, x, y):
    """Tabulate all measurements, and what they show.

    Parameters
    ----------
    measurements, x, y
        As for the diagram.

    Returns
    -------
    plain, cells : pandas.DataFrame
        For error against time, the cells are the cases that no other case of the method beats in
        both; errors below their own uncertainty are given as that. Otherwise the cells are the
        exponents of the curves.
    """
    plain = measurements.to_dataframe().reset_index(drop=True)
    cells = []
    for (panel, method), curve in plain.groupby(["panel", "method"], sort=False):
        if x == "seconds":
            seconds = curve["seconds"].to_numpy()
            error = curve[["error", "error_error"]].to_numpy().max(axis=1)
            rows = [
                {
                    "step, degree, ...": f"{curve['size'].iloc[k]:g}",
                    "error": scientific(error[k]),
                    "seconds": f"{seconds[k]:.2g}",
                    "least to most": f"{curve['seconds_least'].iloc[k]:.2g} to "
                    f"{curve['seconds_most'].iloc[k]:.2g}",
                }
                for k in front(seconds, error)
            ]
        elif len(curve) < 2:
            continue
        else:
            slope, spread = exponent(curve[x].to_numpy(), curve[y].to_numpy())
            rows = [
                {
                    "from": f"{curve[x].min():g}",
                    "to": f"{curve[x].max():g}",
                    # two points have no residual
                    "exponent": rf"${slope:.2f} \pm {spread:.2f}$"
                    if len(curve) > 2
                    else f"${slope:.2f}$",
                    f"{y} at the end": scientific(curve[y].iloc[-1]),
                }
            ]
        cells += [{"problem": panel, "method": method} | row for row in rows]
    return plain, pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(tabulate, snakemake)
