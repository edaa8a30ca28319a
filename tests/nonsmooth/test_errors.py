"""Refusals keep what they have; without a tolerance it is returned with a warning."""

from dataclasses import replace

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import nonsmooth as ns
from nonsmooth.crossing.first_passage import tuning as first_passage
from nonsmooth.errors import (
    AccuracyWarning,
    ToleranceError,
    answered,
    first_answer,
    of_another_quantity,
)
from nonsmooth.statistics import tuning
from references import FRICTION


def refusal(result):
    """Return an attempt that misses its tolerance."""

    def attempt():
        raise ToleranceError("2 has an error of 1", result)

    return attempt


def test_what_is_found_is_presented():
    """Whether or not somebody asked for the tolerance."""
    assert [answered(lambda: 2, str, given) for given in (True, False)] == ["2", "2"]


def test_a_refusal_keeps_the_answer():
    """In the form in which it would have been returned."""
    with pytest.raises(ToleranceError, match=r"^2 has an error of 1$") as refused:
        answered(refusal(2), str)
    assert refused.value.result == "2"


def test_without_a_tolerance_the_answer_comes_with_a_warning():
    """And the warning says what the error would have said."""
    with pytest.warns(AccuracyWarning, match="2 has an error of 1; it is returned, because"):
        assert answered(refusal(2), str, tol_given=False) == "2"


def test_nothing_known_is_an_error_also_without_a_tolerance():
    """There is nothing to return."""
    with pytest.raises(ToleranceError):
        answered(refusal(None), str, tol_given=False)


def test_meanwhile_dense_linear_algebra_has_one_thread():
    """And as many as before afterwards."""

    def threads():
        found = threadpool_info()
        return {pool["num_threads"] for pool in found if pool["user_api"] == "blas"}

    with threadpool_limits(limits=2, user_api="blas"):
        assert answered(threads, set) == {1}
        assert threads() == {2}


@pytest.mark.parametrize(("results", "best"), [([3, 1, 2], 1), ([None, 2], 2), ([None], None)])
def test_the_best_of_several_refusals(results, best):
    """The one with the smallest error; what knows nothing is worst."""
    with pytest.raises(ToleranceError) as refused:
        first_answer(map(refusal, results), error=float)
    assert refused.value.result == best


def test_attempts_end_at_the_first_answer_or_one_that_is_good_enough():
    """The next are not made."""
    attempts = iter([refusal(None), lambda: 5, refusal(1)])
    assert first_answer(attempts, error=float) == 5
    assert len(list(attempts)) == 1
    attempts = iter([refusal(3), refusal(2), refusal(1)])
    with pytest.raises(ToleranceError):
        first_answer(attempts, error=float, good_enough=lambda found: found <= 2)
    assert len(list(attempts)) == 1


LANGEVIN = ns.Scene("friction", "langevin")
# what is asked for a tolerance out of reach, and a call that says what is right
OUT_OF_REACH = {
    "gamma^2 by quadrature": (
        lambda: ns.asymptotic_variance(ns.Scene("friction", observable="abs(y)"), tol=1e-29),
        lambda: ns.asymptotic_variance(ns.Scene("friction", observable="abs(y)")),
    ),
    "kappa": (
        lambda: ns.extrapolation_length(FRICTION, tol=1e-20),
        lambda: ns.extrapolation_length(FRICTION),
    ),
    "gap": (lambda: ns.spectral_gap(FRICTION, tol=1e-20), lambda: ns.spectral_gap(FRICTION)),
}


@pytest.mark.parametrize("name", OUT_OF_REACH)
def test_refused_estimates_are_right(name):
    """Within the errors of both."""
    refused, right = OUT_OF_REACH[name]
    with pytest.raises(ToleranceError) as refusal:
        refused()
    best, reference = refusal.value.result, right()
    assert isinstance(best, ns.Estimate)
    assert abs(best.value - reference.value) <= best.error + reference.error


REFUSED_DATASETS = {
    "v": (
        lambda **given: ns.variance(FRICTION, [1.0, 5.0], **given),
        1e-25,
        "v",
    ),
    "v by Monte Carlo": (
        lambda **given: ns.variance(FRICTION, [1.0, 5.0], method="monte_carlo", **given),
        1e-7,
        "v",
    ),
    "W": (lambda **given: ns.crossing_probability(FRICTION, 0.6, [2.0], **given), 1e-16, None),
    "W from afar": (
        lambda **given: ns.crossing_probability(
            FRICTION.with_n(10).with_start({"y": 6.0}), 3.0, [1.0], **given
        ),
        1e-12,
        None,
    ),
    "W by Monte Carlo": (
        lambda **given: ns.crossing_probability(
            FRICTION, 0.6, [2.0], method="monte_carlo", **given
        ),
        1e-7,
        None,
    ),
    "W by the corrected formula": (
        lambda **given: ns.crossing_probability(FRICTION, 0.6, [2.0], p=100, order=3, **given),
        1e-12,
        None,
    ),
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow) if name in ("W", "W from afar") else name
        for name in REFUSED_DATASETS
    ],
)
def test_refused_datasets_are_right(name, monkeypatch):
    """They are what the default returns, within the errors of both (five standard errors).

    Solvers are left the three coarsest of their levels.
    """
    ask, tol, variable = REFUSED_DATASETS[name]
    variable = variable or "probability"
    usual = ask()
    for settings in ("LINE", "LINE_FROM_AFAR"):
        levels = getattr(first_passage, settings).levels[:3]
        coarse = replace(getattr(first_passage, settings), levels=levels)
        monkeypatch.setattr(first_passage, settings, coarse)
    with pytest.raises(ToleranceError) as refused:
        ask(tol=tol)
    best = refused.value.result
    assert best.attrs["method"] == usual.attrs["method"]
    distance = abs(best[variable] - usual[variable])
    bias = sum(abs(found.get("step_bias", 0.0)) for found in (best, usual))
    errors = best[f"{variable}_error"] + usual[f"{variable}_error"]
    times = 5 if usual.attrs["method"] == "monte_carlo" else 1
    assert (distance <= times * errors + 2 * bias).all()


@pytest.mark.slow
def test_densities_that_miss_the_tolerance_are_kept(monkeypatch):
    """Finer grids change them by less than stated."""
    points = {"y": np.linspace(-2, 2, 41), "x": np.linspace(-1, 1, 41)}
    scene, found = ns.Scene("elasto_plastic", potential="x**2/2", n=100), []
    for largest in (100_000, 300_000):
        chosen = replace(tuning.INVARIANT_DENSITY, largest_layered=largest)
        monkeypatch.setattr(tuning, "INVARIANT_DENSITY", chosen)
        with pytest.raises(ToleranceError, match="values up to") as refused:
            ns.invariant_density(scene, tol=1e-12, points=points)
        found.append(refused.value.result)
    coarse, fine = found
    for name in ("density_y", "density_x", "density_y_x"):
        assert float(fine[f"{name}_error"]) < float(coarse[f"{name}_error"])
        change = abs(fine[name] - coarse[name])
        assert bool((change <= coarse[f"{name}_error"] + fine[f"{name}_error"]).all())


@pytest.mark.slow
def test_the_default_is_answered_with_a_warning():
    """Without tol, what a solver misses is returned; and what is stated holds."""
    scene = ns.Scene("elasto_plastic", potential="x**2/2", n=3000.0)
    with pytest.warns(AccuracyWarning, match="because no tol was given"):
        found = ns.invariant_density(scene, method="deterministic")
    assert found.density_x_error > 1e-6 * found.density_x.max()


def test_what_is_reached_of_another_quantity_is_no_result():
    """A formula whose gamma^2 misses its tolerance does not return gamma^2 as a probability."""
    with (
        pytest.raises(ToleranceError, match="2 has an error of 1") as refused,
        of_another_quantity(),
    ):
        refusal(result=2.0)()
    assert refused.value.result is None
