"""Table 5: gamma^2 of every scene, deterministic and by Monte Carlo."""

import pandas as pd

from nonsmooth.scenes.scene import Scene
from reproduction.gamma2 import compared
from reproduction.rendering.tables import described, typeset


def two_methods(solved, sampled, names, scenes):
    """Tabulate both values of each scene and their deviation in standard errors.

    Parameters
    ----------
    solved, sampled : list of xarray.Dataset
        One per name.
    names : list of str
    scenes : dict
        Name -> the scene's parameters and its threshold.

    Returns
    -------
    plain, cells : pandas.DataFrame

    Raises
    ------
    CheckError
        If the two values of a scene contradict each other.
    """
    plain, cells = [], []
    for name, exact, sample in zip(names, solved, sampled, strict=True):
        scene = Scene(**scenes[name]["scene"])
        row, values = compared(name, scene, exact, sample)
        plain.append(row)
        cells.append(described(scene) | values)
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(two_methods, snakemake)
