"""The equations of Table 2 of the paper, with undefined functions for potentials and penalties.

The table is typeset from these expressions. `specialise` puts a scene's own functions in their
place. The tests compare the result with what the kernels of the simulation do.
"""

import sympy

from nonsmooth.scenes.models.model import oscillator
from nonsmooth.scenes.noises import (
    Hamiltonian,
    Langevin,
    Noise,
    hamiltonian_drift,
    langevin_drift,
)
from nonsmooth.scenes.penalties import n
from nonsmooth.scenes.scene import Scene
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


def specialise(expression: sympy.Expr, scene: Scene) -> sympy.Expr:
    """Replace the undefined functions by a scene's own; n and C_b stay symbols."""
    model, noise = scene.mechanics, scene.noise
    own = {
        U(x): scene.potential_expression + model.added_potential,
        f_y(y): model.velocity_penalty,
        f_x(x): model.displacement_penalty,
    }
    if isinstance(noise, Langevin):
        own[v(eta)] = noise.potential_expression
    elif isinstance(noise, Hamiltonian):
        own |= {H(eta, zeta): noise.energy, F(eta, zeta): noise.dissipation}
    return expression.subs(own).doit().subs(n, sympy.Float(scene.n))
