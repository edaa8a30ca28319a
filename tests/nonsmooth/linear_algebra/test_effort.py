"""The limit of what solvers may take: who asks for no tolerance does not wait long."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.linear_algebra import effort

SCENE = ns.Scene("friction", "langevin", n=5)
ASKED = {"threshold": 0.3, "horizons": [3.0, 5.0]}


def test_a_limit_is_for_all_that_is_called_within(monkeypatch):
    """Limits within it do not add to it, and what it refuses once it refuses for good."""
    monkeypatch.setattr(effort, "MOST", 3.0)
    effort.spend(1e9)  # no limit yet
    with effort.limited(None):
        assert effort.holds()
        effort.spend(2)
        with effort.limited(None), effort.limited(1e-3):
            effort.spend(1)
            with pytest.raises(ToleranceError, match="give a tol to wait for it"):
                effort.spend(1)
        with pytest.raises(ToleranceError):
            effort.spend(0.1)
    assert not effort.holds()


@pytest.mark.slow
def test_a_given_tolerance_is_not_limited(monkeypatch):
    """It is for the one who gives it to wait."""
    monkeypatch.setattr(effort, "MOST", 0.0)
    with effort.limited(1e-3):
        effort.spend(1e15)
    run = ns.crossing_probability(SCENE, **ASKED, tol=1e-4)
    assert run.attrs["method"] == "deterministic"


CALLS = {
    "crossing": lambda **tol: ns.crossing_probability(SCENE, **ASKED, **tol),
    "threshold": lambda **tol: ns.crossing_threshold(SCENE, 0.1, 5.0, **tol),
    "time": lambda **tol: ns.failure_time(SCENE, 0.3, 0.1, **tol),
}


@pytest.mark.slow
@pytest.mark.parametrize("call", CALLS)
def test_paths_answer_what_takes_too_long(call, monkeypatch):
    """Where the solver has nothing; 95 % limits by a fixed seed hold the truth."""
    solved = CALLS[call](tol=1e-4)
    assert solved.attrs["method"] == "deterministic"
    monkeypatch.setattr(effort, "MOST", 1e10)
    counted = CALLS[call]()
    assert counted.attrs["method"] == "monte_carlo"
    assert np.all(counted["lower"] <= solved["upper"])
    assert np.all(solved["lower"] <= counted["upper"])


@pytest.mark.slow
def test_hazard_rates_are_counted_too(monkeypatch):
    """They hold the mean rate within a tenth of T, from survival probabilities."""
    times = [4.9, 5.1]
    ends = ns.crossing_probability(SCENE, 0.3, times, tol=1e-4)["survival"]
    mean = float(np.log(ends[0] / ends[1])) / (times[1] - times[0])
    monkeypatch.setattr(effort, "MOST", 1e10)
    counted = ns.hazard_rate(SCENE, 0.3, [5.0]).squeeze()
    assert counted.attrs["method"] == "monte_carlo"
    # the mean has errors of 2e-4 over S and the width; the rate hardly bends within it
    slack = 2e-4 / float(ends[1]) / (times[1] - times[0]) + 0.01 * mean
    assert counted["lower"] - slack <= mean <= counted["upper"] + slack


@pytest.mark.slow
def test_the_mean_time_is_answered_too(monkeypatch):
    """By paths; both errors are stated."""
    solved = ns.mean_time_to_failure(SCENE, 0.3, tol=1e-2)
    monkeypatch.setattr(effort, "MOST", 1e10)
    counted = ns.mean_time_to_failure(SCENE, 0.3)
    assert (solved.method, counted.method) == ("deterministic", "monte_carlo")
    assert abs(solved.value - counted.value) <= solved.error + 3 * counted.error


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.errors.AccuracyWarning")
def test_what_the_solver_has_until_then_is_right(monkeypatch):
    """However far it comes, what is returned is as near to counted paths as both state."""
    asked = ns.Scene("elasto_plastic", potential="x**2/2", n=10), 1.0, [5.8]
    counted = ns.crossing_probability(*asked, method="monte_carlo", tol=2e-3)
    for operations in (3e10, 1e11):
        monkeypatch.setattr(effort, "MOST", operations)
        known = ns.crossing_probability(*asked)
        assert np.all(known["probability_error"] < 1e-2)
        assert np.all(known["lower"] <= counted["upper"])
        assert np.all(counted["lower"] <= known["upper"])
