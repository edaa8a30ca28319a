"""What a threshold may be."""

import numpy as np
import pytest

from nonsmooth.errors import SceneError
from nonsmooth.scenes.thresholds import bounds


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
        ((-1.0, 0.5, 1.0), "a number or a pair"),
        ("high", "give numbers"),
        (None, "threshold"),
    ],
)
def test_what_nothing_can_cross_is_refused(threshold, cure):
    """The error is one line with the cure."""
    with pytest.raises(SceneError, match=cure):
        bounds(threshold)
