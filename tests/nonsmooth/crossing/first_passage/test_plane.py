"""First passage for two state variables on reduced ordinates."""

from dataclasses import replace

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.distribution import deterministic_crossing
from nonsmooth.crossing.first_passage.plane import PlaneProblem, SharedGrids, inverted
from nonsmooth.errors import ToleranceError
from nonsmooth.kinetic.bases import fields
from references import COLORED_FRICTION, OBSTACLE, PLASTIC


@pytest.mark.parametrize(
    ("start", "message"),
    [
        ({"y": 11.0}, "the start y = 11 is too far in the tails, beyond 3.7"),
        pytest.param(
            {"x": 2.16, "y": 3.7},
            "on a coarse grid and not between 0 and 1",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_starts_in_the_tails(start, message):
    """Refused, where all levels agreed that nothing crosses; without a method they are counted."""
    scene = OBSTACLE.with_n(10).with_start(start)
    with pytest.raises(ToleranceError, match=message):
        deterministic_crossing(scene, np.array([[-4.0, 4.0]]), np.array([8.0, 20.0]), 1e-3)
    found = ns.crossing_probability(scene, 4.0, [8.0, 20.0], seed=1)
    assert found.attrs["method"] == "monte_carlo"


@pytest.mark.slow
def test_elements_next_to_a_stiff_wall_converge(monkeypatch):
    """What two resolutions leave of the transform is at most about what they differ by.

    With one element up to the wall they differ by a fiftieth of that.
    """
    scene, levels = PLASTIC.with_n(256), (-0.6 * np.sqrt(10), 0.6 * np.sqrt(10))

    def transform(other):
        grids = SharedGrids(scene, np.array([levels]), np.array([20.0]))
        return grids.transform((2, other, 1), levels)(0.05)

    coarse, fine = transform(2), transform(3)
    finer = replace(
        tuning.PLANE_GRIDS,
        between=((6, (0.5, 0.85, 0.96, 0.99)),) * 8,
        other=((5, 8.0, 0.03),) * 8,
    )
    monkeypatch.setattr(SharedGrids.grid, "__defaults__", (finer,))
    exact = transform(2)
    assert exact != coarse, "the elements were not replaced"
    assert abs(exact - fine) < 1.5 * abs(fine - coarse)


@pytest.mark.slow
class TestCrossing:
    """The inverted transform against what does not use it."""

    def test_agrees_with_monte_carlo(self):
        """At late times, within 4.5 standard errors and the step's bias; false alarm 7e-6."""
        found = ns.crossing_probability(OBSTACLE, 0.8, [2.0], 300, method="deterministic", tol=2e-3)
        assert np.all(found.probability_error < 2e-3)
        sample = ns.crossing_probability(OBSTACLE, 0.8, [2.0], 300, step=0.02, paths=2000, seed=7)
        allowed = 4.5 * sample.standard_error + np.abs(sample.step_bias)
        allowed += 4.5 * sample.step_bias_error + found.probability_error
        assert np.all(np.abs(found.probability - sample.probability) < allowed)

    def test_requests_for_other_times_agree(self):
        """Answers for one time hold, whatever others are asked for, to the errors they state.

        The case where two grids agreed that both were wrong in y; Monte Carlo with 8e6 paths gives
        0.69682, and the sum of its standard error and of the bias of its step is 3e-4.
        """
        answers = [
            deterministic_crossing(
                COLORED_FRICTION, np.array([[-2.0, 2.0]]), 100 * np.array(horizons), 3e-4
            )
            for horizons in ([2.0, 4.0], [4.0, 5.2])
        ]
        (late, late_error), (early, early_error) = (
            (found["probability"][0, k], found["probability_error"][0, k])
            for found, k in zip(answers, (1, 0), strict=True)
        )
        assert abs(late - early) <= late_error + early_error
        for value, error in ((late, late_error), (early, early_error)):
            assert abs(value - 0.69682) <= error + 3e-4

    def test_hardly_damped_obstacles(self):
        """Two levels agreed to 4e-4 on what is 8e-4 off.

        Steps in time with up to 54 Hermite polynomials give 0.90274, settled to 4e-5.
        """
        scene = ns.Scene(
            "obstacle", ns.White(0.725), damping=0.3166, n=176.0, potential="x**2/2", observable="x"
        )
        levels, times = np.array([[-3.852, 2.1645]]), np.array([92.62])
        found = deterministic_crossing(scene, levels, times, 1e-3)
        assert abs(found["probability"][0, 0] - 0.90274) <= found["probability_error"][0, 0] + 4e-5

    def test_asking_for_less_costs_no_more(self, monkeypatch):
        """Fewer times, or a larger tolerance, take at most 1.2 times the work.

        Much of it are modes of all nodes, whose cost grows like the cube of their number.
        """
        work, solve = [], fields.fields

        def counted(grid, *arguments):
            work.append(len(grid.speeds) ** 3)
            return solve(grid, *arguments)

        def asked(times, tol):
            work.clear()
            deterministic_crossing(OBSTACLE, np.array([[-6.0, 6.0]]), times, tol)
            return sum(work)

        monkeypatch.setattr(fields, "fields", counted)
        times, rng = 100 * np.geomspace(0.5, 20, 12), np.random.default_rng(5)
        whole = asked(times, 1e-2)
        for _ in range(2):
            some = np.sort(rng.choice(times, rng.integers(1, 6), replace=False))
            assert asked(some, 1e-2) <= 1.2 * whole
        assert asked(times, 3e-2) <= 1.2 * whole


@pytest.mark.parametrize("scene", [COLORED_FRICTION, OBSTACLE.with_n(5)])
def test_thresholds_beside_the_start_are_refused(scene):
    """All grids agree that paths cross at once there; Monte Carlo answers."""
    with pytest.raises(ToleranceError, match="threshold at 1e-05 from the start"):
        PlaneProblem(scene, -1e-5, 1.0, np.array([1.0]))
    run = ns.crossing_probability(scene, 1e-5, [0.005, 0.05], tol=1e-2)
    assert run.attrs["method"] == "monte_carlo"
    assert run.probability[0] < 0.05 < 0.5 < run.probability[1]


def test_thresholds_that_the_driven_variable_crosses_are_not():
    """The grid is made for the shortest time in that variable."""
    PlaneProblem(PLASTIC.with_n(5), -1e-3, 1e-3, np.array([1e-3]))


@pytest.mark.parametrize("tol", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("count", [None, 5])
def test_fitted_values_of_the_transform_are_nearly_exact(tol, count):
    """Against values at all nodes, for all times or only the first of them.

    Two fits that agree may share an error. Of random transforms the worst was 6.6 times as far off
    as the last fit had changed.
    """
    times, level = np.geomspace(8, 160, 9), 1.5
    problem = PlaneProblem(OBSTACLE, -level, level, times)
    fitted, every = (inverted(problem, times, asked) for asked in (tol, 0.0))
    settings = tuning.CONTOUR_FITS
    apart = np.abs(fitted((0, 0, 0, 1), count) - every((0, 0, 0, 1), count))
    assert 0 < apart.max() < 7 * settings.share * min(tol, settings.loosest)
