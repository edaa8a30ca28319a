"""Table 4: v(0, T)/T for increasing n, printed and computed."""

import pandas as pd

from reproduction.convergence import printed_in_table_4
from reproduction.rendering.tables import penalization, scientific, sorted_by, typeset


def convergence(spectral, finite_difference, check, scene, horizon):
    """Tabulate, for each n, the printed value and ours.

    Parameters
    ----------
    spectral, finite_difference : list of xarray.Dataset
        One per n.
    check : xarray.Dataset
        They agree, or it would not exist.
    scene : dict
    horizon : float

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    printed = printed_in_table_4(scene, horizon)
    scheme = {float(run["n"]): run for run in finite_difference}
    plain, cells = [], []
    for run in sorted_by("n", spectral):
        n = float(run["n"])
        value = {name: float(run[name]) for name in run.data_vars}
        paper = scheme.get(n)
        plain.append(
            {"n": n, "printed": printed.get(n)}
            | {
                f"finite_difference{kind}": float(paper[f"v_over_time{kind}"]) if paper else None
                for kind in ("", "_error")
            }
            | value
        )
        cells.append(
            {
                "$n$": penalization(n),
                "printed": f"{printed[n]:.6f}" if n in printed else "--",
                "paper's scheme": f"{float(paper['v_over_time']):.7f}" if paper else "--",
                r"$\pm$": scientific(paper["v_over_time_error"], bound=True) if paper else "--",
                "$v(0,T)/T$": f"{value['v_over_time']:.10f}",
                r"$\gamma_n^2$": f"{value['gamma2']:.12f}",
                r"$v(0,T)/T - \gamma_n^2$": scientific(value["offset"], 4),
            }
        )
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(convergence, snakemake)
