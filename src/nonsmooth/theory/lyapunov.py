"""The paper's Lyapunov functions V_n and their drift A_n V_n + epsilon V_n (Lemma 2 of the paper).

Everything is derived for the undefined functions of `scenes.equations`, so that the terms
delta y U'(x) of opposite sign cancel in algebra and not in floating point. Then the values of a
scene's own functions are put in. Where the displacement is not confined, as for U = 0, (HU2) does
not hold and the paper's V_n is no Lyapunov function. The velocity alone has delta y^2/2 + C_V, for
which all formulas hold with 1/lambda_3 = Gamma = 0.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy

from nonsmooth.errors import SceneError
from nonsmooth.scenes import equations
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.noises import named
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES, eta, x, y, zeta
from nonsmooth.scenes.symbols import damping as C_b
from nonsmooth.theory import assumptions, tuning

delta, epsilon, C_V, xi, K, M = sympy.symbols("delta epsilon C_V xi K M", positive=True)
R = sympy.Function("R")


@dataclass(frozen=True)
class Constants:
    """Constants that satisfy (14) and (18) of the paper, with Claim 10 mended.

    Attributes
    ----------
    delta, epsilon, C_V : float
    noise_weight : float
        xi or K, the factor of the noise's own Lyapunov function; 0 for white noise.
    restoring : float
        r or delta~; inf for white noise.
    confinement : Confinement or None
        None if the displacement is not part of the state.
    dissipation : Dissipation or None
    """

    delta: float
    epsilon: float
    C_V: float
    noise_weight: float
    restoring: float
    confinement: assumptions.Confinement | None
    dissipation: assumptions.Dissipation | None


def function(kind: str, confined: bool = True) -> sympy.Expr:
    """Return V_{n,d} of eq. (13) of the paper, an expression.

    Parameters
    ----------
    kind : {"white", "langevin", "hamiltonian"}
    confined : bool
        False for the velocity alone.
    """
    mechanical = delta * y**2 / 2 + C_V
    if confined:
        mechanical += delta * equations.U(x) + x * y
    own = {
        "white": sympy.Integer(0),
        "langevin": xi * eta**2 / 2,
        "hamiltonian": K * (equations.H(eta, zeta) + R(eta, zeta) + M),
    }
    return own[kind] + mechanical


def generator(psi: sympy.Expr, kind: str) -> sympy.Expr:
    """Return A_n psi of eq. (9) of the paper, with the drift of Table 2."""
    noise = named(kind)
    transport = sum(f * sympy.diff(psi, s) for s, f in equations.drift(noise).items())
    return sympy.diff(psi, noise.driven, 2) / 2 + transport


def drift(kind: str, confined: bool = True) -> sympy.Expr:
    """Return A_n V_n + epsilon V_n, expanded; the left-hand side of (HV2)."""
    V = function(kind, confined)
    total = generator(V, kind) + epsilon * V
    if not confined:
        total = total.subs(equations.U(x), 0).doit()
    return sympy.expand(total)


@lru_cache(maxsize=256)
def constants(scene: Scene) -> Constants:
    """Choose the constants as the paper's proof does, within one per cent of their bounds.

    epsilon is half of its bound. For the Hamiltonian noise it must be below delta~ too, and the
    bound of K has delta~ (delta~ - epsilon) in the place of delta~^2, as Claim 10 asks for.

    Parameters
    ----------
    scene : Scene
        With a finite n and noise of unit intensity.

    Returns
    -------
    Constants

    Raises
    ------
    SceneError
        If the scene is outside the paper's assumptions.
    """
    if math.isinf(scene.n):
        raise SceneError("the paper's Lyapunov functions are for finite n; choose one")
    if scene.noise.sigma != 1:
        raise SceneError("the paper's Lyapunov functions are for sigma = 1; choose it")
    free = scene.mechanics.added_potential == 0 and scene.potential_expression.is_number
    trap = None if free else assumptions.confinement(scene)
    inverse = 1 / trap.lambda_3 if trap else 0.0
    b = scene.damping
    bounds = [2 / b * (2 + 4 * (b + scene.n) ** 2 * inverse / 3)]
    if trap:
        bounds.append(1 / math.sqrt(trap.lambda_1))
    big = tuning.LYAPUNOV.slack * max(bounds)
    # the constant of eq. (25) has C_V where epsilon C_V is meant, which needs epsilon <= 1
    limits = [b, 1.0] + ([trap.lambda_3 / big] if trap else [])
    restoring, form = math.inf, None
    if scene.noise.kind == "langevin":
        restoring = assumptions.restoring_rate(scene.noise)
    elif scene.noise.kind == "hamiltonian":
        form = assumptions.dissipation(scene.noise)
        restoring = form.rate
    small = min(*limits, restoring) / 2
    need = big / b + 2 * inverse / 3
    weight = {
        "white": 0.0,
        "langevin": 8 * need / restoring,
        "hamiltonian": 4 * need / (restoring * (restoring - small)),
    }
    return Constants(
        delta=big,
        epsilon=small,
        C_V=1 + big * trap.beta_1 if trap else 1.0,
        noise_weight=tuning.LYAPUNOV.slack * weight[scene.noise.kind],
        restoring=restoring,
        confinement=trap,
        dissipation=form,
    )


def _numbers(scene):
    c = constants(scene)
    return {
        delta: c.delta,
        epsilon: c.epsilon,
        C_V: c.C_V,
        xi: c.noise_weight,
        K: c.noise_weight,
        M: c.dissipation.M if c.dissipation else 0.0,
        C_b: scene.damping,
    }


# symbols that stand for the undefined functions when the drift is evaluated
_U, _slope, _fx, _fy, _slope_v = sympy.symbols("U Uprime f_x f_y vprime", real=True)
_k, _gamma, _cross = sympy.symbols("k gamma_0 cross", real=True)
_PLACES = (_U, _slope, _fx, _fy, _slope_v, _k, _gamma, _cross)
_PARAMETERS = (delta, epsilon, C_V, xi, K, M, C_b)


@lru_cache(maxsize=16)
def _compiled(kind, confined, what):
    """Compile V_n or its drift to a function that returns its terms one by one."""
    expression = {"drift": drift, "value": function}[what](kind, confined)
    expression = expression.subs(
        {
            equations.H(eta, zeta): _k * eta**2 / 2 + zeta**2 / 2,
            equations.F(eta, zeta): _gamma,
            R(eta, zeta): _cross * eta * zeta,
        }
    ).doit()
    expression = expression.subs(
        {
            sympy.Derivative(equations.U(x), x): _slope,
            sympy.Derivative(equations.v(eta), eta): _slope_v,
            equations.f_x(x): _fx,
            equations.f_y(y): _fy,
        }
    ).subs(equations.U(x), _U)
    terms = sympy.Add.make_args(sympy.expand(expression))
    return sympy.lambdify((*STATE_VARIABLES, *_PLACES, *_PARAMETERS), terms, modules=np)


def evaluate(
    scene: Scene, z: Mapping[sympy.Symbol, np.ndarray], what: str = "drift"
) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate V_n or A_n V_n + epsilon V_n term by term.

    Parameters
    ----------
    scene : Scene
    z : dict
        Symbol -> array; the variables of the state.
    what : {"drift", "value"}

    Returns
    -------
    total, magnitude : numpy.ndarray
        The sum of the terms and of their absolute values: a few eps times the latter bounds the
        rounding error of the former.
    """
    own, tail, confined = functions(scene)
    state = [z.get(s, np.zeros(1)) for s in STATE_VARIABLES]
    places = [of(z.get(s, np.zeros(1))) for of, s in own]
    return summed(_compiled(scene.noise.kind, confined, what)(*state, *places, *tail))


@lru_cache(maxsize=64)
def functions(scene: Scene) -> tuple[list, tuple[float, ...], bool]:
    """Return what the drift is evaluated with.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    functions : list of (callable, sympy.Symbol)
        U, U', f_x, f_y and v', each with its argument.
    numbers : tuple of float
        All constants, in the order in which they are compiled.
    confined : bool
        Whether the displacement is part of the state.
    """
    c, model, noise = constants(scene), scene.mechanics, scene.noise
    U, slope = assumptions.potential(scene)
    if c.confinement:
        U += c.confinement.shift
    v = noise.potential_expression if noise.kind == "langevin" else sympy.Integer(0)
    own = (
        (U, x),
        (slope, x),
        (model.displacement_penalty, x),
        (model.velocity_penalty, y),
        (sympy.diff(v, eta), eta),
    )
    number = {penalization: sympy.Float(scene.n)}
    compiled = [(vectorised(f.subs(number), (s,)), s) for f, s in own]
    form, numbers = c.dissipation, _numbers(scene)
    quadratic = (form.stiffness, form.damping, form.cross) if form else (0.0, 0.0, 0.0)
    return compiled, (*quadratic, *(numbers[s] for s in _PARAMETERS)), c.confinement is not None


def summed(terms: Iterable[np.ndarray | float]) -> tuple[np.ndarray, np.ndarray]:
    """Return the sum of terms and the sum of their absolute values."""
    total: Any = 0.0
    magnitude: Any = 0.0
    for term in terms:
        total, magnitude = total + term, magnitude + np.abs(term)
    return total, magnitude
