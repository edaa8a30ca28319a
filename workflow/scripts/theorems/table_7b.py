"""Table 7b: rate of V-uniform ergodicity, and the bound of the Poisson solution."""

import numpy as np
import pandas as pd

from nonsmooth.scene import Scene
from nonsmooth.tables import scientific, typeset


def ergodic(ergodicity, scenes):
    """Tabulate every scene.

    Parameters
    ----------
    ergodicity : xarray.Dataset
    scenes : dict
        Name -> parameters of the scene.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain = ergodicity.to_dataframe().reset_index()
    cells = []
    for row in plain.itertuples():
        scene = Scene(**scenes[row.scene])
        cells.append(
            {
                "model": scene.model.replace("_", "-"),
                "noise": scene.noise.kind,
                "state": ", ".join(f"${_symbol(name)}$" for name in scene.state),
                "spectral gap": _with_error(row.gap, row.gap_error),
                "rate in the $V$-norm": _with_error(row.rate, row.rate_error),
                "$C$": scientific(row.bound, 3),
                "$C$, larger box": scientific(row.enlarged, 3),
                "its edge": scientific(row.edge, 1),
            }
        )
    return plain, pd.DataFrame(cells)


def _symbol(name):
    return name if len(name) == 1 else rf"\{name}"


def _with_error(value, error):
    """Spell a value and its error, rounded up to one digit, at most six decimals."""
    digits = min(6, max(1, int(np.ceil(-np.log10(error)))))
    above = np.ceil(error * 10**digits) / 10**digits
    return rf"${value:.{digits}f} \pm {above:.{digits}f}$"


if __name__ == "__main__":
    typeset(ergodic, snakemake)
