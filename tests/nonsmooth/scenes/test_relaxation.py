"""How fast a scene relaxes from far out."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.scenes.relaxation import rate_at_infinity


def test_rate_at_infinity_of_walls():
    """Far out, walls are springs, x' = y - n x where they yield, and friction is nothing."""
    cases = {
        "elasto_plastic": [[-1.0, -1.0], [1.0, -20.0]],
        "obstacle": [[-1.0, -21.0], [1.0, 0.0]],
    }
    for model, drift in cases.items():
        scene = ns.Scene(model, n=20, potential="x**2/2", observable="x")
        exact = -2 * np.linalg.eigvals(drift).real.max()
        found = rate_at_infinity(scene)
        assert abs(found.value - exact) <= found.error < 1e-5
    with pytest.raises(SceneError, match="grow quadratically"):
        rate_at_infinity(ns.Scene("friction", ns.Langevin("eta**4/4")))


def test_what_overflows_is_not_linear():
    """A potential that is infinite far out is refused without a warning."""
    with pytest.raises(SceneError, match="grow quadratically"):
        rate_at_infinity(ns.Scene("elasto_plastic", potential="exp(x)", observable="y"))
