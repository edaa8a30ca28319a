"""The constants of the standing assumptions do what the assumptions ask of them."""

import numpy as np
import pytest
import sympy

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.symbols import eta, x, zeta
from nonsmooth.theory import assumptions, lyapunov

POTENTIALS = ["x**2/2", "x**2/2 + 0.3*cos(3*x)", "x**2/2 + 4*exp(-x**2)", "x**2 - 3*cos(x)"]
# not the points at which the constants were computed
LINE = np.concatenate([s * np.geomspace(3e-7, 9e5, 4003) for s in (-1, 1)])


@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("potential", POTENTIALS)
@pytest.mark.parametrize("n", [1, 100, 1e4])
def test_confinement(model, potential, n):
    """U, shifted to be positive, satisfies (HU2) to (HU5) and sign(x) U' >= -beta_4."""
    scene = ns.Scene(model, potential=potential, n=n, observable="x")
    c = assumptions.confinement(scene)
    U, slope = (vectorised(e, (x,))(LINE) for e in assumptions.potential(scene))
    U = U + c.shift
    rounding = 1e-12 * (1 + n) * LINE**2
    assert min(c.lambda_1, c.beta_1, c.lambda_2, c.beta_2) > 0
    assert (U >= -1e-9).all()
    assert (U - c.lambda_1 * LINE**2 + c.beta_1 >= -rounding).all()
    assert (LINE * slope - c.lambda_2 * U + c.beta_2 >= -rounding).all()
    assert (LINE * slope - c.lambda_3 * (U + LINE**2) + c.beta_3 >= -rounding).all()
    assert (np.sign(LINE) * slope + c.beta_4 >= 0).all()


def test_confinement_of_the_parabola():
    """The constants of x^2/2 are known: U/x^2 = 1/2, and x U'/U = 2, of which half is taken."""
    c = assumptions.confinement(ns.Scene("friction", potential="x**2/2", observable="x"))
    assert c.lambda_1 == pytest.approx(0.25, rel=1e-12)
    assert c.lambda_2 == pytest.approx(1.0, rel=1e-12)
    assert c.lambda_3 == pytest.approx(0.2, rel=1e-12)
    assert c.shift == 0


@pytest.mark.parametrize(
    ("potential", "offender"), [("0", "HU2"), ("abs(x)", "HU2"), ("x**4", "HU1"), ("-x**2", "HU2")]
)
def test_potentials_outside_the_assumptions(potential, offender):
    """The error is one line that names the assumption."""
    with pytest.raises(SceneError, match=offender):
        assumptions.confinement(ns.Scene("elasto_plastic", potential=potential))


def test_walls_confine():
    """U = 0 satisfies (HU2) with obstacles: the penalty is part of U_n."""
    c = assumptions.confinement(ns.Scene("obstacle", potential="0", n=8))
    assert c.lambda_1 == pytest.approx(2.0, rel=1e-5)  # half of n/2, up to the walls' position


def test_restoring_rate():
    """The largest r: theta for the quadratic v, the curvature at 0 for the quartic one."""
    assert assumptions.restoring_rate(ns.OrnsteinUhlenbeck(3.0)) == pytest.approx(3, rel=1e-8)
    quartic = ns.Langevin("eta**4/4 + eta**2/2")
    assert assumptions.restoring_rate(quartic) == pytest.approx(1, rel=1e-8)
    with pytest.raises(SceneError, match="restores everywhere"):
        assumptions.restoring_rate(ns.Langevin("eta**4/4 - eta**2/2"))


@pytest.mark.parametrize(
    ("stiffness", "damping"), [(1, 1), (1, 0.01), (2, 0.6), (0.1, 5), (100, 1), (4, 2)]
)
def test_dissipation(stiffness, damping):
    """(T117) and (T120) hold as quadratic forms of the generator's own algebra."""
    noise = ns.KanaiTajimi(stiffness, damping)
    c = assumptions.dissipation(noise)
    energy = noise.energy + c.cross * eta * zeta
    generated = sympy.diff(energy, zeta, 2) / 2
    generated += sum(f * sympy.diff(energy, s) for s, f in noise.drift.items())
    rounding = 1e-12 * (stiffness + damping)
    assert c.rate > 0
    for margin in (
        energy + c.M - c.rate * (eta**2 + zeta**2),
        -generated - c.rate * energy + c.M,
    ):
        form = np.array(sympy.hessian(margin, (eta, zeta)), dtype=float) / 2
        assert np.linalg.eigvalsh(form)[0] >= -rounding
        assert float(margin.subs({eta: 0, zeta: 0})) >= 0
    assert np.allclose(
        -np.array(sympy.hessian(generated, (eta, zeta)), dtype=float) / 2, c.decay, rtol=1e-14
    )


def test_light_damping_dissipates_exactly():
    """L(H + R) = 1/2 - gamma_0 (H + R), so that delta~ is gamma_0."""
    c = assumptions.dissipation(ns.KanaiTajimi(1.0, 0.25))
    assert np.allclose(c.decay, 0.25 * c.energy, rtol=1e-14)
    assert c.rate == pytest.approx(0.25, rel=1e-8)


def test_unknown_hamiltonians_are_refused():
    """The paper assumes their R."""
    scene = ns.Scene("friction", ns.Hamiltonian("eta**4/4 + eta**2/2 + zeta**2/2", "1"))
    with pytest.raises(SceneError, match="the paper assumes one"):
        lyapunov.constants(scene)
