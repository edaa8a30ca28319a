"""Simulation: the same bits however it is run, the right laws, the right limits."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate, stats

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.paths.ensembles import coupled, gram, paths_at
from nonsmooth.paths.kernels.panel import ETA, ZETA, new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.moments import moments, step_bias
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.schemes.registry import coefficients, on_given_increments
from nonsmooth.paths.simulation import simulate
from nonsmooth.paths.time_grids import equal_steps, logarithmic
from nonsmooth.paths.time_loop import march_pair
from references import FALSE_ALARM, FRICTION


def test_spelling_of_a_number_changes_no_stream():
    """Damping 1 and 1.0 are the same scene; a start outside the limit's walls is no obstacle."""
    ends = [
        paths_at(ns.Scene("obstacle", damping=c, start={"x": 2}), [0.5], Sampling(0.1, 3, 1))
        for c in (1, 1.0, np.float64(1.0))
    ]
    assert np.array_equal(ends[0], ends[1])
    assert np.array_equal(ends[0], ends[2])


def test_number_of_threads_changes_no_bit():
    """One and three threads give identical sums."""
    runs = [gram(FRICTION, [0.5, 1.0], Sampling(0.05, 5 * BLOCK + 7, 9, threads=k)) for k in (1, 3)]
    assert np.array_equal(*runs)


def test_shards_are_parts_of_the_whole():
    """Sums of two shards, added in order, are the sums of one run, to the last bit."""
    whole = gram(FRICTION, [0.5], Sampling(0.1, 2 * BLOCK + 40, 3))
    shards = [(0, BLOCK), (BLOCK, BLOCK), (2 * BLOCK, 40)]
    parts = [gram(FRICTION, [0.5], Sampling(0.1, count, 3, first)) for first, count in shards]
    assert np.array_equal(whole, sum(parts))


def test_paths_do_not_depend_on_their_neighbours():
    """A block's first paths are the same whether the others are asked for or not."""
    few, many = (paths_at(FRICTION, [0.5, 1.0], Sampling(0.1, count, 3)) for count in (5, BLOCK))
    assert np.array_equal(few, many[..., :5])


def test_streams_differ_between_seeds():
    """No two runs share a sample."""
    seeds = (1, 2, (1, "a"), (1, 0))
    ends = [paths_at(FRICTION, [0.5], Sampling(0.1, 10, seed))[-1, 0] for seed in seeds]
    assert len(np.unique(ends)) == np.size(ends)


@pytest.mark.parametrize(
    ("model", "rate", "n", "step"),
    [
        ("elasto_plastic", 1.0, (1e2, 1e4), 5e-4),
        ("friction", 1.44, (10, 40), 5e-5),
        ("obstacle", 0.27, (1e2, 1e4), 5e-4),
    ],
)
def test_penalised_paths_converge_to_the_limit_on_the_same_noise(model, rate, n, step):
    """Sup |X^n - X^inf|, for friction sup |Y^n - Y^inf|, falls at the rates known empirically.

    To within 0.25, as the mean over 60 paths of a skewed quantity allows. Friction needs
    steps well below n^(-2), the time in which the noise crosses the kink; beyond, the splitting's
    own difference is what one sees.
    """
    scene = ns.Scene(model, potential="0", observable="x")
    runs = {
        k: simulate(scene.with_n(k), 3.0, step=step, paths=60, seed=8, keep="paths")
        for k in (*n, np.inf)
    }
    name = "y" if model == "friction" else "x"
    error = [np.mean(np.max(np.abs(runs[k][name] - runs[np.inf][name]).values, axis=1)) for k in n]
    slope = np.log(error[0] / error[1]) / np.log(n[1] / n[0])
    assert slope > rate - 0.25


@pytest.mark.parametrize("n", [10.0, 1e4, np.inf])
def test_obstacle_has_the_gibbs_law_with_twice_the_damping(n):
    """Density of (y, x) proportional to exp(-2 C_b H_n), the mended formula; C_b = 0.7."""
    damping, paths = 0.7, 20_000
    scene = ns.Scene("obstacle", n=n, damping=damping, potential="x**2/2")
    # the slowest rate is about C_b/2: exp(-14) of the start is left
    run = simulate(scene, 40.0, step=0.1, paths=paths, seed=5, times=[40.0], keep="paths")
    y, x = run["y"].values[:, -1], run["x"].values[:, -1]
    assert stats.kstest(y, stats.norm(scale=np.sqrt(1 / (2 * damping))).cdf).pvalue > FALSE_ALARM
    grid = np.linspace(-3, 3, 6001) if np.isfinite(n) else np.linspace(-1, 1, 2001)
    depth = np.maximum(np.abs(grid) - 1, 0)
    energy = grid**2 / 2 + (n / 2 * depth**2 if np.isfinite(n) else 0)
    cumulative = integrate.cumulative_simpson(np.exp(-2 * damping * energy), x=grid, initial=0)
    law = stats.kstest(x, lambda u: np.interp(u, grid, cumulative / cumulative[-1]))
    # the step's bias is of order h^2 = 1e-2 times the curvature of U: below the resolution of
    # 20000 samples at this rate, which is 0.02 in the distribution function
    assert law.pvalue > FALSE_ALARM
    # velocity and displacement are independent
    assert abs(np.corrcoef(y, x)[0, 1]) < stats.norm.isf(FALSE_ALARM / 2) / np.sqrt(paths)


@pytest.mark.parametrize("control", [False, True])
@pytest.mark.parametrize("n", [2, 100, 1e6, np.inf])
def test_monte_carlo_agrees_with_spectral_elements(n, control):
    """V within z standard errors plus the step's bias, jointly over the times."""
    scene, tau = ns.Scene("friction", n=n), np.array([0.1, 1.0, 5.0])
    sample = moments(gram(scene, tau, Sampling(0.02, 40_000, 2), control))
    exact = ns.variance(scene, tau, tol=1e-6)["v"].values
    z = stats.norm.isf(FALSE_ALARM / 2 / len(tau))
    # bias at h = 0.02, T = 10 known by exact quadrature: 1.6e-4 of v/T, its order 1.5 in h
    bias = 3e-4 * tau
    assert np.all(np.abs(sample["variance"] - exact) < z * sample["variance_error"] + bias)
    assert np.all(np.abs(sample["mean"]) < z * sample["mean_error"])


def test_control_variate_leaves_a_fraction_of_the_error():
    """D^2 less its regression on M^2 - <M> leaves R (2 M + R), R bounded, and the spread of <M>.

    Their standard deviations grow like T^(1/2), against T for D^2, so that the ratio falls until
    what two Hermite polynomials of a kick do not carry is left.
    """
    tau = [5.0, 40.0]
    plain, controlled = (
        moments(gram(FRICTION, tau, Sampling(0.05, 20_000, 2), control))
        for control in (False, True)
    )
    ratio = controlled["variance_error"] / plain["variance_error"]
    assert ratio[0] < 1 / 3
    assert ratio[1] < 0.8 * ratio[0]


def test_bias_of_the_step_is_the_one_known_by_quadrature():
    """1.43e-3 at h = 0.1 and 1.65e-4 at h = 0.02 for T = 10, n = 100.

    By quadrature of the kernels' transition (test_schemes). The change by halving is
    (1 - 2^-1.5) of it; its order lies between those of kink and bulk.
    """
    z = stats.norm.isf(FALSE_ALARM / 2)
    for h, bias in ((0.1, 1.43e-3), (0.02, 1.65e-4)):
        change, _ = coupled(FRICTION, [10.0], Sampling(h, 200_000, 1))
        found, error = step_bias(change, 1.5)
        # the order varies between 1.3 and 1.7 locally: a fifth of 1 - 2^-1.5
        assert abs(found[0] / 10 - bias) < z * error[0] / 10 + 0.2 * bias


def test_precision_changes_less_than_the_errors():
    """Both precisions run on the same noise; the variance agrees to 1/200 of its error."""
    sampling = Sampling(0.05, 5_000, 2, precision="float64")
    found = moments(gram(FRICTION, [1.0, 10.0], sampling))
    other = moments(gram(FRICTION, [1.0, 10.0], replace(sampling, precision="float32")))
    difference = np.abs(found["variance"] - other["variance"])
    assert np.any(difference > 0)
    assert np.all(difference <= 5e-3 * other["variance_error"])


def test_tolerance_is_met():
    """The variance within tol of the reference: error bars and bias included, step chosen."""
    limit = ns.Scene("friction", n=np.inf)
    for scene, scheme in ((FRICTION, "strang"), (limit, "strang"), (limit, "dry_friction")):
        run = simulate(scene, 10.0, tol=0.02, times=[10.0], seed=4, scheme=scheme)
        exact = float(ns.variance(scene, [10.0])["v"][0])
        z = stats.norm.isf(FALSE_ALARM / 2)
        slack = abs(run["variance_bias"]) + z * np.hypot(
            run["variance_error"], run["variance_bias_error"]
        )
        assert abs(run["variance"] - exact)[0] < slack[0]
        assert 2 * run["variance_error"][0] < 0.02 * exact
        assert abs(run["variance_bias"])[0] < 0.02 * exact


@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("n", [50.0, np.inf])
def test_penalty_force_is_what_the_paths_lack(model, n):
    """Its integral, gathered in the flows, closes the equation of motion on every path.

    d x = (y - force) dt, d y = (eta - U' - C_b y - force) dt: the other terms by the trapezoidal
    rule on the kept path, whose error is of second order, or first where y jumps.
    """
    force = {
        "elasto_plastic": "plastic_strain_rate",
        "friction": "friction_force",
        "obstacle": "contact_force",
    }[model]
    potential = "0" if model == "friction" else "x**2/2"
    scene = ns.Scene(model, "langevin", n=n, potential=potential, observable=force)
    assert scene.state == (("eta", "y") if model == "friction" else ("eta", "y", "x"))
    errors = []
    for h in (0.04, 0.01):
        path = paths_at(scene, h * np.arange(1, round(4 / h) + 1), Sampling(h, 200, 6))
        eta, y = path[:, 0], path[:, 1]
        x = path[:, 2] if model != "friction" else 0 * y
        rate = y if model == "elasto_plastic" else eta - y - (x if model == "obstacle" else 0)
        moved = x[-1] - x[0] if model == "elasto_plastic" else y[-1] - y[0]
        lacking = integrate.trapezoid(rate, dx=h, axis=0) - moved
        errors.append(np.sqrt(np.mean((path[-1, -1] - lacking) ** 2)))
    assert errors[0] < 0.05
    assert errors[1] < errors[0] / 3


@pytest.mark.parametrize("noise", ["langevin", "hamiltonian"])
@pytest.mark.parametrize(
    ("model", "potential", "n"),
    [("friction", "0", 50), ("elasto_plastic", "x**2/2", 50), ("obstacle", "x**2/2", 50)],
)
def test_forcing_balance_for_colored_noise(model, potential, n, noise):
    """gamma^2 of the restoring force equals the forcing's spectrum at 0, here 1 (unit noises).

    The velocity is bounded in law, so that int_0^T (force - forcing) is too: on every path
    int (force - eta) = Y(0) - Y(T), exactly up to the step's error, without any statistics.
    """
    force = {
        "friction": f"y + max(-1, min(1, {n}*y))",
        "elasto_plastic": "y + x",
        "obstacle": f"y + x + {n}*(x - max(-1, min(1, x)))",
    }[model]
    scene = ns.Scene(model, noise, n=n, potential=potential, observable=f"{force} - eta")
    errors = []
    for h in (0.02, 0.01):
        run = simulate(scene, 4.0, step=h, paths=50, seed=6, times=[4.0], keep="paths")
        errors.append(np.max(np.abs(run["delta"][:, -1] + run["y"][:, -1])))
    # the trapezoidal rule across the kinks: first order at worst, slope n in the penalty
    assert errors[0] < 4.0 * n * 0.02**2
    assert errors[1] < 0.6 * errors[0] + 1e-12


@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("n", [10.0, np.inf])
def test_divergence_is_an_error_and_ends(model, n):
    """A potential that is not confining does not return numbers, nor does it hang."""
    scene = ns.Scene(model, n=n, potential="-x**4", observable="x", start={"y": 30.0})
    if model != "friction" and n == np.inf:
        run = simulate(scene, 20.0, step=0.1, paths=5, times=[20.0], keep="paths")
        assert np.all(np.abs(run["x"]) <= 1 + 1e-12)  # the walls confine
        return
    with pytest.raises(SceneError, match="diverged"):
        simulate(scene.with_n(n), 20.0, step=0.1, paths=5, times=[20.0])


@pytest.mark.parametrize("noise", [ns.OrnsteinUhlenbeck(2.0, 0.5), ns.KanaiTajimi(2.0, 0.5)])
def test_halved_steps_run_on_the_same_path(noise):
    """Two half increments join to the full one: exact for the linear noises."""
    scene = ns.Scene("obstacle", noise, observable="eta")
    fine, coarse = (coefficients(scene, "strang", h, "float64") for h in (0.1, 0.2))
    panels = [new_panel(scene, 1, 0, "float64") for _ in range(2)]
    passage = np.full((2, 100), np.inf)
    march_pair(fine, on_given_increments(coarse), *panels, 100, 7, -np.inf, np.inf, 0.0, passage)
    noises = [panel.data[[ZETA, ETA], :100] for panel in panels]
    assert np.std(noises[0][1]) > 0.1
    assert np.allclose(*noises, rtol=0, atol=1e-12)


def test_time_grids():
    """Steps divide the spans, none is longer than asked, early ones resolve the first time."""
    times = logarithmic(0.02, 10, 60)
    assert times[0] == 0.02
    assert times[-1] == 10
    assert np.all(np.diff(times) > 0)
    assert np.allclose(times / 0.002, np.rint(times / 0.002))
    grid = equal_steps(times, 0.01)
    ends = np.cumsum([count * step for count, step in grid])
    assert np.allclose(ends, times, rtol=1e-10)
    assert max(step for _, step in grid) <= 0.01 * (1 + 1e-9)
    assert grid[0] == (16, 0.02 / 16)


@pytest.mark.parametrize(
    "arguments",
    [
        {"step": 0.0},
        {"paths": 0},
        {"horizon": -1.0},
        {"times": [2.0, 1.0]},
        {"times": [9.0]},
        {"seed": -1},
        {"keep": "path"},
        {"precision": "float16"},
        {"scheme": "heun"},
        {"tol": 0.0},
    ],
)
def test_bad_requests_are_refused(arguments):
    """One line naming the parameter."""
    defaults = {"horizon": 3.0, "step": 0.1, "paths": 10, "seed": 1}
    with pytest.raises(SceneError, match=r"choose|sort"):
        simulate(FRICTION, **(defaults | arguments))


def test_a_minority_of_diverging_paths_is_seen():
    """A path that leaves every bound is not replaced by a healthy one."""
    scene = ns.Scene("obstacle", n=10, potential="x**2/2", observable="exp(400*(x - 1))")
    with pytest.raises(SceneError, match="diverged"):
        gram(scene, [5.0], Sampling(0.05, BLOCK, 1))


def test_a_spread_lost_in_the_mean_is_refused():
    """Sums of fourth powers hold sixteen digits."""
    sums = gram(ns.Scene("friction", observable="y + 1e6"), [10.0], Sampling(0.1, BLOCK, 1))
    with pytest.raises(SceneError, match="subtract the mean"):
        moments(sums)


def test_errors_where_no_path_has_moved():
    """A wall hardly reached by t = 0.65: the variance is below three errors, none of them 0."""
    scene = ns.Scene("obstacle", n=100, potential="x**2/2", observable="contact_force")
    run = simulate(scene, 2.0, step=0.05, paths=300, times=[0.3, 0.65, 2.0])
    finer = simulate(scene, 2.0, step=0.05, paths=20_000, times=[0.65, 2.0])
    assert np.all(run["variance"][:2] == 0)
    assert 0 < finer["variance"][0] <= 3 * run["variance_error"][1]
    assert np.all(run["variance_error"][:2] > 0)
    with pytest.raises(SceneError, match="longer time"):
        simulate(scene, 0.1, step=0.05, paths=100)


def test_what_would_take_for_ever_is_refused():
    """One line with a tolerance that would not."""
    with pytest.raises(ToleranceError, match="use tol >="):
        simulate(ns.Scene("friction", n=100), 10.0, tol=1e-9)


def test_bias_of_a_variance_is_not_that_of_the_mean_square():
    """Adding a constant to g changes neither the variance nor its bias."""
    biases = []
    for g in ("y", "y + 3"):
        scene = ns.Scene("friction", observable=g)
        change, _ = coupled(scene, [5.0], Sampling(0.1, 50_000, (1, "same")))
        biases.append(step_bias(change, 1.5))
    (first, error), (second, spread) = biases
    assert abs(first - second)[0] < stats.norm.isf(FALSE_ALARM / 2) * np.hypot(error, spread)[0]
    assert spread[0] < 2 * error[0]  # E[D] = 15 would make it tens of times larger


@pytest.mark.parametrize("n", [100.0, np.inf])
def test_friction_force_balances_the_forcing(n):
    """gamma^2 of C_b y + force is 1 with white noise: E D^2 grows like t for C_b small."""
    scene = ns.Scene("friction", n=n, damping=0.01, observable="friction_force")
    estimate = ns.asymptotic_variance(scene, tol=1e-6)
    # int force = W - Y - C_b int y, and the spectrum of C_b y at 0 is C_b^2 gamma^2(y)
    assert abs(np.sqrt(estimate.value) - 1) < 2 * 0.01 * np.sqrt(
        ns.asymptotic_variance(ns.Scene("friction", n=n, damping=0.01), tol=1e-6).value
    )
    sample = moments(gram(scene, [20.0, 60.0], Sampling(0.05, 20_000, 3)))
    slope = np.diff(sample["variance"])[0] / 40
    allowed = stats.norm.isf(FALSE_ALARM / 2) * np.hypot(*sample["variance_error"]) / 40
    assert abs(slope - estimate.value) < allowed + 0.01
