"""The equations of Table 2 of the paper, with undefined functions for potentials and penalties.

The table is typeset from these expressions. The tests put a scene's own functions in their place
and compare the result with what the kernels of the simulation do.
"""

import sympy

from nonsmooth.scenes.models.model import oscillator
from nonsmooth.scenes.noises import Noise, hamiltonian_drift, langevin_drift
from nonsmooth.scenes.symbols import STATE_VARIABLES, eta, x, y, zeta

U = sympy.Function("U")
v = sympy.Function("v")
H = sympy.Function("H")
F = sympy.Function("F")
f_y = sympy.Function("f_{n,y}")
f_x = sympy.Function("f_{n,x}")

_NOISE_DRIFT = {
    "white": {},
    "langevin": langevin_drift(v(eta)),
    "hamiltonian": hamiltonian_drift(H(eta, zeta), F(eta, zeta)),
}


def drift(noise: Noise) -> dict[sympy.Symbol, sympy.Expr]:
    """F_n of Table 2 for a kind of noise, a dict in the order of the state."""
    equations = _NOISE_DRIFT[noise.kind] | oscillator(
        f_y(y), f_x(x), sympy.diff(U(x), x), noise.forcing
    )
    return {symbol: equations[symbol] for symbol in STATE_VARIABLES if symbol in equations}


def diffusion(noise: Noise) -> sympy.Matrix:
    """Sigma of Table 2 for a kind of noise: the unit vector of the driven variable."""
    return sympy.Matrix([int(symbol == noise.driven) for symbol in drift(noise)])
