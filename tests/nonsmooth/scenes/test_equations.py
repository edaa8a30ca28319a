"""The typeset equations are the equations that the kernels integrate."""

import itertools
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy

import nonsmooth as ns
from nonsmooth.scenes import equations, symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.models.friction import FRICTION
from nonsmooth.scenes.models.obstacle import OBSTACLE
from nonsmooth.scenes.penalties import n
from nonsmooth.scenes.symbols import STATE_VARIABLES, x, y
from support import one_step, specialised

NOISES = {
    "white": "white",
    "langevin": ns.OrnsteinUhlenbeck(theta=1.3),
    "langevin, affine": ns.Langevin("eta**2/2 + eta"),
    "langevin, quartic": ns.Langevin("eta**4/4 + eta**2/2", sigma=0.8),
    "hamiltonian": ns.KanaiTajimi(stiffness=2.0, damping=0.7),
    "hamiltonian, general": ns.Hamiltonian("zeta**2/2 + eta**4/4 + eta**2", "1 + 0.1*eta**2"),
}


def kernel_velocity(scene, z, h):
    """Change per time of the splitting's deterministic part over a short step h."""
    return (one_step(scene, z, h) - z) / h


@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("noise", NOISES)
def test_typeset_drift_is_the_kernels_drift(model, noise):
    """Table 2 with the functions of Table 3 substituted equals the kernel's motion as h -> 0."""
    scene = ns.Scene(
        model, NOISES[noise], n=7.0, damping=0.6, potential="x**2/2 + 0.3*cos(x)", observable="x"
    )
    typeset = {
        s: specialised(f, scene).subs(symbols.damping, scene.damping)
        for s, f in equations.drift(scene.noise).items()
    }
    rng = np.random.default_rng(5)
    position = [i for i, s in enumerate(STATE_VARIABLES) if s in typeset]
    functions = [vectorised(f, STATE_VARIABLES) for f in typeset.values()]
    for _ in range(20):
        z = np.zeros(4)
        z[position] = rng.normal(size=len(position)) * 1.3
        drift = [float(f(*z)) for f in functions]
        h = 1e-6
        # one step is h F + h^2/2 F'F: first-order accurate, with |F' F| of order n^2 times |z|
        assert np.allclose(kernel_velocity(scene, z, h)[position], drift, atol=2e3 * h, rtol=0)


@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("noise", NOISES)
def test_scene_and_table_have_one_drift(model, noise):
    """`Scene.drift`, from which the PDE coefficients derive, is Table 2's expression."""
    scene = ns.Scene(model, NOISES[noise], n=3.0, potential="x**2", observable="x")
    rng = np.random.default_rng(6)
    numbers = {s: sympy.Float(value) for s, value in zip(STATE_VARIABLES, rng.normal(size=4))}  # noqa: B905
    numbers[symbols.damping] = sympy.Float(scene.damping)
    for s, f in scene.numerical_drift().items():
        typeset = specialised(equations.drift(scene.noise)[s], scene)
        assert float(typeset.subs(numbers)) == pytest.approx(float(f.subs(numbers)), rel=1e-12)


@pytest.mark.parametrize(("kind", "driven"), [("white", 0), ("langevin", 0), ("hamiltonian", 0)])
def test_noise_acts_on_the_first_variable_only(kind, driven):
    """Sigma is the unit vector of Table 2, and the kernel's increment moves that variable."""
    scene = ns.Scene("obstacle", kind, n=5.0)
    sigma = list(equations.diffusion(scene.noise))
    assert sigma == [int(i == driven) for i in range(len(scene.variables))]
    z = [0.1, 0.2, 0.3, 0.4]
    moved = np.abs(one_step(scene, z, 1e-8, (1.0, 0.0)) - one_step(scene, z, 1e-8)) > 1e-6
    names = [s.name for s in STATE_VARIABLES]
    assert [name for name, m in zip(names, moved, strict=True) if m] == [scene.state[0]]


def test_table_3_potential_gives_the_obstacle_force():
    """U_n' - U' of the typeset potential is the penalty force of the kernels."""
    obstacle = OBSTACLE
    difference = sympy.diff(obstacle.added_potential, x) - obstacle.penalty_force
    for value, number in itertools.product((-2.5, -0.5, 0.3, 1.7), (2, 100)):
        assert float(difference.subs({x: value, n: number})) == 0
    assert obstacle.velocity_penalty == obstacle.displacement_penalty == 0
    assert FRICTION.velocity_penalty.free_symbols == {y, n}


@pytest.mark.parametrize("n", [100, 3.7, float("inf")])
@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("noise", NOISES)
def test_a_notebook_shows_the_equations(model, noise, n):
    """MathML that an XML parser reads, and LaTeX that matplotlib's parser does, but for cases."""
    scene = ns.Scene(model, NOISES[noise], n=n, potential="x**2/2 + 0.3*cos(x)", observable="x")
    shown = ElementTree.fromstring(scene._repr_html_().replace("&InvisibleTimes;", "&#x2062;"))
    space = "{http://www.w3.org/1998/Math/MathML}"
    assert len(shown.findall(f".//{space}math")) == len(scene.variables) + 3
    rates = [over.findtext(f"{space}mi") for over in shown.iter(f"{space}mover")]
    names = {"zeta": "ζ", "eta": "η"}
    assert [r for r in rates if r != "W"] == [names.get(s.name, s.name) for s in scene.variables]
    assert "piecewise" not in scene._repr_html_()
    text = scene._repr_latex_()
    assert text.count(r"\dot{W}") == 1
    assert text.count("{") == text.count("}")
