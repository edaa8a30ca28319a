"""Grids of times: their steps."""

import numpy as np
import pytest

from nonsmooth.errors import ToleranceError
from nonsmooth.paths.time_grids import equal_steps, logarithmic


def test_steps_divide_the_spans():
    """No step is longer than asked, and the early ones resolve the first time."""
    times = logarithmic(0.02, 10, 60)
    assert times[0] == 0.02
    assert times[-1] == 10
    assert np.all(np.diff(times) > 0)
    assert np.allclose(times / 0.002, np.rint(times / 0.002))
    grid = equal_steps(times, 0.01)
    ends = np.cumsum([count * step for count, step in grid])
    assert np.allclose(ends, times, rtol=1e-10)
    assert max(step for _, step in grid) <= 0.01 * (1 + 1e-9)
    assert grid[0] == (16, 0.02 / 16)


def test_a_step_of_no_length_is_refused():
    """Schemes allow none where the force has a pole at the start."""
    with pytest.raises(ToleranceError, match="more than can be simulated"):
        equal_steps([1.0], 0.0)
