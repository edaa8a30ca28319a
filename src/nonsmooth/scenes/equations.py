"""The equations of motion as they are written.

`drift` and `diffusion` are Table 2 of the paper, with undefined functions for potentials and
penalties. The table is typeset from these expressions. The tests put a scene's own functions in
their place and compare the result with what the kernels of the simulation do.

`of_motion` are those of one scene, which notebooks show as `latex` and as `mathml`.
"""

import re

import sympy

from nonsmooth.scenes.models.model import Model, oscillator
from nonsmooth.scenes.noises import Noise, hamiltonian_drift, langevin_drift
from nonsmooth.scenes.symbols import STATE_VARIABLES, damping, eta, x, y, zeta

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


PENALTY_FORCE = sympy.Function(r"\varphi'")
_RATES = {symbol: sympy.Symbol(f"{symbol.name}dot") for symbol in STATE_VARIABLES}
_WHITE_NOISE = sympy.Symbol("Wdot")
_MARKUP = {  # of what sympy's printer for MathML does not know
    r"<mi>(\w)dot</mi>": r"<mover><mi>\1</mi><mo>˙</mo></mover>",
    "<mi>etadot</mi>": "<mover><mi>η</mi><mo>˙</mo></mover>",
    "<mi>zetadot</mi>": "<mover><mi>ζ</mi><mo>˙</mo></mover>",
    r"<mi>\\varphi'</mi>": "<mi>φ′</mi>",
    "<mo>-</mo>": "<mo>−</mo>",
    "<mo><</mo>": "<mo>&lt;</mo>",
}


def of_motion(
    model: Model, noise: Noise, potential: sympy.Expr, viscosity: float
) -> list[sympy.Eq]:
    """Write the equations of motion of a scene, with phi' for the penalty force.

    Parameters
    ----------
    model : Model
    noise : Noise
    potential : sympy.Expr
        U(x).
    viscosity : float
        C_b, "1".

    Returns
    -------
    list of sympy.Eq
        One for each variable of the state; Wdot stands for white noise.
    """
    force = PENALTY_FORCE(model.argument)
    right = noise.drift | oscillator(
        force if model.is_friction else sympy.Integer(0),
        force if model.is_plastic else sympy.Integer(0),
        sympy.diff(potential, x) + (force if model.in_potential else 0),
        noise.forcing,
    )
    right[noise.driven] += plain(noise.sigma) * _WHITE_NOISE
    return [
        sympy.Eq(_RATES[s], plain(right[s].subs(damping, viscosity)), evaluate=False)
        for s in STATE_VARIABLES
        if s in right
    ]


def plain(expression: sympy.Expr | float) -> sympy.Expr:
    """Write whole numbers without a point, and others with few digits."""
    expression = sympy.sympify(expression)
    return expression.xreplace(
        {
            number: sympy.Integer(int(number))
            if float(number).is_integer()
            else sympy.Float(number, 6)
            for number in expression.atoms(sympy.Float)
        }
    )


def latex(expression: sympy.Basic) -> str:
    """Write an expression or an equation in LaTeX."""
    return sympy.latex(expression)


def mathml(expression: sympy.Basic) -> str:
    """Write an expression or an equation in MathML, which browsers show without a script."""
    return f'<math xmlns="http://www.w3.org/1998/Math/MathML">{_marked_up(expression)}</math>'


def _marked_up(expression):
    if isinstance(expression, sympy.Eq):
        left, right = map(_marked_up, expression.args)
        return f"<mrow>{left}<mo>=</mo>{right}</mrow>"
    if isinstance(expression, sympy.Piecewise):
        rows = "".join(
            f"<mtr><mtd>{_marked_up(value)}</mtd><mtd>{_condition(where)}</mtd></mtr>"
            for value, where in expression.args
        )
        return f"<mrow><mo>{{</mo><mtable>{rows}</mtable></mrow>"
    text = sympy.mathml(expression, printer="presentation")
    for found, meant in _MARKUP.items():
        text = re.sub(found, meant, text)
    return text


def _condition(where):
    return "<mtext>otherwise</mtext>" if where == sympy.true else _marked_up(where)
