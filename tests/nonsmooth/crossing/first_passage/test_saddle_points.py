"""Saddle points: one contour for several problems."""

from collections.abc import Callable

import numpy as np

from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.inversion import contour_solver
from nonsmooth.crossing.first_passage.problem import ContourSettings, LaplaceProblem
from nonsmooth.crossing.first_passage.saddle_points import in_common, saddle_points
from references import FRICTION

TIMES = np.geomspace(0.05, 50, 30)


class BrownianProblem(LaplaceProblem):
    """A Wiener process and levels at the distance b, whose transform is known."""

    def __init__(self, b: float):
        self.scene, self.lower, self.upper = FRICTION, -b, b

    @property
    def settings(self) -> ContourSettings:
        """Those of two variables: to an absolute accuracy."""
        return tuning.PLANE

    def coarse_transform(self, radius: float, depth: float) -> Callable[[complex], complex]:
        """Return 1 / cosh(b (2z)^(1/2)), with exponentials that do not overflow."""
        return self._transform

    def transform(self, resolution, times, rarity) -> Callable[[complex], complex]:
        """Return the same at all resolutions."""
        return self._transform

    def _transform(self, z):
        decay = np.exp(-self.upper * np.sqrt(2 * complex(z)))
        return 2 * decay / (1 + decay**2)


def test_one_contour_serves_several_levels():
    """Common contours are as good as their truncation for levels that are four times as far.

    Where the probability of one is negligible, contours are those of the others.
    """
    problems = [BrownianProblem(b) for b in (0.7, 1.0, 2.8)]
    saddles = [saddle_points(problem, TIMES) for problem in problems]
    counts = np.array([own.bound >= np.log(tuning.PLANE.least_probability) for own in saddles])
    assert not counts.all()
    common = in_common(saddles, counts)
    nothing = np.array([np.zeros(len(TIMES)), np.ones(len(TIMES))])
    for problem, here in zip(problems, counts, strict=True):
        solve = contour_solver(problem, TIMES, 0.0, common)
        found, *_ = solve(tuning.PLANE.levels[-1], nothing, here)
        gap = np.abs(found[0] - brownian_crossing(problem.upper, TIMES))
        # the terms left out fall geometrically
        assert np.all(gap[here] <= 10 * tuning.PLANE.steady_truncation)


def test_one_problem_has_its_own_contours():
    """What is combined from one is that one."""
    own = saddle_points(BrownianProblem(1.0), TIMES)
    common = in_common([own], np.full((1, len(TIMES)), True))
    for name in ("place", "width", "bound", "tilt", "early", "steady"):
        assert np.array_equal(getattr(common, name), getattr(own, name))
