"""Table 2: drift and diffusion of the extended state for each noise."""

import pandas as pd
import sympy

from nonsmooth.scenes import equations
from nonsmooth.scenes.noises import NOISES, named
from reproduction.rendering.tables import typeset


def state_equations():
    """Tabulate F_n and sigma from the definitions of noises and oscillator.

    Returns
    -------
    plain, cells : pandas.DataFrame
    """
    plain, cells = [], []
    for noise in map(named, NOISES):
        drift, sigma = equations.drift(noise), equations.diffusion(noise)
        state = sympy.latex(sympy.Matrix(list(drift)))
        plain += [
            {"noise": noise.title, "variable": str(s), "F_n": str(f), "sigma": int(e)}
            for (s, f), e in zip(drift.items(), sigma, strict=True)
        ]
        cells.append(
            {
                "noise": noise.title,
                "$Z^n$": f"${state}$",
                "$F_n$": f"${sympy.latex(sympy.Matrix(list(drift.values())))}$",
                r"$\sigma$": f"${sympy.latex(sigma)}$",
            }
        )
    return pd.DataFrame(plain), pd.DataFrame(cells)


if __name__ == "__main__":
    typeset(state_equations, snakemake)
