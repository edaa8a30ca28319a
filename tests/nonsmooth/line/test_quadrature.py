"""Quadrature: exact cases, many-digit references, and errors that are never too small."""

import mpmath
import numpy as np
import pytest
from mpmath import mp

import nonsmooth as ns
from exact_gamma2 import Reference, random_velocity
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.line import eigenfunctions, quadrature
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.scenes.noises import White
from references import FRICTION

EPS = np.finfo(float).eps


@pytest.mark.slow
def test_honest_on_random_observables():
    """Value, mean and their errors against 60 digits inside, 20 outside."""
    rng = np.random.default_rng(20240)
    with mp.workdps(60):
        for _ in range(8):
            scene, g, kinks = random_velocity(rng)
            reference = Reference(scene, g, kinks)
            exact = reference.variance()
            value, error = quadrature.asymptotic_variance(scene)
            assert error < 1e-12 * value, scene
            assert abs(value - exact) <= error, scene
            value, error = quadrature.mean(scene)
            assert abs(value - float(reference.mean)) <= error + EPS * abs(value), scene


def test_honest_on_random_parameters():
    """Observable y against the closed form; sigma by the scaling y -> sigma^2 y, t -> sigma^2 t."""
    rng = np.random.default_rng(7)
    for i in range(60):
        n = np.inf if i % 10 == 0 else 10 ** rng.uniform(0, 6)
        damping, sigma = 10 ** rng.uniform(-3, 3), 10 ** rng.uniform(-1, 1)
        scene = ns.Scene("friction", White(sigma), n=n, damping=damping)
        value, error = quadrature.asymptotic_variance(scene)
        exact, own = friction_variance(n * sigma**2, damping * sigma**2)
        exact, own = sigma**6 * exact, sigma**6 * own
        assert error < 1e-12 * value, scene
        # the scaling of the parameters rounds too
        assert abs(value - exact) <= error + own + 8 * EPS * exact, scene


@pytest.mark.parametrize("n", [1, 10, 1e3, 1e6, np.inf])
@pytest.mark.parametrize("damping", [1e-3, 1.0, 1e3])
def test_closed_form(n, damping):
    """The closed form and the quadrature agree for extreme n and C_b."""
    value, error = quadrature.asymptotic_variance(ns.Scene("friction", n=n, damping=damping))
    exact, own = friction_variance(n, damping)
    assert abs(value - exact) <= error + own


NASTY = [
    ({"n": np.inf, "observable": "sign(y)"}, lambda y: {(0, 0.0): mp.sign(y)}, ()),
    (
        {"n": 1e6, "damping": 1e3, "noise": White(0.1), "observable": "y + y**2 + abs(y)"},
        lambda y: {(1, 0.0): 1 + mp.sign(y), (2, 0.0): 1},
        (),
    ),
    (
        {"n": 3, "damping": 1e-3, "observable": "max(y - 0.25, 0)*exp(y/8)"},
        lambda y: {(1, 0.125): 1, (0, 0.125): -0.25} if y > 0.25 else {(0, 0.0): 0},
        (0.25,),
    ),
    (
        {"n": 30, "observable": "friction_force"},
        lambda y: {(1, 0.0): 30} if abs(y) < 1 / mp.mpf(30) else {(0, 0.0): mp.sign(y)},
        (),
    ),
]


@pytest.mark.parametrize(("parameters", "g", "kinks"), NASTY)
def test_against_many_digits(parameters, g, kinks):
    """Value, mean and errors against 60 digits inside, 20 outside."""
    scene = ns.Scene("friction", **parameters)
    with mp.workdps(60):
        exact = Reference(scene, g, kinks).variance()
        value, error = quadrature.asymptotic_variance(scene)
        assert abs(value - exact) <= error
        assert error < 1e-12 * value


def exponential(scale2, rate):
    """gamma^2 of exp(y) for the Ornstein-Uhlenbeck process of variance `scale2`."""
    terms = mpmath.nsum(lambda j: scale2**j / (j * mpmath.factorial(j)), [1, mpmath.inf])
    return float(2 * mpmath.exp(scale2) * terms / rate)


@pytest.mark.parametrize("damping", [1e-2, 1.0, 1e2])
@pytest.mark.parametrize(
    ("observable", "exact"),
    [
        ("y", lambda s2, rate: 2 * s2 / rate),
        ("y**2", lambda s2, rate: 2 * s2**2 / rate),
        ("y**3", lambda s2, rate: 22 * s2**3 / rate),
        ("y + y**2", lambda s2, rate: (2 * s2 + 2 * s2**2) / rate),
        ("sign(y)", lambda s2, rate: 2 * np.log(2) / rate),
        ("exp(y)", exponential),
    ],
)
def test_ornstein_uhlenbeck(damping, observable, exact):
    """Without friction gamma^2 is the sum over the Hermite coefficients of g."""
    sigma = 0.5 * np.sqrt(damping)  # so that the variance is 1/8
    scene = ns.Scene("elasto_plastic", White(sigma), damping=damping, observable=observable)
    value, error = quadrature.asymptotic_variance(scene)
    truth = exact(sigma**2 / (2 * damping), damping)
    assert abs(value - truth) <= error + 8 * EPS * truth


@pytest.mark.parametrize("n", [1.0, 37.0, 1e6, np.inf])
@pytest.mark.parametrize(("damping", "sigma"), [(1e-3, 10.0), (1.0, 1.0), (1e3, 0.1)])
def test_forcing_balance(n, damping, sigma):
    """gamma^2 of the whole restoring force is the forcing's spectrum at 0: sigma^2."""
    penalty = "sign(y)" if np.isinf(n) else f"max(-1, min(1, {n}*y))"
    scene = ns.Scene(
        "friction", White(sigma), n=n, damping=damping, observable=f"{damping}*y + {penalty}"
    )
    value, error = quadrature.asymptotic_variance(scene)
    assert abs(value - sigma**2) <= error + 2 * EPS * sigma**2


@pytest.mark.parametrize("observable", ["tanh(y)", "exp(y/2)"])
def test_spectral_elements(observable):
    """The same from eigenpairs, within their rounding error; the degree has converged."""
    scene = ns.Scene("friction", n=30, observable=observable)
    value, error = quadrature.asymptotic_variance(scene)
    other = eigenfunctions.asymptotic_variance(scene, 14)
    assert abs(value - other) <= error + eigenfunctions.rounding(scene, 14) * value


@pytest.mark.parametrize(
    "observable",
    [
        "log(abs(y))",
        "abs(y)**0.3",
        "abs(y)**(-0.4)",
        "sqrt(abs(y - 0.3))",
        "abs(sin(50*y))",
        "abs(abs(y - 0.3) - 1e-9)",
        "tanh(1e4*(y - 0.2))",
        "max(0, y - 10)",
        "cosh(y) - 1 - y**2/2",
    ],
)
def test_unpleasant_observables(observable):
    """Singular, many-kinked, almost discontinuous, seen in the far tail only: 1e-10 is met."""
    value, error = quadrature.asymptotic_variance(ns.Scene("friction", observable=observable))
    assert 0 < error < 1e-10 * value


def test_constants_do_not_matter():
    """A mean a million times the fluctuations costs no digits; the mean has it."""
    plain, shifted = (ns.Scene("friction", observable=g) for g in ("y", "1e6 + y"))
    a, b = quadrature.asymptotic_variance(plain), quadrature.asymptotic_variance(shifted)
    assert a == b
    value, error = quadrature.mean(shifted)
    assert abs(value - 1e6) <= error < 1e-9


def test_cancelling_formula_is_noticed():
    """Formulas that lose digits have an error to match, or are refused."""
    scenes = [
        ns.Scene("friction", White(0.1), n=np.inf, damping=1e3, observable=g)
        for g in ("cosh(y) - 1", "2*sinh(y/2)**2")
    ]
    exact, error = quadrature.asymptotic_variance(scenes[1])
    assert error < 1e-12 * exact
    with pytest.raises(ToleranceError, match="loosen tol"):
        quadrature.asymptotic_variance(scenes[0])
    value, error = quadrature.asymptotic_variance(scenes[0], tol=1e-6)
    assert abs(value - exact) <= error


@pytest.mark.parametrize("observable", ["exp(0.6*y**2)", "exp(exp(y))", "sqrt(y)"])
def test_what_has_no_answer_is_refused(observable):
    """A g that is not square-integrable, finite and real is refused."""
    with pytest.raises(SceneError, match="choose one"):
        quadrature.asymptotic_variance(ns.Scene("friction", observable=observable))


def test_two_variables_are_refused():
    """The quadrature is over one variable."""
    with pytest.raises(SceneError, match="no deterministic solver"):
        quadrature.mean(ns.Scene("obstacle", observable="y"))


@pytest.mark.parametrize("n", [1.0, 100.0, 1e6, np.inf])
@pytest.mark.parametrize(("damping", "sigma"), [(1e-3, 10.0), (1.0, 1.0), (1e3, 0.1)])
def test_density(n, damping, sigma):
    """The density and its integral agree with 40 digits within the stated error."""
    scene = ns.Scene("friction", White(sigma), n=n, damping=damping)
    with mp.workdps(40):
        reference = Reference(scene, lambda y: {(0, 0.0): 1})
        y = np.linspace(-0.4, 0.3, 41) * float(reference.end)
        exact = [mp.exp(-reference.depth(mp.mpf(p))) / reference.total for p in y]
        value, error = quadrature.density(scene, y)
        assert all(abs(v - e) <= d for v, e, d in zip(value, exact, error, strict=True))
        top, its_error = quadrature.density(scene, 0.0)
        assert its_error < 1e-13 * top
        assert abs(top * reference.total - 1) <= its_error / top


def test_public_function_uses_it():
    """The estimate says how; a tiny C_b, for which the closed form cancels, is no obstacle."""
    found = ns.asymptotic_variance(ns.Scene("friction", observable="y**3"))
    assert found.method == "quadrature"
    assert ns.asymptotic_variance(FRICTION).method == "closed form"
    found = ns.asymptotic_variance(ns.Scene("friction", damping=1e-5))
    assert found.method == "quadrature"
    exact, own = friction_variance(100, 1e-5)
    assert abs(found.value - exact) <= found.error + own
