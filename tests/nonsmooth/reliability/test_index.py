"""Reliability indices: the normal quantile of the crossing probability, and of its limits."""

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import nonsmooth as ns
from nonsmooth.errors import SceneError
from references import FRICTION


def test_the_index_has_the_probability_and_the_limits_of_W():
    """Phi(-beta) = W for every method, threshold and horizon; the limits change places."""
    for method in ("corrected", "monte_carlo"):
        run = ns.crossing_probability(FRICTION, [0.3, 0.6], [1.0, 4.0], p=50.0, method=method)
        found = ns.reliability_index(run)
        assert dict(found.sizes) == dict(run.sizes)
        for name, W in (("reliability_index", "probability"), ("lower", "upper")):
            assert np.allclose(stats.norm.sf(found[name]), run[W], atol=1e-12)
        assert np.allclose(stats.norm.sf(found["upper"]), run["lower"], atol=1e-12)
        beta, error = found["reliability_index"], found["reliability_index_error"]
        exact = stats.norm.isf(run["probability"] + run["probability_error"])
        assert np.all(np.abs(beta - exact) <= error + 1e-12)


def test_where_the_survival_is_tiny_its_digits_are_kept():
    """The index is Phi^-1(S) far below the rounding of W; where W = 0, nothing bounds it."""
    data = {
        "probability": [0.0, 1.0],
        "probability_error": [1e-9, 1e-30],
        "survival": [1.0, 1e-25],
        "lower": [0.0, 1.0],
        "upper": [1e-9, 1.0],
    }
    run = xr.Dataset({name: ("horizon", np.array(values)) for name, values in data.items()})
    found = ns.reliability_index(run)
    assert float(found["reliability_index"][1]) == pytest.approx(stats.norm.ppf(1e-25))
    assert np.isinf(found["reliability_index"][0])
    assert np.isinf(found["reliability_index_error"][0])
    assert float(found["lower"][0]) == pytest.approx(stats.norm.isf(1e-9))


def test_the_error_of_a_tiny_survival_is_its_own():
    """Half of S = 1e-20 is far below the rounding of W = 1, whose limits tell nothing of it."""
    data = {
        "probability": [1.0],
        "probability_error": [5e-21],
        "survival": [1e-20],
        "survival_error": [5e-21],
        "lower": [1.0],
        "upper": [1.0],
    }
    run = xr.Dataset({name: ("horizon", np.array(values)) for name, values in data.items()})
    found = ns.reliability_index(run)
    ends = stats.norm.ppf([5e-21, 1.5e-20])
    assert np.allclose([found["lower"][0], found["upper"][0]], ends)
    missed = np.abs(ends - stats.norm.ppf(1e-20)).max()
    assert float(found["reliability_index_error"][0]) == pytest.approx(missed)


def test_what_is_no_crossing_probability_is_refused():
    """The error is one line with the cure."""
    with pytest.raises(SceneError, match="crossing_probability has returned"):
        ns.reliability_index(0.1)
    names = "probability", "probability_error", "lower", "upper"
    with pytest.raises(SceneError, match="has no probabilities"):
        ns.reliability_index(xr.Dataset({name: ("horizon", []) for name in names}))


@pytest.mark.parametrize("factor", [np.nan, -1.0, 3.0])
def test_numbers_that_are_no_probabilities_are_refused(factor):
    """Not an index of nan."""
    crossing = ns.crossing_probability(ns.Scene("friction"), 0.5, [1.0], method="asymptotic")
    with pytest.raises(SceneError, match="no probabilities"):
        ns.reliability_index(crossing * factor)


@pytest.mark.parametrize(
    "changed",
    [
        {"probability_error": -0.1},
        {"probability_error": np.nan},
        {"lower": 0.9, "upper": 0.1},
        {"upper": [0.5, 0.6]},
    ],
    ids=str,
)
def test_a_result_that_was_changed_is_refused(changed):
    """Errors are not negative, limits are in order, and all have the same dimensions."""
    crossing = ns.crossing_probability(ns.Scene("friction"), 0.5, [1.0], method="asymptotic")
    for name, value in changed.items():
        dims = ("more", "horizon") if isinstance(value, list) else ("horizon",)
        crossing[name] = (dims, np.reshape(value, (-1, 1)[-len(dims) :]))
    with pytest.raises(SceneError, match="returned, unchanged"):
        ns.reliability_index(crossing)


@pytest.mark.parametrize("kind", [str, complex, object])
def test_what_is_no_number_is_refused(kind):
    """Texts, complex numbers, objects."""
    crossing = ns.crossing_probability(ns.Scene("friction"), 0.5, [1.0], method="asymptotic")
    with pytest.raises(SceneError, match="no probabilities"):
        ns.reliability_index(crossing.astype(kind))
