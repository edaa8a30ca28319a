"""Quadrature: exact cases, many-digit references, and errors that are never too small."""

from itertools import pairwise

import mpmath
import numpy as np
import pytest
from mpmath import mp

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.line import eigenfunctions, quadrature
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.scenes.noises import White
from references import FRICTION

EPS = np.finfo(float).eps


class Reference:
    """gamma^2 of piecewise g = sum of y^k exp(kappa y), the inner integral in closed form.

    Parameters
    ----------
    scene : Scene
        Dry friction.
    g : callable
        Takes a point inside a piece, returns {(k, kappa): coefficient} there.
    kinks : iterable of float
        Where g may change.
    """

    def __init__(self, scene, g, kinks=()):
        sigma2, self.damping = mp.mpf(scene.noise.sigma) ** 2, mp.mpf(scene.damping)
        self.n, self.rate = scene.n, 2 / sigma2
        self.knot = mp.mpf(0) if np.isinf(scene.n) else 1 / mp.mpf(scene.n)
        self.end = mp.sqrt(500 / (self.rate * self.damping))
        while self.depth(self.end) > 250:  # beyond there is nothing, even of exp(kappa y)
            self.end *= 0.95
        edges = {0, self.knot, -self.knot, self.end, -self.end, *map(mp.mpf, kinks)}
        self.edges = sorted(e for e in edges if abs(e) <= self.end)
        self.pieces = list(pairwise(self.edges))
        self.total = mp.fsum(self.integral({(0, 0.0): 1}, a, b) for a, b in self.pieces)
        terms = [g((a + b) / 2) for a, b in self.pieces]
        whole = [self.integral(t, a, b) for t, (a, b) in zip(terms, self.pieces, strict=True)]
        self.mean = mp.fsum(whole) / self.total
        self.terms = [t | {(0, 0.0): t.get((0, 0.0), 0) - self.mean} for t in terms]
        whole = [self.integral(t, a, b) for t, (a, b) in zip(self.terms, self.pieces, strict=True)]
        self.beyond = [mp.fsum(whole[i + 1 :]) for i in range(len(whole))]

    def coefficients(self, y):
        """Depth alpha y^2 + beta y + gamma around y."""
        if abs(y) < self.knot:
            return self.rate * (self.damping + mp.mpf(self.n)) / 2, mp.mpf(0), mp.mpf(0)
        return self.rate * self.damping / 2, self.rate * mp.sign(y), -self.rate * self.knot / 2

    def depth(self, y):
        """-log m, but for a constant."""
        alpha, beta, gamma = self.coefficients(y)
        return alpha * y**2 + beta * y + gamma

    def integral(self, terms, a, b):
        """Integral of sum of c y^k exp(kappa y - depth) by the recurrence of its moments."""
        value = mp.mpf(0)
        alpha, beta, gamma = self.coefficients((a + b) / 2)
        for kappa in {kappa for _, kappa in terms}:
            slope = beta - mp.mpf(kappa)
            root, middle = mp.sqrt(alpha), slope / (2 * alpha)
            ends = [mp.exp(-alpha * y**2 - slope * y - gamma) for y in (a, b)]
            scale = mp.exp(alpha * middle**2 - gamma) * mp.sqrt(mp.pi) / (2 * root)
            below, above = root * (a + middle), root * (b + middle)
            if above < 0:  # from the smaller ends of erfc
                below, above = -above, -below
            moments = [scale * (mp.erfc(below) - mp.erfc(above))]
            for k in range(1, max(k for k, _ in terms) + 1):
                jump = b ** (k - 1) * ends[1] - a ** (k - 1) * ends[0]
                before = (k - 1) * moments[k - 2] if k > 1 else 0
                moments.append((before - slope * moments[k - 1] - jump) / (2 * alpha))
            value += mp.fsum(c * moments[k] for (k, own), c in terms.items() if own == kappa)
        return value

    def integrand(self, i, y):
        """u'^2 m sigma^2 in piece i."""
        flux = self.integral(self.terms[i], y, self.pieces[i][1]) + self.beyond[i]
        return 2 * self.rate * flux**2 * mp.exp(self.depth(y)) / self.total

    def variance(self):
        """gamma^2 down to the depth 60, the outer integral by mpmath to 20 digits."""

        def integrand(i, y):
            with mp.workdps(60):
                return self.integrand(i, y)

        intervals = [self.divided(a, b, 60, 12) for a, b in self.pieces]
        with mp.workdps(20):
            return mp.fsum(
                mp.quad(lambda y, i=i: integrand(i, y), points)
                for i, points in enumerate(intervals)
                if len(points) > 1
            )

    def divided(self, a, b, deepest, step):
        """Points of [a, b] between which the depth changes by `step` at most, up to `deepest`."""
        points = [a]
        while points[-1] < b:
            width = b - points[-1]
            while abs(self.depth(points[-1] + width) - self.depth(points[-1])) > step:
                width /= 2
            points.append(points[-1] + width)
        return [p for p in points if self.depth(p) <= deepest]


def random_scene(rng):
    """Dry friction anywhere in the range of parameters; g with a kink, a jump, an exponential."""
    n = np.inf if rng.random() < 0.15 else 10 ** rng.uniform(0, 6)
    damping, sigma = 10 ** rng.uniform(-3, 3), 10 ** rng.uniform(-1, 1)
    length = min(sigma / np.sqrt(2 * damping), max(sigma**2 / 2, sigma / np.sqrt(2 * n)))
    kink, jump = (rng.normal(size=2) * length).tolist()
    a, b, c, d, e, f = rng.normal(size=6) * (rng.random(6) < 0.6)
    a, c, d, e = (a or 1.0) / length, c / length, d / length**2, e / length**3
    # the density falls like exp(-|y| / length) at least
    kappa = rng.choice([-1, 1]) * rng.uniform(0.02, 0.1) / length
    a, b, c, d, e, f, kappa = map(float, (a, b, c, d, e, f, kappa))
    text = (
        f"{a!r}*abs(y - {kink!r}) + {b!r}*sign(y - {jump!r}) + {c!r}*y + {d!r}*y**2"
        f" + {e!r}*y**3 + {f!r}*exp({kappa!r}*y)"
    )

    def g(y):
        side, other = mp.sign(y - kink), mp.sign(y - jump)
        terms = {
            (0, 0.0): -side * mp.mpf(a) * mp.mpf(kink) + other * mp.mpf(b),
            (1, 0.0): side * mp.mpf(a) + mp.mpf(c),
            (2, 0.0): mp.mpf(d),
            (3, 0.0): mp.mpf(e),
            (0, kappa): mp.mpf(f),
        }
        return {power: c for power, c in terms.items() if c}

    scene = ns.Scene("friction", White(sigma), n=n, damping=damping, observable=text)
    return scene, g, (kink, jump)


@pytest.mark.slow
def test_honest_on_random_observables():
    """Value, mean and their errors against 60 digits inside, 20 outside."""
    rng = np.random.default_rng(20240)
    with mp.workdps(60):
        for _ in range(12):
            scene, g, kinks = random_scene(rng)
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


@pytest.mark.parametrize(("parameters", "g", "kinks"), NASTY, ids=lambda p: str(p)[:40])
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


def test_refusals_of_scenes_and_poles():
    """Two variables are refused, and so is a pole, at which no refinement ends."""
    with pytest.raises(SceneError, match="no deterministic solver"):
        quadrature.mean(ns.Scene("obstacle"))
    with pytest.raises(ToleranceError, match="loosen tol"):
        quadrature.asymptotic_variance(ns.Scene("friction", observable="1/(y - 1)"))


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


@pytest.mark.parametrize("n", [1.0, 100.0, np.inf])
def test_poisson_slope(n):
    """The slope agrees with many digits, also far out, and is even for odd g."""
    scene = ns.Scene("friction", n=n)
    y = np.array([0.0, 1e-3, 0.009, 0.5, 1.0, 3.0, 12.0, 20.0])
    slope = quadrature.poisson_slope(scene, y)
    with mp.workdps(60):
        reference = Reference(scene, lambda y: {(1, 0.0): 1})
        for at, found in zip(y, slope, strict=True):
            at = mp.mpf(at)
            flux = mp.fsum(
                reference.integral({(1, 0.0): 1}, max(a, at), b)
                for a, b in reference.pieces
                if b > at
            )
            exact = reference.rate * flux * mp.exp(reference.depth(at))
            if at < 12:  # farther, the reference's own end is felt
                assert abs(found - exact) < 1e-13 * exact
    # far out u' = 1/(C_b + 1/y) to within y^-2 relative
    assert slope[-1] == pytest.approx(20 / 21, rel=1 / 400)
    assert np.allclose(quadrature.poisson_slope(scene, -y), slope, rtol=1e-13, atol=0)
    assert quadrature.poisson_slope(scene, 0.5).shape == ()
    with pytest.raises(SceneError, match="choose points"):
        quadrature.poisson_slope(scene, [100.0])


def test_public_function_uses_it():
    """The estimate says how; a tiny C_b, for which the closed form cancels, is no obstacle."""
    found = ns.asymptotic_variance(ns.Scene("friction", observable="y**3"))
    assert found.method == "quadrature"
    assert ns.asymptotic_variance(FRICTION).method == "closed form"
    found = ns.asymptotic_variance(ns.Scene("friction", damping=1e-5))
    assert found.method == "quadrature"
    exact, own = friction_variance(100, 1e-5)
    assert abs(found.value - exact) <= found.error + own
