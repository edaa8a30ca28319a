"""First passage marched in time against its Laplace transform."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.crossing.first_passage.plane import PlaneProblem, inverted, tame
from nonsmooth.crossing.first_passage.time_stepping import stepped
from nonsmooth.kinetic.marching.split_step import IMAGINARY
from references import COLORED_FRICTION, OBSTACLE, PLASTIC_STRAIN

TOLERANCE = 5e-3  # what coarse grids reach, and worth comparing


@pytest.mark.slow
def test_marching_agrees_with_the_transform():
    """After six relaxation times both serve.

    Each is as accurate as what a finer resolution of every part changes, doubled for the rest.
    """
    times = np.array([6.0, 7.0, 8.0])
    problem = PlaneProblem(OBSTACLE, -0.8, 1.2, times)
    march, invert = stepped(problem, times), inverted(problem, times, 0.0)
    marched, transformed = march((1, 1, 1, 0)), invert((1, 1, 1, 1))
    allowed = sum(
        np.abs(march(at) - marched) for at in [(2, 1, 1, 0), (1, 2, 1, 0), (1, 1, 2, 0)]
    ) + sum(np.abs(invert(at) - transformed) for at in [(2, 1, 1, 1), (1, 2, 1, 1), (1, 1, 0, 1)])
    assert np.all(np.abs(marched - transformed) <= 2 * allowed + 1e-5)
    assert np.max(allowed) < TOLERANCE


@pytest.mark.slow
@pytest.mark.parametrize(
    ("levels", "moves"), [((-np.inf, 0.3), (0.0, 1.0)), ((-0.2, np.inf), (1.0, 0.0))], ids=str
)
def test_imaginary_parts_are_derivatives_by_the_levels(levels, moves):
    """On one resolution, against differences of intervals with elements of their own.

    These are coarse, and 2 % is left to what they miss.
    """
    times, spacing = np.array([1.2]), 1e-3

    def probability(way):
        moved = levels[0] - way * moves[0], levels[1] + way * moves[1]
        return stepped(PlaneProblem(OBSTACLE, *moved, times), times)((1, 1, 1, 1))[0, 0]

    found = stepped(PlaneProblem(OBSTACLE, *levels, times), times, moves)((1, 1, 1, 1))[0, 0]
    expected = (probability(spacing) - probability(-spacing)) / (2 * spacing)
    assert (found / IMAGINARY).real == pytest.approx(expected, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "level", "paths"),
    [(COLORED_FRICTION, 0.3, 4000), (PLASTIC_STRAIN, 0.3, 2000), (OBSTACLE, 0.8, 20000)],
)
def test_marching_agrees_with_monte_carlo(scene, level, paths):
    """On coarse grids, within 4.5 standard errors and the step's bias; false alarms 2e-5 in all."""
    p, horizon = 3, 2.0
    threshold, times = level * np.sqrt(p), np.array([p * horizon])
    found = stepped(PlaneProblem(scene, -threshold, threshold, times), times)((1, 1, 1, 0))[0]
    sample = ns.crossing_probability(scene, level, [horizon], p, step=0.02, paths=paths, seed=7)
    allowed = 4.5 * sample.standard_error + np.abs(sample.step_bias)
    allowed += 4.5 * sample.step_bias_error + TOLERANCE
    assert np.all(np.abs(found - sample.probability) < allowed)


def test_crossings_too_rare_are_none():
    """If hardly a path gets there in time, nothing is marched: the probability is 0."""
    times = np.array([1.0, 2.0])
    problem = PlaneProblem(COLORED_FRICTION, -8.0, 8.0, times)
    assert np.all(stepped(problem, times)((0, 0, 0, 0)) == [[0.0, 0.0], [1.0, 1.0]])


@pytest.mark.slow
def test_contours_are_accurate_once_they_are_tame():
    """Steps agree with them from then on, to what coarse grids reach; before, they need not."""
    times = np.array([0.5, 1.0, 2.0, 4.0, 8.0])
    problem = PlaneProblem(COLORED_FRICTION, -0.6, 0.6, times)
    bend = tame(problem, times)
    assert bend[-1]
    assert not bend[0]
    assert np.all(np.diff(bend.astype(int)) >= 0)
    late = times[bend]
    problem = PlaneProblem(COLORED_FRICTION, -0.6, 0.6, late)
    marched = stepped(problem, late)((2, 2, 1, 2))
    transformed = inverted(problem, late, 0.0)((2, 2, 0, 1))
    assert np.max(np.abs(marched - transformed)) < TOLERANCE
