"""Derivatives of crossing probabilities with two state variables."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.sensitivity import plane
from nonsmooth.sensitivity.questions import Question
from references import COLORED_FRICTION, FRICTION, OBSTACLE, PLASTIC_STRAIN

LINEAR = ns.Scene("elasto_plastic", "langevin")  # y with colored noise


def test_where_it_applies():
    """Two variables that are solved, and a g that stays as it is."""
    assert plane.applies(COLORED_FRICTION, "n")
    assert plane.applies(OBSTACLE, "p")
    assert plane.applies(PLASTIC_STRAIN, "sigma")
    assert not plane.applies(PLASTIC_STRAIN, "n")
    assert not plane.applies(FRICTION, "n")


@pytest.mark.slow
def test_scaling_with_sigma():
    """In a linear scene W depends on threshold / sigma alone."""
    question = Question(LINEAR, -0.3, 0.3, np.array([0.7, 1.2]), 30.0)
    (by_sigma, error), (by_threshold, other) = (
        plane.logarithmic_derivative(question, name, 3e-2) for name in ("sigma", "threshold")
    )
    assert np.max(np.abs(by_sigma)) > 10 * np.max(error + other), "the comparison would see little"
    assert np.all(np.abs(by_sigma + by_threshold) <= error + other)
