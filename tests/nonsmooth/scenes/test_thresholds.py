"""What a threshold may be."""

import numpy as np
import pytest

from nonsmooth.errors import SceneError
from nonsmooth.scenes.thresholds import bounds, intervals


@pytest.mark.parametrize(
    ("threshold", "levels"),
    [
        (0.6, (-0.6, 0.6)),
        (np.float32(2), (-2.0, 2.0)),
        ((-0.4, 1), (-0.4, 1.0)),
        ([-np.inf, 0.6], (-np.inf, 0.6)),
        (np.array([-0.6, np.inf]), (-0.6, np.inf)),
    ],
)
def test_numbers_and_pairs(threshold, levels):
    """A number stands for both sides; what is a pair of levels already stays."""
    assert bounds(threshold) == levels
    assert bounds(bounds(threshold)) == levels


@pytest.mark.parametrize(
    ("threshold", "cure"),
    [
        (0.0, "threshold > 0"),
        (-1.0, "threshold > 0"),
        (float("nan"), "threshold is nan"),
        ((0.0, 1.0), "lower < 0 < upper"),
        ((1.0, -1.0), "lower < 0 < upper"),
        ((-1.0, float("nan")), "not a number"),
        (float("inf"), "finite level"),
        ((-np.inf, np.inf), "finite level"),
        ((-1.0, 0.5, 1.0), "one number b > 0"),
        ("high", "give numbers"),
        (None, "threshold"),
    ],
)
def test_what_nothing_can_cross_is_refused(threshold, cure):
    """The error is one line with the cure."""
    with pytest.raises(SceneError, match=cure):
        bounds(threshold)


@pytest.mark.parametrize(
    ("threshold", "levels", "several"),
    [
        (0.6, [(-0.6, 0.6)], False),
        ([-0.5, 0.6], [(-0.5, 0.6)], False),
        (np.array([-np.inf, 0.6]), [(-np.inf, 0.6)], False),
        ([0.5, 0.6], [(-0.5, 0.5), (-0.6, 0.6)], True),
        ([0.5], [(-0.5, 0.5)], True),
        (np.array([0.1, 0.2, 0.3]), [(-0.1, 0.1), (-0.2, 0.2), (-0.3, 0.3)], True),
        ([(-0.5, np.inf), (-0.1, 0.2)], [(-0.5, np.inf), (-0.1, 0.2)], True),
        ([[-0.5, 0.6]], [(-0.5, 0.6)], True),
    ],
)
def test_one_threshold_or_several(threshold, levels, several):
    """Two numbers are one pair if the first is negative, and two thresholds otherwise."""
    found, many = intervals(threshold)
    assert list(map(tuple, found)) == levels
    assert many is several


@pytest.mark.parametrize(
    ("threshold", "cure"),
    [
        ((0.5, 0.6), "lower < 0 < upper"),
        ([0.5, -0.6], "threshold > 0"),
        ([], r"shape \(m, 2\)"),
        (np.ones((2, 3)), r"shape \(m, 2\)"),
        ([(-1.0, 1.0), (-np.inf, np.inf)], "finite level"),
        ([(-1.0, 1.0), (0.5, 1.0)], "lower < 0 < upper"),
    ],
)
def test_each_of_several_thresholds_is_examined(threshold, cure):
    """A tuple of two numbers is a pair, never two thresholds."""
    with pytest.raises(SceneError, match=cure):
        intervals(threshold)
