"""Every scheme keeps the promises of the table: weak order, stability, energy."""

import importlib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import sympy
from numpy.polynomial import legendre
from scipy import linalg, stats
from scipy.interpolate import BarycentricInterpolator

import nonsmooth as ns
from nonsmooth.errors import AssumptionWarning, SceneError
from nonsmooth.paths import ensembles, moments
from nonsmooth.paths.kernels.compiled_formulas import compiled
from nonsmooth.paths.kernels.panel import DELTA, ROWS, STATE, WIDTH, X, Y, new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.schemes.registry import SCHEMES, coefficients, scheme
from nonsmooth.paths.time_loop import march
from nonsmooth.scenes import symbols
from references import FALSE_ALARM, FRICTION

HORIZON = 10.0


def kernel_step(name, scene, h, state, normal):
    """Apply one kick and the flow to the next kick to many states; return them and int g."""
    s, own = coefficients(scene, name, h, "float64"), registry.SCHEMES[name]
    after, gain = np.empty((4, len(normal))), np.empty(len(normal))
    for first in range(0, len(normal), WIDTH):
        part = slice(first, first + WIDTH)
        data, lanes = np.zeros((ROWS, WIDTH)), len(normal[part])
        data[list(STATE), :lanes], data[0, :lanes] = state[:, part], normal[part]
        own.kick(s, data, 0, lanes)
        own.flow(s, data, False, False, lanes)
        after[:, part], gain[part] = data[list(STATE), :lanes], data[DELTA, :lanes]
    return after, gain


def linear_second_moment(name, scene, h):
    """E[D(T)^2] of a linear scene by its scheme, exactly, from the kernels' matrices."""
    rows = [i for i, s in enumerate(symbols.STATE_VARIABLES) if s.name in scene.state]
    states = np.zeros((4, len(rows) + 1))
    states[rows, range(len(rows))] = 1.0
    after, gain = kernel_step(name, scene, h, states, np.r_[np.zeros(len(rows)), 1.0])
    step = np.zeros((len(rows) + 1, len(rows) + 2))
    step[:-1, : len(rows)], step[-1, : len(rows)] = after[rows, :-1], gain[:-1]
    step[-1, -2] = 1.0
    step[:-1, -1], step[-1, -1] = after[rows, -1], gain[-1]
    matrix, noise = step[:, :-1], step[:, -1]
    # at rest at first, where the opening half-flow does nothing
    covariance = np.zeros_like(matrix)
    for _ in range(round(HORIZON / h)):
        covariance = matrix @ covariance @ matrix.T + np.outer(noise, noise)
    return covariance[-1, -1]


def linear_exact(scene):
    """E[D(T)^2] of a linear scene by the matrix exponential."""
    drift = scene.numerical_drift()
    rows = [s for s in symbols.STATE_VARIABLES if s.name in scene.state]
    size = len(rows) + 1
    matrix = np.zeros((size, size))
    at_rest = dict.fromkeys(rows, sympy.Float(1e-3))
    jacobian = sympy.Matrix([drift[s] for s in rows]).jacobian(rows).subs(at_rest).doit()
    matrix[:-1, :-1] = np.array(jacobian, dtype=float)
    matrix[-1, :-1] = [float(sympy.diff(scene.observable_expression, s)) for s in rows]
    diffusion = np.zeros((size, size))
    diffusion[0, 0] = 1.0
    block = np.block([[-matrix, diffusion], [np.zeros((size, size)), matrix.T]])
    exponential = linalg.expm(block * HORIZON)
    return (exponential[size:, size:].T @ exponential[:size, size:])[-1, -1]


def kinked_second_moment(name, scene, h):
    """E[D(T)^2] of dry friction by its scheme, from quadrature of the kernels' transition.

    The state before a kick is interpolated on Chebyshev nodes, in which everything is smooth
    on the scale sqrt(h), at least 0.07; the kick's normal number is integrated piecewise
    between the kinks of the flow that follows.
    """
    reach = 7.0
    nodes = reach * np.cos(np.pi * np.arange(301) / 300)
    points, weights = legendre.leggauss(24)
    y, normal, weight = [], [], []
    for node in nodes:
        knot = 1 / scene.n
        kinks = np.array([-knot - h, -knot, knot, knot + h])
        # where the kick's end, an affine function of the normal number, meets a kink
        start = np.array([[0], [0], [node], [0.0]])
        ends = [kernel_step(name, scene, h, start, np.full(1, v))[1][0] for v in (0.0, 1.0)]
        middle, factor = 2 * ends[0] / h - node, 2 * (ends[1] - ends[0]) / h
        edges = np.unique(np.clip(np.r_[-8, (kinks - middle) / factor, -2, 0, 2, 8], -8, 8))
        for a, b in pairwise(edges):
            y.append(np.full(24, node))
            normal.append((a + b) / 2 + (b - a) / 2 * points)
            weight.append((b - a) / 2 * weights * stats.norm.pdf(normal[-1]))
    y, normal, weight = map(np.concatenate, (y, normal, weight))
    state = np.zeros((4, len(y)))
    state[2] = y
    after, gain = kernel_step(name, scene, h, state, normal)
    owner = np.searchsorted(-nodes, -y)
    basis = BarycentricInterpolator(nodes, np.eye(len(nodes)))(np.clip(after[2], -reach, reach))

    def expect(values):
        result = np.zeros((len(nodes), *values.shape[1:]))
        np.add.at(result, owner, weight.reshape(-1, *[1] * (values.ndim - 1)) * values)
        return result

    to_next, with_gain = expect(basis), expect(gain[:, None] * basis)
    first, second = expect(gain), expect(gain**2)
    mean, square = np.zeros((2, len(nodes)))
    for _ in range(round(HORIZON / h)):
        square = second + 2 * with_gain @ mean + to_next @ square
        mean = first + to_next @ mean
    return square[150]


OSCILLATOR = ns.Scene("friction", n=1e-9, potential="x**2/2", observable="x")
RELAXATION = ns.Scene("friction", n=1e-9)
LIMIT = ns.Scene("friction", n=np.inf)


class TestOrder:
    """The measured weak order is the declared one to within 0.2."""

    @pytest.mark.parametrize("name", SCHEMES)
    @pytest.mark.parametrize("scene", [OSCILLATOR, RELAXATION], ids=["oscillator", "relaxation"])
    def test_where_the_drift_is_smooth(self, name, scene):
        """Bias of E[D^2] of linear scenes, exactly, from steps 0.05 and 0.025."""
        if not SCHEMES[name].handles(scene):
            pytest.skip("the scheme does not take this scene")
        exact = linear_exact(scene)
        biases = [linear_second_moment(name, scene, h) - exact for h in (0.05, 0.025)]
        assert abs(np.log2(biases[0] / biases[1]) - SCHEMES[name].smooth_order) < 0.2

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("name", "published"),
        [
            ("strang", (1.3e-3, 1.6e-4, 2.1e-5)),
            ("drift_implicit", (-1.3e-2, -3.0e-3, -7.7e-4)),
            ("lie", (-1.9e-2, -4.0e-3, -1.0e-3)),
        ],
    )
    def test_across_the_kink(self, name, published):
        """Bias of E[D^2]/T for friction, n = 100, by quadrature of the kernels' transition.

        The published biases, of h = 0.1, 0.02 and 0.005, have two digits, and gather int g at the
        ends of steps, which to the Strang splitting makes a difference of a tenth at h = 0.1.
        """
        exact = float(ns.variance(FRICTION, [HORIZON])["v"][0]) / HORIZON
        found = {}
        for h, bias in zip((0.1, 0.02, 0.005), published, strict=True):
            found[h] = kinked_second_moment(name, FRICTION, h) / HORIZON - exact
            assert found[h] == pytest.approx(bias, rel=0.12)
        order = np.log(found[0.02] / found[0.005]) / np.log(4)
        assert abs(order - SCHEMES[name].kink_order) < 0.2

    def test_explicit_euler_across_the_kink(self):
        """Its drift has the kink: coupled paths at n = 10, steps 0.05 and 0.025."""
        scene, order, error = ns.Scene("friction", n=10), [], []
        for h in (0.05, 0.025):
            sampling = Sampling(h, 100_000, 5, scheme="euler_maruyama")
            change, _ = ensembles.coupled(scene, [5.0], sampling)
            bias, spread = moments.step_bias(change, 1.0)
            order.append(np.log2(bias[0]))
            error.append(spread[0] / bias[0] / np.log(2))
        assert np.hypot(*error) < 0.02
        assert abs(order[0] - order[1] - SCHEMES["euler_maruyama"].kink_order) < 0.2

    def test_dry_friction_sampler(self):
        """Its kink is in the exact part: h = 0.4 and 0.2 by simulation, order 2 to within 0.2.

        The standard error of the order is that of the two relative biases, 0.035 and 0.009.
        """
        exact, paths = float(ns.variance(LIMIT, [HORIZON])["v"][0]), 2_000_000
        relative, error = [], []
        for h in (0.4, 0.2):
            sampling = Sampling(h, paths, 3, scheme="dry_friction")
            found = moments.moments(ensembles.gram(LIMIT, [HORIZON], sampling))
            relative.append(found["variance"][0] / exact - 1)
            error.append(found["variance_error"][0] / exact)
        spread = np.hypot(error[0] / relative[0], error[1] / relative[1]) / np.log(2)
        order = np.log2(relative[0] / relative[1])
        assert spread < 0.2
        assert abs(order - SCHEMES["dry_friction"].kink_order) < max(0.2, 4 * spread)


class TestStability:
    """Stable where the table says so, and not much further."""

    @pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
    @pytest.mark.parametrize("noise", ["white", "langevin", "hamiltonian"])
    @pytest.mark.parametrize("n", [1e6, np.inf])
    def test_strang_at_every_stiffness(self, model, noise, n):
        """N = 1e6 with h = 0.05: moments stay those of a confined oscillator."""
        scene = ns.Scene(model, noise, n=n, potential="x**2/2", observable="x")
        panel = new_panel(scene, 7, 0)
        march(coefficients(scene, "strang", 0.05), panel, BLOCK, 1000, -np.inf, np.inf)
        y, x = panel.data[list(STATE)[2:], :BLOCK]
        # the variance of y is at most that of the forced linear oscillator, below 2; six times
        # its root covers the block's samples
        assert np.max(np.abs(y)) < 6 * np.sqrt(2)
        if model != "friction":
            assert np.max(np.abs(x)) <= 1 + (6 * np.sqrt(2) / 1e3 if np.isfinite(n) else 0)

    @pytest.mark.parametrize("name", SCHEMES)
    def test_against_the_declared_range(self, name):
        """A stiff linear scene stays bounded below the longest step and blows up above it."""
        model = (
            "friction" if name in ("dry_friction", "drift_implicit", "lie") else "elasto_plastic"
        )
        n = np.inf if name == "dry_friction" else 1e6
        scene = ns.Scene(model, n=n, observable="y" if model == "friction" else "x")
        longest = SCHEMES[name].longest_step(scene)
        for h, stable in ((min(0.9 * longest, 0.5), True), (1.2 * longest, False)):
            if np.isfinite(h):
                panel = new_panel(scene, 2, 0)
                panel.data[Y if model == "friction" else X] += (
                    50.0  # so far that overshooting the dead zone does not save it
                )
                s = SCHEMES[name].coefficients(scene, h)
                march(s, panel, BLOCK, 2000, -np.inf, np.inf)
                bounded = np.max(np.abs(panel.data[list(STATE), :BLOCK])) < 100
                assert bounded == stable

    @pytest.mark.parametrize("n", [100.0, 1e4, 1e6, np.inf])
    def test_energy_survives_impacts(self, n):
        """Obstacle without potential, h = 0.1: E y^2 = 1/(2 C_b), within its error."""
        scene = ns.Scene("obstacle", n=n, observable="x")
        s, squares = coefficients(scene, "strang", 0.1), []
        for block in range(40):
            panel = new_panel(scene, 4, block)
            march(s, panel, BLOCK, 200, -np.inf, np.inf)
            squares.append(panel.data[Y, :BLOCK].astype(float) ** 2)
        # inside a contact part of the energy is elastic: those lanes have |x| > 1
        mean, error = np.mean(squares), np.std(squares) / np.sqrt(np.size(squares))
        assert abs(mean - 0.5) < stats.norm.isf(FALSE_ALARM / 2) * error


@pytest.mark.parametrize(
    ("scene", "name", "step"),
    [
        (ns.Scene("elasto_plastic", potential="4000*x**2"), "strang", 0.05),
        (ns.Scene("friction", ns.Langevin("50*eta**4 + eta**2")), "strang", 0.05),
        (ns.Scene("friction", n=1e4), "euler_maruyama", 1e-3),
    ],
)
def test_unstable_steps_are_refused(scene, name, step):
    """Paths that blow up would count as crossings; the message has the longest step."""
    with pytest.raises(SceneError, match=r"unstable with step .* choose one below"):
        coefficients(scene, name, step)
    assert coefficients(scene, name, SCHEMES[name].longest_step(scene) / 2) is not None


def test_a_potential_with_a_pole():
    """No step is stable: every way to choose one says so."""
    with pytest.warns(AssumptionWarning):
        scene = ns.Scene("elasto_plastic", potential="1/x")
    for ask in (
        lambda: coefficients(scene, "strang", 0.1),
        lambda: ns.crossing_probability(scene, 1.0, [1.0], method="importance_sampling"),
        lambda: ns.asymptotic_variance(scene, method="monte_carlo"),
        lambda: ns.mean(scene, method="monte_carlo"),
    ):
        with pytest.raises(SceneError, match="no time step resolves the potential '1/x'"):
            ask()


def test_requests_that_no_scheme_can_meet():
    """The error is one line that names the cure."""
    with pytest.raises(SceneError, match="scheme is 'heun'; choose from"):
        scheme(FRICTION, "heun")
    with pytest.raises(SceneError, match="choose 'strang'"):
        scheme(FRICTION, "dry_friction")
    assert scheme(LIMIT, "dry_friction") is SCHEMES["dry_friction"]
    assert scheme(FRICTION) is SCHEMES["strang"]


def test_scheme_of_the_manual(tmp_path, monkeypatch):
    """The scheme of the how-to page makes the steps of the Euler-Maruyama scheme."""
    page = Path("docs/how_to/add_a_scheme.md").read_text(encoding="utf-8")
    (tmp_path / "explicit_scheme.py").write_text(page.split("```python\n")[1].split("```")[0])
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(registry, "SCHEMES", dict(SCHEMES))
    importlib.import_module("explicit_scheme")
    # The time loop is not run with it: its cache on disk would name a module of this test only.
    scene, state = ns.Scene("friction", n=10), np.zeros((4, 3))
    state[2] = [-1.0, 0.02, 0.5]
    step = (0.05, state, np.array([0.3, -1.0, 2.0]))
    found, expected = (kernel_step(name, scene, *step) for name in ("explicit", "euler_maruyama"))
    for one, other in zip(found, expected, strict=True):
        assert np.max(np.abs(one - other)) < 1e-14
    with pytest.raises(SceneError, match="unstable with step"):
        coefficients(scene, "explicit", 0.3)


class TestSprings:
    """Springs, linear and cubic, and g = x are part of the kernels; other formulas are compiled."""

    @pytest.mark.parametrize(
        ("potential", "spring"),
        [
            ("x**2/2", (1.0, 0.0)),
            ("0.3*x**2 + 2*x**4", (0.6, 8.0)),
            ("5*x**4 - x**2", (-2.0, 20.0)),
            ("x**2*(x**2 + 1)/4", (0.5, 1.0)),
        ],
    )
    def test_a_spring_is_recognised(self, potential, spring):
        """However it is written."""
        s = coefficients(ns.Scene("obstacle", potential=potential), "strang", 0.1, "float64")
        assert s.slope == 0
        assert s.spring == pytest.approx(spring)

    @pytest.mark.parametrize(
        "potential",
        ["(x - 1)**2", "x**2/2 + x**6", "x**2/2 + cos(x)", "x**4 + abs(x)**3", "x**2 + x"],
    )
    def test_others_are_not_springs(self, potential):
        """Their slope has other terms than x and x^3."""
        s = coefficients(ns.Scene("obstacle", potential=potential), "strang", 0.1, "float64")
        assert s.slope != 0
        assert s.spring == (0, 0)

    @pytest.mark.parametrize("noise", ["white", "langevin", "hamiltonian"])
    @pytest.mark.parametrize("model", ["friction", "elasto_plastic", "obstacle"])
    @pytest.mark.parametrize("potential", ["x**2/2", "x**2/3 + x**4/4"])
    def test_paths_are_those_of_the_formulas(self, potential, model, noise):
        """To rounding: products of three factors are formed in another order."""
        scene = ns.Scene(model, noise, potential=potential, n=20, observable="x", damping=0.5)
        own = coefficients(scene, "strang", 0.05, "float64")
        other = coefficients(
            ns.Scene(model, noise, observable="x + sin(0.1*x)", potential="x**2"), "strang", 0.05
        )
        slope = sympy.diff(scene.potential_expression, symbols.x)
        formulas = own._replace(
            observable=other.observable,
            slope=compiled(slope, symbols.STATE_VARIABLES, "float64").address,
            formula=compiled(symbols.x, symbols.STATE_VARIABLES, "float64").address,
        )
        found = []
        for s in (own, formulas):
            panel = new_panel(scene, 5, 0, "float64")
            march(s, panel, BLOCK, 100, -np.inf, np.inf)
            found.append(np.vstack([panel.data[list(STATE)], panel.total]))
        assert own.observable != other.observable
        assert np.abs(found[0]).max() > 0.1
        # 100 steps; rounding grows by what the flow of the penalty amplifies, hardly at n = 20
        assert found[1] == pytest.approx(found[0], rel=1e-9, abs=1e-11)

    def test_a_linear_spring_pulls_from_afar(self):
        """Where x^2 is infinite in single precision and x is not."""
        scene = ns.Scene("friction", "langevin", potential="x**2/2", observable="x", n=10)
        s = coefficients(scene, "strang", 1e-3, "float32")
        panel = new_panel(scene, 5, 0, "float32")
        panel.data[X, 0] = 1e20
        march(s, panel, 1, 1, -np.inf, np.inf)
        assert panel.data[Y, 0] == pytest.approx(-1e17, rel=0.01)
