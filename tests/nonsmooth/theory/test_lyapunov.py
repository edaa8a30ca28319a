"""The drift of the Lyapunov functions is the paper's expansion, and its bounds are its own."""

import numpy as np
import pytest
import sympy

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.scenes import equations
from nonsmooth.scenes.symbols import STATE_VARIABLES, eta, x, y, zeta
from nonsmooth.theory import assumptions, lyapunov
from nonsmooth.theory.lyapunov import C_V, C_b, K, M, delta, epsilon, xi
from support import specialised

U, slope = equations.U(x), sympy.Derivative(equations.U(x), x)
F_X, F_Y = equations.f_x(x), equations.f_y(y)
S_1 = delta * epsilon * U - slope * (x + delta * F_X)
S_2 = -y * (x * (C_b - epsilon) + F_X) - F_Y * (delta * y + x)
EXPANSION = delta / 2 + epsilon * C_V + y**2 * (1 - delta * (C_b - epsilon / 2)) + S_1 + S_2


def test_expansion_white():
    """The drift of V is eq. (expansion-V2) as printed."""
    assert sympy.expand(lyapunov.drift("white") - EXPANSION) == 0


def test_expansion_langevin():
    """The drift of V is eq. (expansion-V3) as printed."""
    v = sympy.diff(equations.v(eta), eta)
    S_3 = xi / 2 - v * xi * eta + epsilon * xi * eta**2 / 2
    printed = S_3 + eta * (delta * y + x) + EXPANSION - delta / 2
    assert sympy.expand(lyapunov.drift("langevin") - printed) == 0


def test_expansion_hamiltonian():
    """The drift of V is eq. (expansion-V4) as printed."""
    Gamma = K * (equations.H(eta, zeta) + lyapunov.R(eta, zeta) + M)
    B = equations.drift(ns.Scene("friction", "hamiltonian").noise)
    S_4 = sympy.diff(Gamma, zeta, 2) / 2 + epsilon * Gamma
    S_4 += sum(B[s] * sympy.diff(Gamma, s) for s in (zeta, eta))
    printed = S_4 + eta * (delta * y + x) + EXPANSION - delta / 2
    assert sympy.expand(lyapunov.drift("hamiltonian") - printed) == 0


def drift_of(scene):
    """Return A_n V_n + epsilon V_n of a scene with a confined displacement, a formula."""
    c = lyapunov.constants(scene)
    own = {U: assumptions.potential(scene)[0] + c.confinement.shift}
    if c.dissipation:
        own[lyapunov.R(eta, zeta)] = c.dissipation.cross * eta * zeta
    numbers = {
        **{delta: c.delta, epsilon: c.epsilon, C_V: c.C_V, C_b: scene.damping},
        **{xi: c.noise_weight, K: c.noise_weight, M: c.dissipation.M if c.dissipation else 0.0},
    }
    expression = lyapunov.drift(scene.noise.kind).subs(own).doit()
    return specialised(expression, scene).subs(numbers)


@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("noise", ["white", "langevin", "hamiltonian"])
def test_evaluation_is_the_expression(model, noise):
    """Numbers term by term against the scene's own expression in 50 digits."""
    scene = ns.Scene(model, noise, n=7, potential="x**2/2 + 0.3*cos(3*x)", damping=0.4)
    expression = drift_of(scene)
    rng = np.random.default_rng(3)
    for size in (0.1, 2.0, 1e3, 1e6):
        z = {s: size * rng.normal(size=1) for s in scene.variables}
        value, terms = lyapunov.evaluate(scene, z)
        exact = expression.subs({s: sympy.Float(v[0], 50) for s, v in z.items()}).evalf(50)
        # 24 operations of half an ulp for each term
        assert abs(value[0] - float(exact)) <= 12 * np.finfo(float).eps * terms[0]


@pytest.mark.parametrize("noise", ["white", "langevin", "hamiltonian"])
def test_drift_is_the_generator_of_the_scene(noise):
    """The drift is that of finite differences of V along the drift of the kernels."""
    scene = ns.Scene("elasto_plastic", noise, n=3, potential="x**2/2")
    c = lyapunov.constants(scene)
    z = dict(zip(STATE_VARIABLES, (0.3, -0.7, 0.9, 1.8), strict=True))
    z = {s: z[s] for s in scene.variables}
    speed = {s: float(f.subs(z)) for s, f in scene.numerical_drift().items()}

    def V(shift, direction):
        at = {s: np.array([z[s] + shift * direction.get(s, 0.0)]) for s in z}
        return float(lyapunov.evaluate(scene, at, "value")[0][0])

    h = 1e-3  # V is quadratic here: central differences are exact but for rounding
    transport = (V(h, speed) - V(-h, speed)) / (2 * h)
    driven = {scene.noise.driven: 1.0}
    diffusion = (V(h, driven) - 2 * V(0, driven) + V(-h, driven)) / (2 * h**2)
    expected = transport + diffusion + c.epsilon * V(0, {})
    value, terms = lyapunov.evaluate(scene, {s: np.array([v]) for s, v in z.items()})
    assert value[0] == pytest.approx(expected, abs=8 * np.finfo(float).eps / h**2 * terms[0])


@pytest.mark.parametrize("noise", ["white", "langevin", "hamiltonian"])
@pytest.mark.parametrize("potential", ["0", "x**2/2"])
def test_constants_satisfy_the_boxed_inequalities(noise, potential):
    """The inequalities (14) and (18) of the paper, and epsilon < delta~."""
    n = 5
    scene = ns.Scene("friction", noise, n=n, potential=potential, damping=0.5)
    c, b = lyapunov.constants(scene), scene.damping
    inverse, beta_1 = 0.0, 0.0
    if potential != "0":
        trap = c.confinement
        inverse, beta_1 = 1 / trap.lambda_3, trap.beta_1
        assert c.delta > 1 / trap.lambda_1**0.5
        assert c.epsilon < trap.lambda_3 / c.delta
    assert c.delta > 2 / b * (2 + 4 * (b + n) ** 2 * inverse / 3)
    assert c.C_V - c.delta * beta_1 >= 1 - 1e-12
    assert 0 < c.epsilon < min(b, c.restoring)
    need = c.delta / b + 2 * inverse / 3
    if noise == "langevin":
        assert c.noise_weight > 8 / c.restoring * need
    if noise == "hamiltonian":
        assert c.noise_weight > 4 / (c.restoring * (c.restoring - c.epsilon)) * need


@pytest.mark.parametrize(
    ("scene", "offender"),
    [
        ({"n": float("inf")}, "finite n"),
        ({"noise": ns.White(2.0)}, "sigma = 1"),
        ({"potential": "x**4"}, "HU1"),
    ],
)
def test_scenes_outside_the_proof_are_refused(scene, offender):
    """The error is one line that names the reason."""
    with pytest.raises(SceneError, match=offender):
        lyapunov.constants(ns.Scene("friction", **scene))
