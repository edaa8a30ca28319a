"""Constants of the boundary layer by whatever method the scene allows."""

import pytest

import nonsmooth as ns
from nonsmooth.boundary_layer import milne
from nonsmooth.errors import ToleranceError
from nonsmooth.estimate import Estimate


def test_formulas_inherit_the_error_of_a_sampled_length(monkeypatch):
    """A length with a large error is a large error of what follows, unless one was asked for."""
    rough = Estimate(-0.6, 0.7, "Monte Carlo", 1.0)

    def sampled(*asked):
        raise ToleranceError("kappa = -0.6 has an error of 0.7", rough)

    monkeypatch.setattr(milne, "sampled_kappa", sampled)
    monkeypatch.setattr(
        milne, "limit_variance", lambda *asked: Estimate(0.1, 1e-3, "Monte Carlo", 1.0)
    )
    scene = ns.Scene("elasto_plastic", "langevin", potential="x**2/2", n=31)
    constants, errors = milne.layer_constants(scene)
    assert constants.kappa == (-0.6, -0.6)
    assert errors.kappa == (0.7, 0.7)
    found = ns.crossing_probability(scene, 0.5, [2.0], 10.0, method="corrected")
    assert 0.1 < float(found["probability_error"][0]) <= 1
    with pytest.raises(ToleranceError, match=r"kappa = -0\.6"):
        milne.layer_constants(scene, tol=1e-3)
