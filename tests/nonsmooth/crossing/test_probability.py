"""The public function for crossing probabilities: its limit, its choice of a method, refusals."""

import numpy as np
import pytest
from scipy import special

import nonsmooth as ns
from nonsmooth.crossing.first_passage import line
from nonsmooth.errors import AccuracyWarning, SceneError, ToleranceError
from nonsmooth.kinetic import case_modes
from nonsmooth.kinetic.bases import fields
from nonsmooth.kinetic.bases.reduced_ordinates import ReducedOrdinates
from references import COLORED_FRICTION, FRICTION, GAMMA2, OBSTACLE, SKEWED, W_STAR

HORIZONS = np.linspace(0, 2, 11)[1:]


def test_asymptotic_method_is_the_limit():
    """W_star with gamma^2 in closed form; the error of the limit is that of gamma^2."""
    run = ns.crossing_probability(FRICTION, 0.6, [2.0], method="asymptotic")
    assert float(run["probability"][0]) == pytest.approx(W_STAR, abs=5e-8)
    assert float(run["limit_error"][0]) < 1e-13
    one_sided = ns.crossing_probability(FRICTION, (-np.inf, 0.6), [2.0], method="asymptotic")
    exact = special.erfc(0.6 / np.sqrt(2 * 2.0 * GAMMA2))
    assert float(one_sided["probability"][0]) == pytest.approx(exact, abs=1e-13)


@pytest.mark.slow
def test_errors_mean_the_same_for_every_method():
    """The error bounds the distance; that of Monte Carlo times 5 (a false alarm in 10^5)."""
    exact = ns.crossing_probability(FRICTION, 0.6, HORIZONS, p=2.0, method="deterministic")
    for method in ("asymptotic", "corrected", "monte_carlo"):
        run = ns.crossing_probability(FRICTION, 0.6, HORIZONS, p=2.0, method=method)
        sampled = method == "monte_carlo"
        error = (5 if sampled else 1) * run["probability_error"] + exact["probability_error"]
        assert np.all(np.abs(run["probability"] - exact["probability"]) <= error)
        assert np.all((run["lower"] <= run["probability"]) & (run["probability"] <= run["upper"]))
        if not sampled:
            assert np.all(run["lower"] <= exact["upper"])
            assert np.all(exact["lower"] <= run["upper"])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_the_distance_of_the_limit_to_a_finite_p_is_bounded(seed):
    """On random scenes of one variable, odd and centred ones, p from 0.1 to 10^4."""
    rng = np.random.default_rng(seed)
    noise, n, damping = ns.White(rng.uniform(0.5, 2)), 10 ** rng.uniform(0, 3), rng.uniform(0.2, 3)
    g = ("y", "tanh(2*y)", "y/(1 + abs(y))", "y + max(y, 0)")[seed % 4]
    drift = ns.mean(ns.Scene("friction", noise, n, damping, observable=g)).value
    start = {"y": rng.uniform(-1, 1)}
    scene = ns.Scene("friction", noise, n, damping, observable=f"{g} - ({drift!r})", start=start)
    gamma = np.sqrt(ns.asymptotic_variance(scene).value)
    b = gamma * rng.uniform(0.5, 3)
    threshold = (b, (-b / 2, b), (-np.inf, b))[seed % 3]
    for p in (0.1, 10.0, 1e4):
        limit = ns.crossing_probability(scene, threshold, [0.5, 2.0], p, method="asymptotic")
        exact = ns.crossing_probability(
            scene, threshold, [0.5, 2.0], p, method="deterministic", tol=1e-5
        )
        distance = np.abs(limit["probability"] - exact["probability"])
        assert np.all(distance <= limit["probability_error"] + exact["probability_error"])
    assert np.all(limit["probability_error"] < 0.1)  # at p = 10^4 it is no empty bound


def test_where_nothing_bounds_the_distance_the_error_is_the_trivial_one():
    """A g above V, which a single excursion carries across, by the limit and its correction."""
    beyond = ns.Scene("friction", n=100, observable="y**3")
    for method in ("asymptotic", "corrected"):
        run = ns.crossing_probability(beyond, 0.6, [2.0], p=1e4, method=method)
        W = float(run["probability"][0])
        assert float(run["probability_error"][0]) >= max(W, 1 - W)


def test_derivatives_have_no_limit():
    """gamma^2 = 0; the line names another g."""
    scene = ns.Scene("obstacle", observable="y")
    with pytest.raises(SceneError, match=r"gamma\^2 = 0 .* choose another g, such as x"):
        ns.crossing_probability(scene, 0.6, [2.0], method="asymptotic")


@pytest.mark.slow
def test_corrected_formula_is_taken_where_its_error_is_small():
    """At large p it is taken, but not for a g above V, nor for a tol below its error."""
    problem = {"threshold": 0.6, "horizons": HORIZONS, "p": 1000.0}
    run = ns.crossing_probability(FRICTION, **problem, tol=1e-4)
    exact = ns.crossing_probability(FRICTION, **problem, method="deterministic")
    assert run.attrs["method"] == "corrected"
    assert np.max(np.abs(run["probability"] - exact["probability"])) < 1e-4
    assert ns.crossing_probability(FRICTION, **problem, tol=2e-8).attrs["method"] == "deterministic"
    beyond = ns.Scene("friction", n=100, observable="y**3")
    run = ns.crossing_probability(beyond, 0.6, [2.0], p=1000.0, tol=1e-4)
    assert run.attrs["method"] != "corrected"


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene",
    [
        ns.Scene("friction", "langevin"),
        ns.Scene("obstacle", potential="x**2/2", observable="x"),
        ns.Scene("elasto_plastic", potential="x**2/2", damping=0.3, n=10, start={"y": 1.0}),
    ],
    ids=lambda scene: scene.model,
)
def test_two_variables_at_large_p_have_the_formula(scene):
    """Order 1 is taken where p is far above 1 / tol, and is as close to the solver as it states."""
    gamma = np.sqrt(ns.asymptotic_variance(scene, tol=1e-3).value)
    asked = {"threshold": (-np.inf, 0.7 * gamma), "horizons": [0.3, 1.0, 3.0]}
    run = ns.crossing_probability(scene, **asked, p=1e5, tol=1e-3)
    solved = ns.crossing_probability(scene, **asked, p=1e5, method="deterministic", tol=1e-3)
    assert run.attrs["method"] == "corrected"
    distance = np.abs(run["probability"] - solved["probability"])
    assert np.all(distance <= run["probability_error"] + solved["probability_error"])
    default = ns.crossing_probability(scene, **asked, p=1e6)
    assert default.attrs["method"] == "corrected"
    assert np.all(default["probability_error"] <= 1e-4)
    few = ns.crossing_probability(scene, **asked, p=10.0, tol=1e-2)
    assert few.attrs["method"] != "corrected"


@pytest.mark.filterwarnings("ignore::nonsmooth.errors.AccuracyWarning")
@pytest.mark.parametrize("p", [1e8, 1e14, 1e20])
def test_at_huge_p_nothing_rounds(p):
    """W at p is within a layer of its limit, though E exp(-z tau) is 1 to all digits."""
    run = ns.crossing_probability(FRICTION, 1.0, HORIZONS, p=p)
    limit = ns.crossing_probability(FRICTION, 1.0, HORIZONS, method="asymptotic")
    assert np.all(run["probability_error"] < 1e-7)
    assert np.all(np.diff(run["probability"]) > 0)
    np.testing.assert_allclose(run["probability"], limit["probability"], atol=3 / np.sqrt(p) + 1e-8)


@pytest.mark.parametrize(
    ("arguments", "cure"),
    [
        ({"threshold": 0.0}, "threshold > 0"),
        ({"threshold": (0.1, 0.6)}, "lower < 0 < upper"),
        ({"p": -1.0}, "p is -1.0; give a positive"),
        ({"method": "montecarlo"}, "monte_carlo"),
        ({"method": "asymptotic"}, "no parameter 'paths'"),
        ({"step": -0.1}, "step is -0.1; give a positive"),
        ({"paths": 0}, "paths is 0; give a positive whole"),
        ({"paths": 1.5}, "whole number"),
        ({"horizons": []}, "a list of them"),
        ({"horizons": [0.0, 1.0]}, "numbers that increase"),
        ({"horizons": [1.0, 0.5]}, "numbers that increase"),
        ({"tol": 0.0}, "tol is 0.0; give a positive"),
    ],
)
def test_bad_requests_are_refused(arguments, cure):
    """The error is one line with the cure."""
    defaults = {"threshold": 0.6, "horizons": HORIZONS, "p": 1.0, "paths": 100}
    with pytest.raises(SceneError, match=cure):
        ns.crossing_probability(FRICTION, **(defaults | arguments))


def test_formula_refuses_an_observable_that_is_not_centred():
    """(equivalent) needs E g = 0; the message has the mean."""
    scene = ns.Scene("friction", observable="y**2")
    with pytest.raises(SceneError, match=r"E g = 0.*subtract"):
        ns.crossing_probability(scene, 0.6, [1.0], method="asymptotic")


@pytest.mark.parametrize(
    ("scene", "given", "method"),
    [
        (FRICTION, {}, "deterministic"),
        (FRICTION, {"tol": 1e-5}, "deterministic"),
        (FRICTION, {"tol": 1e-2}, "monte_carlo"),  # 1 ms against a second
        (FRICTION, {"paths": 10}, "monte_carlo"),
        (FRICTION, {"order": 1}, "corrected"),
        (FRICTION, {"p": 1e20}, "corrected"),  # rounding leaves the solver nothing
        (ns.Scene("friction", "hamiltonian"), {"tol": 0.1}, "monte_carlo"),
    ],
)
def test_method_follows_from_what_is_given(scene, given, method):
    """A tolerance, a number of paths or an order decides; the result names the method."""
    assert ns.crossing_probability(scene, 0.6, [1.0], **given).attrs["method"] == method


SEVERAL = (
    [0.3, 0.6, 1.2],
    np.array([(-0.3, 0.3), (-0.5, 0.7), (-0.7, 0.7)]),
    [(-0.3, np.inf), (-np.inf, 0.7)],
)


@pytest.mark.parametrize("thresholds", SEVERAL)
@pytest.mark.parametrize("method", ["monte_carlo", "corrected", "asymptotic"])
def test_each_row_of_several_thresholds_is_that_threshold(thresholds, method):
    """To the bit, by Monte Carlo on the same paths; opposite one-sided levels included."""
    sampled = {"step": 0.05, "paths": 3_000} if method == "monte_carlo" else {}
    asked = {"horizons": [0.5, 2.0], "p": 2.0, "method": method} | sampled
    run = ns.crossing_probability(FRICTION, thresholds, **asked)
    assert dict(run.sizes) == {"threshold": len(thresholds), "horizon": 2}
    for row, threshold in enumerate(thresholds):
        one = ns.crossing_probability(FRICTION, threshold, **asked)
        for name in ("probability", "probability_error"):
            assert np.array_equal(run[name][row], one[name])


@pytest.mark.parametrize(
    ("scene", "p", "tol"),
    [
        pytest.param(FRICTION, 2.0, 1e-4, marks=pytest.mark.slow),
        pytest.param(SKEWED, 2.0, 1e-4, marks=pytest.mark.slow),
        pytest.param(OBSTACLE, 100.0, 1e-2, marks=pytest.mark.slow),
    ],
)
def test_solved_thresholds_agree_with_each_alone(scene, p, tol):
    """To the sum of errors, though they share grids; far ones have grids of their own."""
    thresholds, asked = [(-0.3, 0.3), (-0.4, 0.7), (-np.inf, 0.9), (-3.0, 3.0)], {"tol": tol}
    asked |= {"horizons": [0.5, 2.0], "p": p, "method": "deterministic"}
    run = ns.crossing_probability(scene, thresholds, **asked)
    for row, threshold in enumerate(thresholds):
        one = ns.crossing_probability(scene, threshold, **asked)
        gap = np.abs(run["probability"][row] - one["probability"])
        assert np.all(gap <= run["probability_error"][row] + one["probability_error"])


@pytest.mark.slow
def test_one_more_threshold_costs_little(monkeypatch):
    """Eight thresholds take at most 2.5 times the modes of one, and one no more than eight."""
    solved = []

    def counted(grid, z):
        solved.append(len(grid.nodes) ** 3)
        return case_modes.modes(grid, z)

    monkeypatch.setattr(line, "modes", counted)
    thresholds, work = np.linspace(0.3, 1.0, 8), []
    for asked in (thresholds, 0.3, 0.6, 1.0):
        solved.clear()
        ns.crossing_probability(
            FRICTION, asked, np.linspace(0.02, 2, 20), p=10, method="deterministic", tol=1e-4
        )
        work.append(sum(solved))
    assert work[0] <= 2.5 * np.mean(work[1:])
    assert max(work[1:]) <= work[0]


@pytest.mark.slow
def test_thresholds_of_two_variables_share_fields_and_contours(monkeypatch):
    """Two take no more solutions than the one that takes most, and hardly more modes.

    Modes of all nodes serve halves, too. Those in a basis are taken at all places of all contours,
    of which several levels may need a few more.
    """
    solutions, modes, transform = [], [], ReducedOrdinates.first_passage
    solve = fields.fields

    def counted(grid, *arguments):
        solutions.append(len(grid.speeds) ** 3)
        return solve(grid, *arguments)

    def transformed(ordinates, *arguments):
        modes.append(ordinates.basis.shape[1] ** 3)
        return transform(ordinates, *arguments)

    monkeypatch.setattr(fields, "fields", counted)
    monkeypatch.setattr(ReducedOrdinates, "first_passage", transformed)
    thresholds, work = [0.15, 0.25], []
    for asked in (thresholds, *thresholds):
        solutions.clear()
        modes.clear()
        ns.crossing_probability(
            COLORED_FRICTION, asked, [2.0], p=100, method="deterministic", tol=1e-3
        )
        work.append((sum(solutions), sum(modes)))
    (together, *_), alone = work, np.max(work[1:], axis=0)
    assert together[0] <= alone[0]
    assert together[1] <= 1.5 * alone[1]


def test_coordinates_of_several_thresholds():
    """Numbers b are coordinates themselves; every interval has its lower and its upper level."""
    asked = {"horizons": [1.0], "method": "asymptotic"}
    numbers = ns.crossing_probability(FRICTION, [1.2, 0.3], **asked)
    assert numbers["threshold"].values.tolist() == [1.2, 0.3]
    assert float(numbers["probability"].sel(threshold=1.2, horizon=1.0)) < 0.01
    pairs = ns.crossing_probability(FRICTION, [(-0.3, 0.5), (-1.0, np.inf)], **asked)
    assert "threshold" not in pairs.coords
    for name, side in (("threshold_lower", [-0.3, -1.0]), ("threshold_upper", [0.5, np.inf])):
        assert pairs[name].values.tolist() == side


def test_one_set_of_paths_serves_all_thresholds_within_the_tolerance():
    """|error| <= tol for 30 thresholds and all horizons; a false alarm in 100 runs.

    The 30 need no more paths than the worst of them, that with W nearest to 1/2.
    """
    thresholds = np.linspace(0.1, 1.6, 30)
    asked = {"horizons": HORIZONS, "p": 10.0}
    run = ns.crossing_probability(FRICTION, thresholds, **asked, tol=0.01, method="monte_carlo")
    limit = ns.crossing_probability(FRICTION, thresholds, **asked, method="corrected", order=3)
    distance = np.abs(run["probability"] - limit["probability"])
    assert np.all(distance <= 0.01 + limit["probability_error"])
    assert run.attrs["paths"] <= 41_000


def test_what_misses_its_tolerance_is_told_with_all_thresholds():
    """The error of one threshold is raised; its result has them all."""
    asked = {"horizons": [2.0], "method": "corrected", "tol": 1e-3, "order": 3}
    with pytest.raises(ToleranceError, match=r"above tol = 0\.001") as refused:
        ns.crossing_probability(FRICTION, [0.05, 5.0], **asked)
    assert dict(refused.value.result.sizes) == {"threshold": 2, "horizon": 1}


@pytest.mark.slow
def test_no_error_of_a_probability_is_above_one():
    """Whatever a method finds, that much is known."""
    with pytest.warns(AccuracyWarning):
        found = ns.crossing_probability(FRICTION, 0.5, [1.0], p=1e30, method="deterministic")
    assert found.probability_error.max() <= 1
    assert found.survival_error.max() <= 1


def test_a_pole_of_g_is_told():
    """Its modes cannot be told apart."""
    scene = ns.Scene("friction", observable="1/(y**2 + 1e-12)")
    with pytest.raises(ns.NonsmoothError, match="Monte Carlo"):
        ns.crossing_probability(scene, 0.5, [1.0])


def test_very_late_crossings_of_an_uncentred_g():
    """The formulas that come before the solver there need E g = 0, but for the first."""
    scene = ns.Scene("friction", observable="y + 0.001")
    found = ns.crossing_probability(scene, 0.6, [2.0], 1e7, tol=1e-2)
    assert found.attrs["method"] == "corrected"
    # the drift carries int g to p T 0.001, ten times as far as the threshold is
    assert abs(found.probability[0] - 1) <= found.probability_error[0]
