"""The deterministic first passage: which scenes have one, and starts far away."""

import numpy as np
import pytest
from scipy.special import ndtr

import nonsmooth as ns
from nonsmooth.crossing.first_passage import distribution, tuning
from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.crossing.first_passage.time_stepping import stepped
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.kinetic.ordinates_plane import UnstableError
from references import COLORED_FRICTION, PLASTIC_STRAIN, far


def deterministic(scene, threshold, horizons, tol=1e-7):
    """Values of the deterministic method."""
    return ns.crossing_probability(scene, threshold, horizons, method="deterministic", tol=tol)


def test_a_scene_of_four_variables_is_told_to_sample():
    """Four variables have no deterministic method; the message names Monte Carlo."""
    scene = ns.Scene("elasto_plastic", "hamiltonian")
    with pytest.raises(SceneError, match="monte_carlo"):
        ns.crossing_probability(scene, 0.3, [1.0], 30, method="deterministic")


def test_other_scenes_are_told_to_sample():
    """Three variables have no deterministic method; the message names Monte Carlo."""
    with pytest.raises(ns.NonsmoothError, match="monte_carlo"):
        ns.crossing_probability(
            ns.Scene("friction", "hamiltonian"), 0.6, [1.0], method="deterministic", tol=1e-7
        )


def test_crossings_in_flight():
    """A start of depth 2600: a step, as wide as the normal law says; mirrored, the same."""
    horizons = [0.011, 0.012, 0.0121, 0.1, 100.0]
    found = deterministic(far(50.0), 0.6, horizons)
    # int y = 50 t - 51 t^2 / 2 + int W, but for t^3
    t = np.array(horizons[:3])
    rough = ndtr((50 * t - 25.5 * t**2 + 8.5 * t**3 - 0.6) / (t**1.5 / np.sqrt(3)))
    assert np.allclose(found.probability[:3], rough, rtol=0.05, atol=1e-7)
    assert np.all(found.probability[3:] == 1)
    assert np.all(found.probability_error <= 1e-7)
    mirrored = deterministic(far(-50.0), 0.6, horizons)
    assert np.allclose(mirrored.probability, found.probability, rtol=0, atol=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "horizon", "exact"),
    # on elements of degree 14, where degree 11 has the same nine digits
    [(6.0, 9.0, 0.9769495172)],
)
def test_neighbouring_degrees_do_not_agree_by_chance(start, horizon, exact):
    """From afar degrees 6 and 7 share an error; what is stated holds all the same."""
    found = deterministic(ns.Scene("friction", start={"y": start}), 3.0, [horizon])
    rounded = 1e-10  # of the value printed here
    assert abs(found.probability[0] - exact) <= found.probability_error[0] + rounded


def test_ways_that_noise_does_not_change():
    """With g = sign(y) int g is the time until y is 0, which takes ln 6 without noise."""
    found = deterministic(far(5.0, observable="sign(y)"), 0.2, [0.1, 0.3, 1.0])
    assert found["probability"].values.tolist() == [0.0, 1.0, 1.0]


@pytest.mark.slow
def test_monte_carlo_from_afar():
    """The wall is next to where the flight ends; 4.5 standard errors: false alarm 7e-6."""
    found = deterministic(far(5.0), 2.0, [0.5], tol=1e-5)
    sample = ns.crossing_probability(far(5.0), 2.0, [0.5], paths=40_000, step=0.005, seed=3)
    bias = np.abs(sample.step_bias) + sample.step_bias_error
    gap = np.abs(sample.probability - found.probability)
    assert gap[0] < 4.5 * sample.standard_error[0] + bias[0]
    assert found.probability_error[0] <= 1e-5


def test_refused_where_g_changes_its_sign():
    """A start where g changes its sign on the way to the bulk is told to sample."""
    with pytest.raises(ns.NonsmoothError, match="monte_carlo"):
        deterministic(far(8.0, observable="y*(y**2 - 49)"), 0.6, [1.0])


@pytest.mark.slow
class TestEarlyTimes:
    """Steps in time serve narrow intervals, and times at which contours are not tame."""

    @pytest.fixture
    def stepped_at(self, monkeypatch):
        """Return a list of the times that steps were asked for."""
        asked = []

        def noted(problem, times):
            asked.extend(times)
            return stepped(problem, times)

        monkeypatch.setattr(distribution, "stepped", noted)
        return asked

    def test_tame_ones_need_none(self, stepped_at):
        """Contours may bend within ten relaxation times, where the interval is not narrow."""
        times = np.array([8.0, 9.5])
        found = deterministic_crossing(COLORED_FRICTION, np.array([[-1.0, 1.0]]), times, 1e-2)
        assert not stepped_at
        assert np.all(found["probability_error"] <= 1e-2)

    @pytest.mark.parametrize(("part", "goes_on"), [(0.99, True), (1.01, False)])
    def test_steps_go_on_where_the_last_time_is_near(self, stepped_at, part, goes_on):
        """It would need none alone, and is at most `near` times as late as one that does."""
        times = np.array([8.0 / (part * tuning.TIME_STEPPING.near), 8.0])
        deterministic_crossing(COLORED_FRICTION, np.array([[-1.0, 1.0]]), times, 1e-2)
        assert stepped_at == (times if goes_on else times[:1]).tolist()

    @pytest.mark.parametrize("levels", [(-0.2, 0.2), (-np.inf, 0.2)])
    def test_narrow_ones_are_marched(self, stepped_at, levels):
        """Within a relaxation time int g goes farther than to the levels, or to the only one."""
        times = np.array([1.0, 2.0])
        deterministic_crossing(PLASTIC_STRAIN, np.array([levels]), times, 1e-2)
        assert stepped_at == [*times]


class TestWhereContoursFail:
    """Steps in time answer up to some times; later, the refusal says what helps."""

    @pytest.fixture(autouse=True)
    def unstable(self, monkeypatch):
        """Let all solutions fail."""

        def fails(*problem_and_times):
            def solve(at, count):
                raise UnstableError("the solutions amplify")

            return solve

        monkeypatch.setattr(distribution, "inverted", fails)

    @pytest.mark.slow
    def test_steps_take_over(self, monkeypatch):
        """They agree with contours within what both state."""
        levels, times, tol = np.array([[-1.0, 1.0]]), np.array([8.0, 12.0]), 1e-2
        by_steps = deterministic_crossing(COLORED_FRICTION, levels, times, tol)
        monkeypatch.undo()
        by_contours = deterministic_crossing(COLORED_FRICTION, levels, times, tol)
        allowed = by_steps["probability_error"] + by_contours["probability_error"]
        assert np.all(np.abs(by_steps["probability"] - by_contours["probability"]) <= allowed)

    def test_too_late_for_steps(self):
        """Fifty relaxation times are more than steps are tried for."""
        levels, times = np.array([[-1.0, 1.0]]), np.array([50.0])
        with pytest.raises(ToleranceError, match="amplify; use method='monte_carlo'"):
            deterministic_crossing(COLORED_FRICTION, levels, times, 1e-3)

    def test_steps_that_went_on_are_not_tried_twice(self, monkeypatch):
        """Where they miss the later time, they would miss it again."""
        asked = []

        def irregular(problem, times):
            asked.append(times.tolist())

            def solve(at, count):
                probability = np.array([0.5, 0.5 + 0.1 * (-1.0) ** sum(at)])
                return np.array([probability, 1 - probability])[:, :count]

            return solve

        monkeypatch.setattr(distribution, "stepped", irregular)
        with pytest.raises(ToleranceError, match="use method='monte_carlo'"):
            deterministic_crossing(
                COLORED_FRICTION, np.array([[-1.0, 1.0]]), np.array([1.0, 8.0]), 1e-3
            )
        assert asked == [[1.0, 8.0]]

    def test_what_is_not_finite(self, monkeypatch):
        """It is no answer."""
        monkeypatch.setattr(
            distribution, "inverted", lambda *problem: lambda at, count: np.full((2, 1), np.nan)
        )
        with pytest.raises(ToleranceError, match="not finite; use method='monte_carlo'"):
            deterministic_crossing(COLORED_FRICTION, np.array([[-1.0, 1.0]]), np.array([50.0]), 0.1)
