"""Central differences are of the order 6 and state more than their error."""

import numpy as np
import pytest

from nonsmooth.central_differences import central

X = np.linspace(-1, 1, 7)


def _derivative(spacing, noise=0.0):
    rng = np.random.default_rng(1)
    steps = spacing * np.arange(1, 4)[:, None]
    below, above = (
        np.exp(np.sin(X + side * steps)) + noise * rng.uniform(-1, 1, (3, len(X)))
        for side in (-1, 1)
    )
    exact = np.cos(X) * np.exp(np.sin(X))
    value, error = central(below, above, np.full((3, len(X)), 2 * noise), spacing)
    return np.abs(value - exact), error


def test_halving_the_spacing_gains_the_order_6():
    """The slope of the error over the spacing, within half of one."""
    coarse, fine = (_derivative(spacing)[0].max() for spacing in (0.2, 0.1))
    assert np.log2(coarse / fine) == pytest.approx(6, abs=0.5)


@pytest.mark.parametrize("noise", [0.0, 1e-6, 1e-2])
def test_the_error_is_stated(noise):
    """Whether the differences or the errors of the function are the larger ones."""
    for spacing in (0.3, 0.1, 0.03):
        true, stated = _derivative(spacing, noise)
        assert np.all(true <= stated)
