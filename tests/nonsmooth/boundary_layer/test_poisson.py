"""The Poisson solution at points: that of a linear scene is linear."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.boundary_layer import poisson, tuning
from nonsmooth.errors import ToleranceError
from nonsmooth.scenes.symbols import eta, x, y

# the wall is too soft to be felt; A u = -x with eta' = -eta, y' = eta - y - x, x' = y
LINEAR = ns.Scene("obstacle", "langevin", potential="x**2/2", observable="x", n=1e-9)


def solution(points):
    """Solve the Poisson equation of the linear scene by hand."""
    return points[eta] + points[y] + points[x]


def some_points(count):
    """Return points as the invariant measure has them, about."""
    draw = np.random.default_rng(1).normal
    return {symbol: draw(scale=0.6, size=count) for symbol in (eta, y, x)}


def test_a_linear_scene():
    """The solution is eta + y + x on the coarse grid, and so is its mean over all points."""
    points = some_points(200)
    exact = solution(points)
    found = poisson.on_coarse_grid(LINEAR)(points)
    assert np.max(np.abs(found - exact)) < tuning.POISSON.coarse * np.std(exact)
    value, error = poisson.mean_at(LINEAR, points, 1e-3, 1.0)
    assert abs(value - exact.mean()) < error < 1e-3


def test_few_of_many_points(monkeypatch):
    """Their scatter is in the error; what is known is left out, with its scatter."""
    points = some_points(2000)
    exact = solution(points)
    monkeypatch.setattr(poisson.tuning, "POISSON", tuning.Poisson(points=100))
    value, error = poisson.mean_at(LINEAR, points, 1e-2, 1.0)
    assert abs(value - exact.mean()) < error
    assert error > exact.std() / 10
    rest, small = poisson.mean_at(LINEAR, points, 1e-2, 1.0, exact)
    assert abs(rest) < small < 0.1 * error


def test_at_the_start():
    """Also where the start is outside the box that the invariant measure needs."""
    for start in ({"x": 0.5}, {"x": 9.0, "y": -1.0}):
        scene = ns.Scene(
            "obstacle", "langevin", potential="x**2/2", observable="x", n=1e-9, start=start
        )
        found = poisson.at_start(scene, 1.0)
        assert abs(found.value - sum(start.values())) < found.error < 1e-2


def test_where_no_grid_is_solved_on(monkeypatch):
    """There is no solution, which callers take for a reason to sample."""

    def refused(*asked):
        raise ToleranceError("the iteration does not converge")

    monkeypatch.setattr(poisson, "solver", refused)
    assert poisson.on_coarse_grid(LINEAR) is None
    assert poisson.at_start(LINEAR, 1.0) is None
    with pytest.raises(ToleranceError, match="does not converge"):
        poisson.mean_at(LINEAR, some_points(1), 1e-2, 1.0)
