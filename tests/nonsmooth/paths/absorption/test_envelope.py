"""The noise of steps under an envelope."""

import numpy as np
import pytest

from nonsmooth.errors import ExpressionError, SceneError
from nonsmooth.paths.absorption.envelope import scales


def test_variance_of_each_step():
    """The mean square of sin over a step, in closed form; Gauss points are exact to 1e-10 here."""
    found = scales("abs(sin(t))", 1.0, 0.25, 6)
    edges = 1 + 0.25 * np.arange(7)
    exact = np.diff(edges / 2 - np.sin(2 * edges) / 4) / 0.25
    assert np.allclose(found**2, exact, rtol=1e-9)


def test_envelopes_may_jump_and_vary():
    """A jump within a step, and three periods in one, are no pulses: means differ by less."""
    for envelope in ("1 + sign(t - 0.53)", "abs(sin(200*t))", "sqrt(t)", "exp(-t)"):
        assert np.all(scales(envelope, 0.0, 0.1, 10) >= 0)
    for jump in (0.93, 0.53, 0.98):
        assert scales(f"1 + sign(t - {jump})", 0.0, 0.05, 20)[-1] > 0
        assert scales(f"1 + sign(t - {jump})", jump - 0.03, 0.05, 2)[-1] == pytest.approx(2)


def test_constant():
    """A formula without t is a constant factor."""
    assert np.allclose(scales("0.5", 0.0, 0.1, 3), 0.5)


def test_refusals():
    """What is negative, infinite or no formula of t."""
    with pytest.raises(SceneError, match="envelope = '1 - t' is -0"):
        scales("1 - t", 0.0, 0.1, 20)
    with pytest.raises(SceneError, match="give a formula that is moderate"):
        scales("exp(1e3*t)", 0.0, 0.1, 5)  # its square overflows
    for unresolved in ("t**(-0.6)", "1/abs(t - 0.5)", "exp(-1e8*(t - 0.4513)**2)"):
        with pytest.raises(SceneError, match="has a pole, or a pulse"):
            scales(unresolved, 0.0, 0.1, 10)
    with pytest.raises(ExpressionError):
        scales("x", 0.0, 0.1, 20)
