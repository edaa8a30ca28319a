"""The equations of a scene as LaTeX: of motion, of its element, and of the ground."""

import math

import sympy

from nonsmooth.dimensions import Structure
from nonsmooth.scenes import equations
from nonsmooth.scenes.scene import Scene

_REACTIONS = {
    # rigid, and penalized
    "friction": (
        r"F_s\,\operatorname{sign}(\dot x)",
        r"F_s\,\operatorname{clip}(n \dot x\,T/L, -1, 1)",
    ),
    "obstacle": (r"R", r"K\,(x - \operatorname{clip}(x, -d, d))"),
}


def of_structure(structure: Structure, n: float) -> list[str]:
    """Return the equations of a structure in SI units.

    Parameters
    ----------
    structure : Structure
    n : float
        Penalization.

    Returns
    -------
    list of str
        LaTeX.
    """
    rigid = math.isinf(n)
    spring = "k x + " if structure.stiffness > 0 else ""
    if structure.model == "elasto_plastic":
        found = [r"m \ddot x + c \dot x + k z = -m a"]
        found.append(
            r"\dot z = \dot x \text{ while } |k z| < F_y, \text{ else } \dot z = 0 "
            r"\text{ until } \dot x \text{ turns}"
            if rigid
            else r"\dot z = \dot x - \frac{n}{T} (z - \operatorname{clip}(z, -d, d)),"
            r" \quad d = F_y / k"
        )
    else:
        reaction = _REACTIONS[structure.model][not rigid]
        found = [rf"m \ddot x + c \dot x + {spring}{reaction} = -m a"]
        if structure.model == "obstacle" and rigid:
            found.append(r"|x| \le d, \quad R \ne 0 \text{ only where } |x| = d")
    if structure.ground_frequency is None:
        return [*found, r"a \text{ white noise of density } S_0"]
    filtered = r"\ddot a + 2 \zeta_g \omega_g \dot a + \omega_g^2 a = \omega_g^2 w"
    return [*found, filtered + r", \quad w \text{ white noise of density } S_0"]


def of_scene(scene: Scene) -> list[str]:
    """Return the dimensionless equations of a scene, table 2 of the paper with its functions.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of str
        LaTeX.
    """
    noise, model = scene.noise, scene.mechanics
    zero = {equations.f_y(equations.y): 0} if not model.is_friction else {}
    zero |= {equations.f_x(equations.x): 0} if not model.is_plastic else {}
    found = []
    for symbol, drift in equations.drift(noise).items():
        right = sympy.latex(_known(drift.subs(zero), scene))
        driven = r" + \sigma \dot W" if symbol == noise.driven else ""
        found.append(rf"\dot {sympy.latex(symbol)} = {right}{driven}")
    rigid = math.isinf(scene.n)
    if model.is_friction:
        law = r"\operatorname{sign}(y)" if rigid else r"\operatorname{clip}(n y, -1, 1)"
        found.append(rf"f_{{n,y}}(y) = {law}")
    elif model.is_plastic:
        found.append(
            r"|x| \le 1, \quad f_{n,x} \ne 0 \text{ only where } |x| = 1"
            if rigid
            else r"f_{n,x}(x) = n (x - \operatorname{clip}(x, -1, 1))"
        )
    elif rigid:
        found.append(r"|x| \le 1, \text{ reflected at } \pm 1")
    found.append(rf"g = {_observable(scene)}")
    return found


def _known(drift, scene):
    """Put the scene's own functions into an equation of table 2, but not its penalties."""
    noise = scene.noise
    own = {equations.U(equations.x): scene.potential_expression}
    if noise.kind == "langevin":
        own[equations.v(equations.eta)] = noise.potential_expression
    elif noise.kind == "hamiltonian":
        own[equations.H(equations.eta, equations.zeta)] = noise.energy
        own[equations.F(equations.eta, equations.zeta)] = noise.dissipation
    found = drift.subs(own).doit()
    if scene.mechanics.in_potential and not math.isinf(scene.n) and drift.has(equations.U):
        x = equations.x
        found -= sympy.Symbol("n") * (x - sympy.Function(r"\operatorname{clip}")(x, -1, 1))
    return found.xreplace({number: _rounded(number) for number in found.atoms(sympy.Float)})


def _rounded(number):
    short = float(f"{float(number):.4g}")
    return sympy.Integer(short) if short.is_integer() else sympy.Float(short, 4)


def _observable(scene):
    if scene.observes_penalty_force:
        return rf"\text{{{scene.observable.replace('_', ' ')}}}"
    return sympy.latex(scene.observable_expression)
