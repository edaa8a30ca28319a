"""The contract: whoever keeps it is refined, inverted and given errors."""

from dataclasses import dataclass

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.crossing.first_passage.distribution import refined
from nonsmooth.crossing.first_passage.problem import (
    ContourLevel,
    ContourSettings,
    DirectProblem,
    LaplaceProblem,
    Settings,
)
from nonsmooth.errors import ToleranceError
from references import FRICTION

TIMES = np.array([0.01, 0.1, 1.0, 10.0, 30.0])


@dataclass(frozen=True)
class Brownian(LaplaceProblem):
    """Brownian motion between -b and b, whose transform is 1 / cosh(b sqrt(2 z))."""

    scene: ns.Scene
    lower: float
    upper: float

    @property
    def settings(self):
        """Three levels of contours for an exact transform."""
        return ContourSettings(
            default_tolerance=1e-8,
            coarse_tolerance=1e-4,
            levels=(ContourLevel(0, 8, 1.2), ContourLevel(0, 12, 0.9), ContourLevel(0, 16, 0.7)),
            relative=True,
            least_probability=1e-14,
            unseen_error=0.0,
            advice="loosen tol",
            least_transform=1e-70,
            window=2.5,
            rise_truncation=1e-12,
            steady_truncation=1e-10,
        )

    def coarse_transform(self, radius, depth):
        """Exact."""
        return lambda z: 1 / np.cosh(self.upper * np.sqrt(2 * complex(z)))

    def transform(self, resolution, times, rarity):
        """Exact."""
        return self.coarse_transform(1 / times[-1], rarity)


@dataclass(frozen=True)
class Known(DirectProblem):
    """The exact probability but for an error that a level tells."""

    scene: ns.Scene
    lower: float
    upper: float
    levels: tuple

    @property
    def settings(self):
        """Levels as given."""
        return Settings(1e-8, 1e-4, self.levels, False, 1e-14, 0.0, "do something else")

    def solve(self, times, level):
        """Shift the probability by the error of the level."""
        exact = np.array([float(ns.brownian_crossing(self.upper, t)) for t in times])
        return np.array([exact + level, 1 - exact - level])


def test_a_known_transform():
    """First passage of Brownian motion from its transform agrees with its series at all times."""
    found = refined(Brownian(FRICTION, -1.0, 1.0), TIMES, 1e-8)
    exact = np.array([float(ns.brownian_crossing(1.0, t)) for t in TIMES])
    survival = np.array([float(ns.brownian_survival(1.0, t)) for t in TIMES])
    assert np.all(np.abs(found["probability"] - exact) <= found["probability_error"] + 1e-15)
    assert np.all(np.abs(found["survival"] - survival) <= found["survival_error"] + 1e-15)
    assert np.all(found["probability_error"] <= 1e-8)
    # the last survival probability is 1e-16: its error is relative
    assert survival[-1] < 1e-15
    assert found["survival"][-1] == pytest.approx(survival[-1], rel=1e-4)


def test_errors_are_differences_of_levels():
    """Refinement stops when two levels agree; a small tolerance skips the first one."""
    found = refined(Known(FRICTION, -1.0, 1.0, (0.0, 1e-5, 1e-7, 1.1e-7)), TIMES[1:4], 1e-6)
    assert np.all(found["probability_error"] < 1e-6)
    with pytest.raises(ToleranceError, match="do something else"):
        refined(Known(FRICTION, -1.0, 1.0, (0.0, 1e-3, 1e-4)), TIMES[1:4], 1e-6)
