"""Thresholds and times at which W takes a value: they invert W, by every method."""

import numpy as np
import pytest
import xarray as xr
from scipy import optimize

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.reliability import quantiles
from nonsmooth.reliability.reach import typical_time
from references import FRICTION, GAMMA2

DEAD_BAND = ns.Scene("friction", observable="sign(y)*max(abs(y) - 0.3, 0)")


@pytest.mark.slow
def test_deterministic_threshold_inverts_W_and_the_time_inverts_the_threshold():
    """W at the limits is on either side of P, by more than its error; T is found again."""
    asked = {"method": "deterministic", "tol": 1e-4}
    found = ns.crossing_threshold(FRICTION, 0.1, 2.0, **asked).squeeze()
    W = ns.crossing_probability(FRICTION, found[["lower", "threshold", "upper"]].to_array(), [2.0])
    assert W["lower"][0, 0] > 0.1 > W["upper"][2, 0]
    assert abs(W["probability"][1, 0] - 0.1) < 1e-4
    assert 0 < found["threshold_error"] < 1e-3
    time = ns.failure_time(FRICTION, float(found["threshold"]), 0.1, **asked).squeeze()
    slack = 2 * float(found["threshold_error"] / found["threshold"])  # T ~ b^2, at most
    assert time["lower"] * (1 - 2 * slack) < 2.0 < time["upper"] * (1 + 2 * slack)


@pytest.mark.parametrize(
    "sides", ["both", *(pytest.param(s, marks=pytest.mark.slow) for s in ("upper", "lower"))]
)
def test_at_large_p_the_threshold_is_that_of_brownian_motion(sides):
    """A closed root of W_star; its distance is at most that of kappa / sqrt(p) at p = 10^8."""
    lower = None if sides == "both" else -np.inf
    for P in (1e-5, 0.2, 0.9):
        exact = optimize.brentq(
            lambda b, P=P: float(ns.brownian_crossing(b, 3 * GAMMA2, lower)) - P, 1e-3, 10
        )
        for method, order in (("asymptotic", None), ("corrected", 1)):
            found = ns.crossing_threshold(
                FRICTION, P, 3.0, p=1e8, sides=sides, method=method, order=order
            ).squeeze()
            assert found["lower"] - 1e-4 < exact < found["upper"] + 1e-4
            assert abs(found["threshold"] - exact) < 1e-4


def test_paths_do_not_serve_all_horizons_because_the_shortest_takes_them(monkeypatch):
    """Their number is that of the longest horizon, where solving is the faster."""
    given = []

    def crossing(scene, levels, horizons, method=None, tol=None, **_):
        given.append(method)
        W = np.array([ns.brownian_crossing(b, horizons, a) for a, b in np.atleast_2d(levels)])
        part = {"probability": W, "lower": W - 1e-6, "upper": W + 1e-6}
        part["probability_error"] = np.full_like(W, 1e-6)
        values = {name: (("threshold", "horizon"), value) for name, value in part.items()}
        quick = "monte_carlo" if horizons[-1] < 1 else "deterministic"
        return xr.Dataset(values, attrs={"method": method or quick})

    monkeypatch.setattr(quantiles, "crossing_probability", crossing)
    found = ns.crossing_threshold(FRICTION, 0.2, [0.5, 2.0], tol=1e-3)
    for b, T in zip(found["threshold"].values[0], (0.5, 2.0), strict=True):
        assert abs(float(ns.brownian_crossing(b, T)) - 0.2) < 1e-5
    assert set(given) == {None}


def test_one_curve_tells_a_time(monkeypatch):
    """W at many times costs what it costs at one: those near the guess are enough."""
    asked = []

    def crossing(*question, **options):
        asked.append(question)
        return ns.crossing_probability(*question, **options)

    monkeypatch.setattr(quantiles, "crossing_probability", crossing)
    found = ns.failure_time(FRICTION, 0.6, 0.3, tol=1e-5).squeeze()
    assert len(asked) == 1
    W = ns.crossing_probability(FRICTION, 0.6, [float(found["time"])], tol=1e-7)
    assert abs(W["probability"].item() - 0.3) < 1e-5


def test_sampled_threshold_and_time_agree_with_the_deterministic_ones():
    """95 % limits by fixed seeds; the same paths serve several P and T."""
    asked = {"probability": [0.1, 0.4], "horizons": [2.0, 4.0]}
    sampled = ns.crossing_threshold(FRICTION, **asked, method="monte_carlo", seed=2, p=2.0)
    exact = ns.crossing_threshold(FRICTION, **asked, p=2.0, method="corrected", order=3)
    assert dict(sampled.sizes) == {"probability": 2, "horizon": 2}
    assert np.all(sampled["lower"] < exact["upper"])
    assert np.all(exact["lower"] < sampled["upper"])
    assert np.all(sampled["upper"] / sampled["lower"] < 1.12)
    median = ns.failure_time(FRICTION, 0.6, method="monte_carlo", seed=3)
    solved = 4.630412  # by the deterministic method
    assert median["lower"] < solved < median["upper"]
    assert abs(float(median["time"][0]) - solved) < 4 * float(median["time_error"][0])


def test_paths_are_counted_for_what_is_asked(monkeypatch):
    """A rare crossing takes many, a likely one few: not what W = 1/2 to a tenth of 0.01 takes.

    That would be four million, for levels between those of two times.
    """
    taken, solve = [], quantiles.crossing_probability

    def noted(*question, paths, **options):
        taken.append(paths)
        return solve(*question, paths=paths, **options)

    asked = {"probability": [0.01, 0.4], "horizons": [2.0, 4.0], "p": 2.0}
    exact = ns.crossing_threshold(FRICTION, **asked, method="corrected", order=3)
    monkeypatch.setattr(quantiles, "crossing_probability", noted)
    sampled = ns.crossing_threshold(FRICTION, **asked, method="monte_carlo", seed=4)
    # 16 P (1 - P) / tol^2, three standard errors within three quarters of the tolerance
    assert max(taken) == pytest.approx(16 * 0.01 * 0.99 / 0.001**2, rel=1e-3)
    assert sorted(taken)[-2] == pytest.approx(16 * 0.4 * 0.6 / 0.01**2, rel=1e-3)
    assert np.all(sampled["lower"] < exact["upper"])
    assert np.all(exact["lower"] < sampled["upper"])
    with pytest.raises(ToleranceError, match=r"would take Monte Carlo 2e\+09 paths"):
        ns.crossing_threshold(FRICTION, 1e-6, 2.0, method="monte_carlo")


def test_scenes_without_solver_are_sampled():
    """Coloured noise and n = inf; the probability of the found threshold is the one asked for."""
    scene = ns.Scene("elasto_plastic", "langevin", n=np.inf)
    found = ns.crossing_threshold(scene, 0.2, 2.0, sides="upper").squeeze()
    assert found.attrs["method"] == "monte_carlo"
    level = (-np.inf, float(found["threshold"]))
    W = ns.crossing_probability(scene, level, [2.0], seed=9).squeeze()
    # two independent errors of 0.01, of three standard errors each
    assert abs(W["probability"] - 0.2) < 0.02


@pytest.mark.parametrize(
    ("ask", "cure"),
    [
        (lambda: ns.crossing_threshold(FRICTION, 0.0, 2.0), "between 0 and 1"),
        (lambda: ns.crossing_threshold(FRICTION, [0.1, 1.0], 2.0), "between 0 and 1"),
        (lambda: ns.crossing_threshold(FRICTION, 0.1, 2.0, sides="left"), "choose from both"),
        (lambda: ns.crossing_threshold(DEAD_BAND, 0.9, 0.02), "likelier that int g stays 0"),
        (lambda: ns.failure_time(FRICTION, -0.6), "threshold > 0"),
        (lambda: ns.failure_time(FRICTION, 1e30), "threshold is 1e.30, which is crossed at"),
        (lambda: ns.failure_time(FRICTION, 0.6, "half"), "give numbers"),
        (lambda: ns.failure_time(FRICTION, 0.6, method="counting", paths=100), "choose from"),
        (lambda: ns.failure_time(FRICTION, 0.6, method="monte_carlo", order=2), "no parameter"),
        (lambda: ns.crossing_threshold(FRICTION, 0.1, 2.0, step=0.1, order=1), "no parameter"),
    ],
)
def test_bad_requests_are_refused(ask, cure):
    """The error is one line with the cure."""
    with pytest.raises(SceneError, match=cure):
        ask()


def test_one_sided_thresholds_that_are_hardly_ever_missed():
    """At the threshold found, the formula gives the probability asked for, within its error."""
    asked = {"p": 1e4, "sides": "upper", "method": "corrected", "order": 3}
    for P in (0.9, 0.99):
        found = ns.crossing_threshold(FRICTION, P, 1.0, **asked).squeeze()
        level = (-np.inf, float(found["threshold"]))
        W = ns.crossing_probability(FRICTION, level, [1.0], 1e4, "corrected", order=3).squeeze()
        assert abs(W["probability"] - P) <= W["probability_error"]


def test_what_sampling_cannot_bracket_is_refused():
    """W is 0.82 at 1e-3, and hardly depends on the level: what has 0.99 is smaller than a step."""
    asked = {"sides": "upper", "method": "monte_carlo", "tol": 1e-2}
    with pytest.raises(ToleranceError, match="does not bracket"):
        ns.crossing_threshold(FRICTION, 0.99, 1.0, **asked)


def test_a_tolerance_out_of_reach_is_refused_with_the_best_root():
    """The corrected formula has an error of its own; the result has the limits it leaves."""
    asked = {"method": "corrected", "order": 3, "tol": 1e-6}
    with pytest.raises(ToleranceError, match="above tol") as refused:
        ns.crossing_threshold(FRICTION, 0.2, 2.0, **asked)
    found = refused.value.result.squeeze()
    assert found["lower"] < found["threshold"] < found["upper"]


@pytest.mark.parametrize(("spoilt", "refused"), [("farthest", False), ("nearest", True)])
def test_a_value_that_a_root_does_not_rest_on_may_miss_the_tolerance(monkeypatch, spoilt, refused):
    """Three times are asked for at once, of which the nearest to the root tells it."""
    target, solve = 0.5, quantiles.crossing_probability

    def worse(*question, **options):
        found = solve(*question, **options).copy(deep=True)
        far = np.abs(found["probability"].values - target)
        if spoilt == "farthest" and far.size == 1:
            return found
        place = np.unravel_index(far.argmax() if spoilt == "farthest" else far.argmin(), far.shape)
        for name, change in {"probability_error": 1e-3, "lower": -1e-3, "upper": 1e-3}.items():
            found[name].values[place] += change
        raise ToleranceError("one value is above tol", found)

    asked = {"method": "deterministic", "tol": 1e-4}
    exact = ns.failure_time(FRICTION, 0.6, target, **asked).squeeze()
    monkeypatch.setattr(quantiles, "crossing_probability", worse)
    if refused:
        with pytest.raises(ToleranceError, match="one value"):
            ns.failure_time(FRICTION, 0.6, target, **asked)
        return
    found = ns.failure_time(FRICTION, 0.6, target, **asked).squeeze()
    assert abs(found["time"] - exact["time"]) <= found["time_error"] + exact["time_error"]


@pytest.mark.slow
def test_times_of_near_thresholds():
    """Before damping matters int g scales like t^(3/2), and times like b^(2/3)."""
    near, nearer = (ns.failure_time(FRICTION, b).squeeze() for b in (1e-6, 1e-8))
    # friction is linear, with the rate n, while y is below 1/n; it changes times by n T = 2e-2;
    # the spread of an integrated velocity has the factor 1 - 3/8 n T, times change by less
    rates = FRICTION.damping + FRICTION.n
    ratio = float(near["time"] / nearer["time"])
    assert ratio == pytest.approx(100 ** (2 / 3), rel=rates * float(near["time"]))
    assert near["time_error"] < 1e-6 * near["time"]


def test_times_of_paths_that_hardly_differ():
    """The median is when the path without noise arrives; W rises within a part of 1e-7 of it.

    With dy = -(1 + y) dt from 5, int y = 6 (1 - exp(-t)) - t.
    """
    found = ns.failure_time(ns.Scene("friction", ns.White(1e-6), start={"y": 5.0}), 0.2).squeeze()
    exact = optimize.brentq(lambda t: 6 * (1 - np.exp(-t)) - t - 0.2, 0, 1, xtol=1e-16)
    # the exact one is rounded to 1e-16
    assert abs(found["time"] - exact) <= found["time_error"] + 1e-16
    assert found["time_error"] < 1e-12


@pytest.mark.parametrize("power", [0.5, 1.5])
@pytest.mark.parametrize("level", [1e-12, 1.0, 1e12])
def test_guesses_of_times(power, level):
    """Reaches that are powers of the time are inverted to within the factor asked for."""
    guess, found = typical_time(lambda time: 3 * time**power, level, 100.0)
    assert guess == pytest.approx((level / 3) ** (1 / power), rel=1e-9)
    assert found == pytest.approx(power)


@pytest.mark.slow
def test_what_takes_many_relaxation_times_is_left_to_the_formula():
    """The solver rounds there, and said 8.9e11 +- 1.3e13; W at that time is known to 1e-9."""
    scene = ns.Scene("friction", damping=1e6)
    found = ns.failure_time(scene, 1.0).squeeze()
    assert found.attrs["method"] == "corrected"
    # int g is a Brownian motion of variance gamma2 t there: W_star(1 / gamma, t) = 1/2
    gamma2 = ns.asymptotic_variance(scene).value
    limit = optimize.brentq(
        lambda T: float(ns.brownian_crossing(1 / np.sqrt(gamma2), T)) - 0.5, 1e11, 1e13
    )
    assert float(found["time"]) == pytest.approx(limit, rel=1e-5)


def test_what_never_moves_is_refused():
    """No time is known by which int g, which stays 0, reaches a level."""
    with pytest.raises(SceneError, match="int g stays 0 on most paths"):
        typical_time(lambda time: 0.0, 5.0, 100.0)
