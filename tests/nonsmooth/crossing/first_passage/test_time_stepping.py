"""First passage marched in time against its Laplace transform."""

import numpy as np
import pytest

from nonsmooth.crossing.first_passage.plane import PlaneProblem, inverted
from nonsmooth.crossing.first_passage.time_stepping import stepped
from references import COLORED_FRICTION, OBSTACLE

TOLERANCE = 5e-3  # what coarse grids reach, and worth comparing


@pytest.mark.slow
def test_marching_agrees_with_the_transform():
    """After six relaxation times both serve.

    Each is as accurate as what a finer resolution of every part changes, doubled for the rest.
    """
    times = np.array([6.0, 7.0, 8.0])
    problem = PlaneProblem(OBSTACLE, -0.8, 1.2, times)
    march, invert = stepped(problem, times), inverted(problem, times)
    marched, transformed = march((0, 0, 0, 0)), invert((0, 0, 1, 1))
    allowed = sum(
        np.abs(march(at) - marched) for at in [(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0)]
    ) + sum(np.abs(invert(at) - transformed) for at in [(1, 0, 1, 1), (0, 1, 1, 1), (0, 0, 0, 1)])
    assert np.all(np.abs(marched - transformed) <= 2 * allowed + 1e-5)
    assert np.max(allowed) < TOLERANCE


def test_crossings_too_rare_are_none():
    """If hardly a path gets there in time, nothing is marched: the probability is 0."""
    times = np.array([1.0, 2.0])
    problem = PlaneProblem(COLORED_FRICTION, -8.0, 8.0, times)
    assert np.all(stepped(problem, times)((0, 0, 0, 0)) == [[0.0, 0.0], [1.0, 1.0]])
