"""The equations of Table 2 with undefined functions in the place of a scene's own.

The table is typeset from these expressions; `specialise` turns them into a scene's drift, which
the tests compare with what the kernels do.
"""

import sympy

from nonsmooth.scenes.models.model import oscillator
from nonsmooth.scenes.noises import hamiltonian_drift, langevin_drift
from nonsmooth.scenes.penalties import n
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


def drift(noise):
    """F_n of Table 2 for a kind of noise, a dict in the order of the state."""
    equations = _NOISE_DRIFT[noise.kind] | oscillator(
        f_y(y), f_x(x), sympy.diff(U(x), x), noise.forcing
    )
    return {symbol: equations[symbol] for symbol in STATE_VARIABLES if symbol in equations}


def diffusion(noise):
    """Sigma of Table 2 for a kind of noise: the unit vector of the driven variable."""
    return sympy.Matrix([int(symbol == noise.driven) for symbol in drift(noise)])


def specialise(expression, scene):
    """Replace the undefined functions by a scene's own; n and C_b stay symbols."""
    model, noise = scene.mechanics, scene.noise
    own = {
        U(x): scene.potential_expression + model.added_potential,
        f_y(y): model.velocity_penalty,
        f_x(x): model.displacement_penalty,
    }
    if noise.kind == "langevin":
        own[v(eta)] = noise.potential_expression
    elif noise.kind == "hamiltonian":
        own |= {H(eta, zeta): noise.energy, F(eta, zeta): noise.dissipation}
    return expression.subs(own).doit().subs(n, sympy.Float(scene.n))
