"""Variance of int_0^tau g with two state variables: exact moments, Monte Carlo, expansions."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from numpy.polynomial.legendre import leggauss

import nonsmooth as ns
from nonsmooth.errors import AccuracyWarning, SceneError, ToleranceError
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.generator import evaluate
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.paths.ensembles import integrals_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.statistics import moments_on_grids, tuning
from references import COLORED_FRICTION, OBSTACLE, PLASTIC

TAU = np.array([0.0, 0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 100.0, 1000.0])
SCENES = {
    "friction": COLORED_FRICTION,
    "elasto_plastic": PLASTIC,
    "obstacle": OBSTACLE,
}
# until which the state is, but for eight standard deviations, where the drift is linear
EARLY = {"friction": 0.015, "elasto_plastic": 0.3, "obstacle": 0.3}


def linear(damping, stiffness, sigma, start, tau):
    """Mean and covariance of (y, x, int x) of a linear oscillator at one time."""
    drift = np.array([[-damping, -stiffness, 0], [1, 0, 0], [0, 1, 0.0]])
    return scipy.linalg.expm(tau * drift) @ [*start, 0.0], gaussian(drift, sigma, tau)


def gaussian(drift, sigma, tau):
    """Covariance at one time of three variables from a point, the first driven."""
    both = np.kron(drift, np.eye(3)) + np.kron(np.eye(3), drift)
    kick = np.diag([sigma**2, 0, 0.0]).reshape(-1, 1)
    whole = np.block([[both, kick], [np.zeros((1, 10))]])
    return scipy.linalg.expm(tau * whole)[:9, -1].reshape(3, 3)


def squared(damping, stiffness, sigma, start, tau):
    """Mean and variance of int x^2: cov(x_s^2, x_t^2) = 2 C^2 + 4 m_s m_t C, C = cov(x_s, x_t)."""
    nodes, weights = leggauss(60)
    drift = np.array([[-damping, -stiffness], [1, 0.0]])
    stationary = sigma**2 / (2 * damping * stiffness)
    w = v = 0.0
    for s, a in zip(tau / 2 * (nodes + 1), tau / 2 * weights, strict=True):
        mean, covariance = linear(damping, stiffness, sigma, start, s)
        w += a * (mean[1] ** 2 + covariance[1, 1] - stationary)
        for lag, b in zip((tau - s) / 2 * (nodes + 1), (tau - s) / 2 * weights, strict=True):
            later = scipy.linalg.expm(lag * drift)
            C = (later @ covariance[:2, :2])[1, 1]
            v += 2 * a * b * (2 * C**2 + 4 * mean[1] * (later @ mean[:2])[1] * C)
    return w, v


@pytest.mark.parametrize("seed", range(2))
def test_linear_oscillator(seed):
    """G = x of an obstacle too soft to be felt, from a point some deviations off."""
    draw = np.random.default_rng(seed).uniform
    damping, stiffness, sigma = draw(0.5, 3), round(draw(0.5, 2), 3), draw(0.5, 2)
    start = draw(-1, 1, 2) * sigma
    scene = ns.Scene(
        "obstacle",
        ns.White(sigma),
        n=1e-15,
        damping=damping,
        potential=f"{stiffness}*x**2/2",
        observable="x",
        start={"y": start[0], "x": start[1]},
    )
    found = ns.variance(scene, TAU)
    exact = [linear(damping, stiffness, sigma, start, tau) for tau in TAU]
    for name, values in (("w", [m[2] for m, _ in exact]), ("v", [c[2, 2] for _, c in exact])):
        assert np.all(np.abs(found[name] - values) <= found[f"{name}_error"])


@pytest.mark.slow
def test_square_of_a_linear_oscillator():
    """G = x^2 is not odd, its mean is not 0, and its Poisson solutions are of degree 2 and 4."""
    scene = ns.Scene(
        "obstacle",
        ns.White(1.3),
        n=1e-15,
        damping=1.5,
        potential="1.2*x**2/2",
        observable="x**2",
        start={"y": 0.5, "x": -0.8},
    )
    tau = np.array([0.1, 1.0, 4.0])
    found = ns.variance(scene, tau)
    w, v = np.array([squared(1.5, 1.2, 1.3, (0.5, -0.8), t) for t in tau]).T
    assert np.all(np.abs(found["w"] - w) <= found["w_error"])
    assert np.all(np.abs(found["v"] - v) <= found["v_error"])


@pytest.fixture(scope="module", params=SCENES)
def solved(request):
    """Solve for the moments of a scene at early, middle and late times."""
    scene = SCENES[request.param]
    return scene, ns.variance(scene, [EARLY[request.param], 0.5, 1.0, 3.0, 8.0, 200.0, 1000.0])


@pytest.mark.slow
def test_growth_at_long_times(solved):
    """The slope of v between 200 and 1000 is gamma^2: the constant cancels, the rest has died."""
    scene, found = solved
    v, error = found["v"].values, found["v_error"].values
    gamma2 = ns.asymptotic_variance(scene, tol=1e-5)
    allowed = (error[-1] + error[-2]) / 800 + gamma2.error
    assert abs((v[-1] - v[-2]) / 800 - gamma2.value) <= allowed


@pytest.mark.slow
def test_early_times(solved):
    """Before the kinks are reached the scene is linear."""
    scene, found = solved
    tau = float(found["time"][0])
    if scene.model == "friction":
        drift = np.array([[-1, 0, 0], [1, -(1 + scene.n), 0], [0, 1, 0.0]])
        exact = gaussian(drift, 1.0, tau)[2, 2]
    else:
        place = 2 if scene.observable == "x" else 1  # int y is x
        exact = linear(1.0, 1.0, 1.0, (0, 0), tau)[1][place, place]
    assert abs(found["v"][0] - exact) <= found["v_error"][0]


@pytest.mark.slow
def test_monte_carlo(solved):
    """Var D at four times; four standard errors, which chance exceeds once in 1300 runs."""
    scene, found = solved
    middle, paths = found.isel(time=slice(1, 5)), 40_000
    sampling = Sampling(0.01, paths, 5)
    sample = integrals_at(scene, middle["time"].values, sampling, control=False)[:, 0]
    squares = (sample - sample.mean(axis=1, keepdims=True)) ** 2
    error = squares.std(axis=1) / np.sqrt(paths)
    # the step of 0.01 biases less than a hundredth of a per cent
    allowed = 4 * error + 1e-3 * squares.mean(axis=1)
    assert np.all(np.abs(squares.mean(axis=1) - middle["v"].values) <= allowed)


@pytest.mark.slow
def test_projection_against_the_whole_exponential():
    """On one coarse grid, the matrix exponential of the equations of q = E Delta^2 and w."""
    scene = SCENES["elasto_plastic"]
    grid = tensor_grid.fitted(scene, 10.0, 0)
    times = np.array([0.05, 0.6, 4.0, 50.0])
    found, inexact = moments_on_grids.moments_on(scene, grid, times, 1e-8)
    axes, solver = tensor_grid.direct_solver(scene, grid)
    g = solver.fold(evaluate(scene.numerical_observable(), axes))
    size = len(g)
    whole = np.zeros((2 * size + 1,) * 2)
    whole[:size, :size] = solver.matrix(EVEN).toarray()
    whole[:size, size:-1] = 2 * np.diag(g)
    whole[size:-1, size:-1] = solver.matrix(ODD).toarray()
    whole[size:-1, -1] = g
    for k, tau in enumerate(times):
        q, w = np.split(scipy.linalg.expm(tau * whole)[:-1, -1], 2)
        at = moments_on_grids.at_start(scene, axes)
        exact = at(solver, q[None], EVEN) - at(solver, w[None], ODD) ** 2
        assert abs(found[1, k] - exact[0]) <= 2 * inexact[1, k] + 1e-9 * (1 + tau)


@pytest.mark.slow
def test_what_cannot_be_solved_is_refused(monkeypatch):
    """Three variables, n = inf and a tolerance out of reach are refused in one line each."""
    with pytest.raises(SceneError, match="method='monte_carlo'"):
        ns.variance(ns.Scene("friction", "hamiltonian"), [1.0], method="deterministic")
    with pytest.raises(SceneError, match="n = inf"):
        ns.variance(SCENES["obstacle"].with_n(np.inf), [1.0], method="deterministic")
    chosen = tuning.MOMENTS_ON_GRIDS
    monkeypatch.setattr(tuning, "MOMENTS_ON_GRIDS", replace(chosen, largest=3000))
    with pytest.raises(ToleranceError, match="at tau = 3 has an error of"):
        ns.variance(SCENES["obstacle"], [3.0], tol=1e-7)
    never = replace(chosen, largest=500, dimensions=())  # nothing is projected
    monkeypatch.setattr(tuning, "MOMENTS_ON_GRIDS", never)
    with pytest.raises(ToleranceError, match="no finite projection"):
        ns.variance(SCENES["obstacle"], [3.0], method="deterministic")
    # nobody asked for grids, and paths know
    assert ns.variance(SCENES["obstacle"], [3.0]).attrs["method"] == "monte_carlo"


def test_modes_that_grow_are_made_to_decay():
    """The others stay as they are."""
    rates = np.array([-3.0, -1.0, 0.5, -2.0])
    modes = np.random.default_rng(1).normal(size=(4, 4))
    matrix = modes @ np.diag(rates) @ np.linalg.inv(modes)
    tamed = moments_on_grids.decaying(matrix)
    expected = np.where(rates > 0, -np.max(np.abs(matrix)), rates)
    assert np.allclose(tamed @ modes, modes * expected)


@pytest.mark.slow
def test_a_grid_that_fails_does_not_spoil_what_is_known(monkeypatch):
    """Finer grids have values that are nonsense: the last good one answers, within its error."""
    scene = SCENES["obstacle"]
    exact = ns.variance(scene, [3.0], method="deterministic")["v"][0]
    solve = moments_on_grids.moments_on

    def failing(scene, grid, times, allowed):
        found, inexact = solve(scene, grid, times, allowed)
        fails = max(grid.levels.values()) > 2
        return (-1e3 * found, np.abs(found)) if fails else (found, inexact)

    monkeypatch.setattr(moments_on_grids, "moments_on", failing)
    with pytest.raises(ToleranceError) as refused:
        ns.variance(scene, [3.0], 1e-7, "deterministic")
    found = refused.value.result
    assert abs(found["v"][0] - exact) < found["v_error"][0]
    assert found["v_error"][0] < 0.05 * exact


@pytest.mark.slow
def test_paths_answer_where_grids_hardly_tell(monkeypatch):
    """By default; what is asked for by its name or within a tolerance is returned as it is."""
    few = replace(tuning.MOMENTS_ON_GRIDS, largest=500, dimensions=(2, 4))
    monkeypatch.setattr(tuning, "MOMENTS_ON_GRIDS", few)
    with pytest.warns(AccuracyWarning):
        solved = ns.variance(SCENES["obstacle"], [3.0], method="deterministic")
    sampled = ns.variance(SCENES["obstacle"], [3.0])
    assert sampled.attrs["method"] == "monte_carlo"
    assert float(sampled["v_error"][0]) < 0.05 * float(sampled["v"][0])
    assert abs(float(solved["v"][0] - sampled["v"][0])) < float(solved["v_error"][0])


def test_errors_hold_where_they_oscillate():
    """A loose tolerance and a spiky g: the projection's error changes sign between the times."""
    scene = ns.Scene(
        "elasto_plastic",
        ns.White(1.2),
        n=96,
        damping=0.8,
        potential="0.94*x**2/2",
        observable="plastic_strain_rate",
        start={"x": 0.5},
    )
    times = np.geomspace(0.01, 10, 16)
    loose, tight = (ns.variance(scene, times, tol, "deterministic") for tol in (1e-2, 1e-4))
    for name in "wv":
        apart = np.abs(loose[name] - tight[name])
        assert np.all(apart <= loose[name + "_error"] + tight[name + "_error"])


@pytest.mark.slow
def test_a_change_of_sign_of_the_error_is_not_taken_for_convergence():
    """One small change between levels is not the end: x from 3 to 4 3e-5, 4 to 5 1.3e-4."""
    potential = "x**2/2 + 0.3*cos(2*x)"
    scene = ns.Scene("obstacle", n=5.223, damping=1.954, potential=potential, observable="x")
    found = ns.variance(scene, [4.23], 3.6e-5, "deterministic")
    y, x = (grid := moments_on_grids.first_grid(scene, 1e-6)).levels
    finest = moments_on_grids.moments_on(
        scene, replace(grid, levels={y: 2, x: 6}), np.array([4.23]), 1e-6
    )
    # finer levels change less than 3e-6
    assert abs(found["v"][0] - finest[0][1, 0]) <= found["v_error"][0] + 1e-5
