"""Public functions end well whatever they are given: a short version of the trial."""

import numpy as np
import pytest

import nonsmooth as ns
from benchmarks.trials import calls, odd_values

# things that no argument may be
WRONG = (
    *("object()", "'abc'", "1j", "nan", "-(10**400)", "[0.5, [1.0, 2.0]]", "{1: 2}"),
    "np.datetime64('2020')",
)


@pytest.mark.parametrize("function", odd_values.VALID)
def test_what_is_wrong_is_refused(function):
    """Every argument of every function refuses what it cannot be, in one line."""
    for name in odd_values.VALID[function]:
        for value in WRONG:
            call = calls.written(function, odd_values.VALID[function] | {name: value})
            found = calls.judged(call)
            assert found["outcome"] == "refused", (call, found["told"])


@pytest.mark.parametrize("function", odd_values.VALID)
def test_what_is_right_is_done(function):
    """The calls whose arguments are replaced are themselves right."""
    found = calls.judged(calls.written(function, odd_values.VALID[function]))
    assert found["outcome"] == "fine", found["told"]


def test_nonsense_is_recognised():
    """A value that is not a number, a negative error, a probability above 1."""
    for value, error in ((np.nan, 0.0), (1.0, -1.0), (-1.0, 0.0), (np.inf, 0.0), (1.0, np.nan)):
        assert calls.nonsense(ns.Estimate(value, error, "none", 0.0))
    assert not calls.nonsense(ns.Estimate(1.0, 0.1, "none", 0.0))
    assert not calls.nonsense(ns.Estimate(-1.0, 0.1, "none", 0.0), signed=True)
    found = ns.crossing_probability(ns.Scene("friction"), 0.5, [1.0], method="asymptotic")
    assert not calls.nonsense(found)
    assert calls.nonsense(found.assign(probability=2.0 + 0 * found["probability"]))
    assert calls.nonsense(np.array([0.5, -0.1]))


def test_draws_are_repeated():
    """A seed draws the same calls, all of them different, as many as asked."""
    drawn = calls.chosen_calls(1000, 1)
    assert drawn == calls.chosen_calls(1000, 1)
    assert len(set(drawn)) == len(drawn) >= 990
