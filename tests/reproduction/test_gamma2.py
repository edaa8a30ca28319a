"""gamma^2 by two methods: their deviation, and that a contradiction stops the workflow."""

import pytest

from nonsmooth.scenes.scene import Scene
from reproduction.errors import CheckError
from reproduction.gamma2 import compared

SOLVED = {"gamma2": 0.5, "gamma2_error": 1e-6}


def sampled(gamma2, bias=0.01):
    """Monte Carlo with a standard error of 0.005, of which the bias has its share."""
    return {"gamma2": gamma2, "gamma2_error": 0.004, "bias": bias, "bias_error": 0.003}


def test_deviation_is_that_less_the_bias():
    """It is given in standard errors of both methods together."""
    plain, cells = compared("friction", Scene("friction"), SOLVED, sampled(0.52))
    assert plain["deviation"] == pytest.approx(2)
    assert plain["monte_carlo_corrected"] == pytest.approx(0.51)
    assert cells["Monte Carlo"] == r"$0.5100 \pm 0.0050$"
    assert cells[r"$\gamma^2$"] == "0.500000"


@pytest.mark.parametrize("value", [0.536, 0.484, float("nan")])
def test_contradictions_fail(value):
    """Five standard errors on either side of 0.51, and what is not a number."""
    with pytest.raises(CheckError, match=r"gamma\^2 of friction is 0.5"):
        compared("friction", Scene("friction"), SOLVED, sampled(value))
