"""Elements of mechanical sketches reach from end to end."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from reproduction.rendering import mechanics


@pytest.mark.parametrize("element", [mechanics.spring, mechanics.dashpot, mechanics.slider])
@pytest.mark.parametrize("size", [1.0, 1.35])
def test_an_element_joins_its_ends(element, size):
    """It touches both, at their height, and no part of it lies beyond them."""
    figure, axis = plt.subplots()
    element(axis, -1, 2, 0.5, size)
    points = np.concatenate([line.get_xydata() for line in axis.lines])
    for end in ([-1, 0.5], [2, 0.5]):
        assert np.isclose(points, end).all(axis=1).any()
    assert points[:, 0].min() >= -1
    assert points[:, 0].max() <= 2
    plt.close(figure)
