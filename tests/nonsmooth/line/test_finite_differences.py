"""The paper's scheme: first order in time, second in space, honest about its error."""

from dataclasses import replace

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.line import eigenfunctions, finite_differences, tuning

SCENE = ns.Scene("friction", n=10)  # the kinks at +-0.1 are nodes of all meshes below
TAU = [0.4, 5.0]
HALF_WIDTH = 6.0


@pytest.fixture(scope="module")
def reference():
    """V by spectral elements, error below 1e-9."""
    return ns.variance(SCENE, TAU)["v"].values


def test_other_starting_points():
    """A start on a node is right within the stated error; between nodes it is refused."""
    scene = ns.Scene("friction", n=5, start={"y": 1.0})
    w, v, w_error, v_error = finite_differences.moments_with_error(scene, [2.0], 6.0, 601, 0.01)
    exact = eigenfunctions.moments(scene, [2.0], 12)
    assert abs(w - exact[0]) < w_error < 1e-2
    assert abs(v - exact[1]) < v_error < 1e-2
    with pytest.raises(SceneError, match="starts from a node"):
        finite_differences.moments(ns.Scene("friction", start={"y": 0.511}), [1.0], 6.0, 601, 0.1)


@pytest.mark.parametrize("observable", ["y", "y + 0.5"])
def test_growth_that_is_steady_is_not_marched(monkeypatch, observable):
    """What is left out is linear; it is far below the error, and most of the steps."""
    scene, T = ns.Scene("friction", n=10, observable=observable), [1.0, 60.0, 100.0]
    solves = []
    solve = finite_differences.dgttrs
    monkeypatch.setattr(finite_differences, "dgttrs", lambda *a: solves.append(1) or solve(*a))
    found = finite_differences.moments(scene, T, HALF_WIDTH, 241, 0.02)
    fewer = len(solves)
    never = replace(tuning.FINITE_DIFFERENCES, steady=-1.0)
    monkeypatch.setattr(tuning, "FINITE_DIFFERENCES", never)
    marched = finite_differences.moments(scene, T, HALF_WIDTH, 241, 0.02)
    assert fewer < (len(solves) - fewer) / 2
    np.testing.assert_allclose(found[1], marched[1], rtol=1e-9)
    np.testing.assert_allclose(found[0], marched[0], rtol=1e-9, atol=1e-12)


def test_first_order_in_time(reference):
    """Halving Delta t halves the error on a mesh whose own error is negligible."""
    space = finite_differences.moments(SCENE, TAU, HALF_WIDTH, 4801, 1e-3)[1] - reference
    error = [
        finite_differences.moments(SCENE, TAU, HALF_WIDTH, 4801, dt)[1] - reference
        for dt in (0.05, 0.025)
    ]
    rate = np.log2(np.abs(error[0]) / np.abs(error[1]))
    assert np.all(np.abs(rate - 1) < 0.1)
    assert np.all(np.abs(error[1]) < 0.025)  # the constant is of order one
    assert np.all(np.abs(space) < 1e-3)


def test_second_order_in_space(reference):
    """Halving Delta y quarters what it contributes, kinks on nodes; Delta t is held fixed."""
    v = [
        finite_differences.moments(SCENE, TAU, HALF_WIDTH, nodes, 0.01)[1]
        for nodes in (241, 481, 961)
    ]
    rate = np.log2(np.abs(v[0] - v[1]) / np.abs(v[1] - v[2]))
    assert np.all(np.abs(rate - 2) < 0.25)


@pytest.mark.parametrize("n", [2, 37.0, 100, 1000])
@pytest.mark.parametrize(("nodes", "time_step"), [(401, 0.02), (1201, 0.005)])
def test_stated_error_covers_the_true_one(n, nodes, time_step):
    """The stated error holds also where 1/n falls between two nodes."""
    scene = ns.Scene("friction", n=n)
    exact = ns.variance(scene, TAU)
    w, v, w_error, v_error = finite_differences.moments_with_error(
        scene, TAU, HALF_WIDTH, nodes, time_step
    )
    assert np.all(np.abs(v - exact["v"]) <= v_error)
    assert np.all(np.abs(w - exact["w"]) <= w_error + 1e-12)


def test_intensity_of_the_noise_enters_squared(reference):
    """The v of sigma = 2 is that of the spectral elements within the stated error."""
    scene = ns.Scene("friction", noise=ns.White(2.0), n=10)
    exact = ns.variance(scene, TAU)["v"].values
    _, v, _, error = finite_differences.moments_with_error(scene, TAU, 9.0, 1801, 0.01)
    assert np.all(np.abs(v - exact) <= error)
    assert np.all(exact > 3.9 * reference)  # friction holds back a stronger noise less


@pytest.mark.parametrize(
    ("damping", "widths"), [(10.0, [0.6, 0.8]), (1.0, [1.5, 2.0]), (0.1, [2.7, 3.0, 4.0])]
)
def test_the_error_includes_that_of_the_domain(damping, widths):
    """On the narrowest domains that are taken, where it is what matters."""
    scene = ns.Scene("friction", n=10, damping=damping)
    exact = ns.variance(scene, TAU)["v"].values
    for half_width in widths:
        nodes = 1 + 8 * round(40 * half_width / min(1, damping**-0.5))
        _, v, _, error = finite_differences.moments_with_error(scene, TAU, half_width, nodes, 0.01)
        assert np.all(np.abs(v - exact) <= error)


@pytest.mark.parametrize(("damping", "half_width"), [(1.0, 0.01), (1.0, 1.0), (0.1, 2.0)])
def test_a_domain_that_is_too_narrow_is_refused(damping, half_width):
    """Where v is far too small on the domain and on its half, their difference says nothing."""
    scene = ns.Scene("friction", n=10, damping=damping)
    with pytest.raises(SceneError, match=r"outside, .* increase half_width"):
        finite_differences.moments_with_error(scene, TAU, half_width, 801, 0.01)


@pytest.mark.parametrize(
    ("arguments", "cure"),
    [
        ({"nodes": 400}, "add one"),
        ({"time_step": 0.03}, "multiples"),
        ({"scene": ns.Scene("friction", n=float("inf"))}, "finite n"),
        ({"scene": ns.Scene("obstacle")}, "state"),
    ],
)
def test_bad_grids_are_refused(arguments, cure):
    """The error is one line with the cure."""
    defaults = {"scene": SCENE, "nodes": 401, "time_step": 0.01}
    with pytest.raises(SceneError, match=cure):
        finite_differences.moments(times=[1.0], half_width=6.0, **(defaults | arguments))
