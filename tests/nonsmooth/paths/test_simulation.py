"""Simulation: the right laws, the right limits, and refusals."""

import warnings

import numpy as np
import pytest
from scipy import integrate, stats

import nonsmooth as ns
from nonsmooth.errors import AssumptionWarning, SceneError
from nonsmooth.paths.ensembles import paths_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.simulation import simulate
from references import FALSE_ALARM, FRICTION


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
    scene = ns.Scene("obstacle", n=n, damping=damping, potential="x**2/2", observable="y")
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
    """The error is one line naming the parameter."""
    defaults = {"horizon": 3.0, "step": 0.1, "paths": 10, "seed": 1}
    with pytest.raises(SceneError, match=r"; (give|choose|did you mean)"):
        simulate(FRICTION, **(defaults | arguments))


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


def test_bias_of_the_mean_covers_the_true_one():
    """E int y^2 of dry friction at a step of 0.2 is right after its bias; false alarm 6e-7."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AssumptionWarning)
        scene = ns.Scene("friction", observable="y**2")
    run = ns.simulate(scene, horizon=50, times=[50.0], step=0.2, paths=4000).isel(time=0)
    exact = float(ns.variance(scene, [50.0])["w"][0]) + 50 * 0.180553
    bias, spread = (
        float(run["mean_bias"]),
        float(np.hypot(run["mean_error"], run["mean_bias_error"])),
    )
    assert bias > 5 * float(run["mean_bias_error"])  # there is one
    assert abs(float(run["mean"]) - bias - exact) < 0.3 * bias + 5 * spread
