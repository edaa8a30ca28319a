"""Table 7b: rate of V-uniform ergodicity, and the bound of the Poisson solution."""

import numpy as np
import pandas as pd

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.tables import described, typeset


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
            described(scene)
            | {
                "spectral gap": f"${_with_error(row.gap, row.gap_error)}$",
                "decay on a box": f"${_with_error(row.rate, row.rate_error)}$",
                "at infinity": f"${_with_error(row.far, row.far_error)}$",
                "$C$": _scaled(row.bound, row.bound_error),
            }
        )
    return plain, pd.DataFrame(cells)


def _with_error(value, error):
    """Spell a value and its error, rounded up to one digit, at most six decimals.

    The error includes the rounding of the value.
    """
    digits = min(6, max(1, int(np.ceil(-np.log10(error)))))
    unit = 10.0**-digits
    above = unit * np.ceil((error + abs(round(value, digits) - value)) / unit)
    return rf"{value:.{digits}f} \pm {above:.{digits}f}"


def _scaled(value, error):
    """Spell a small value and its error with a common power of ten."""
    exponent = int(np.floor(np.log10(value)))
    both = _with_error(value / 10.0**exponent, error / 10.0**exponent)
    return rf"$({both}) \times 10^{{{exponent}}}$"


if __name__ == "__main__":
    typeset(ergodic, snakemake)
