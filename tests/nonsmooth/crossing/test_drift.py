"""The corrected formula of order 1 for a g of nonzero mean."""

import numpy as np
import pytest
from scipy.special import log_ndtr, ndtr

import nonsmooth as ns
from nonsmooth.boundary_layer.constants import LayerConstants
from nonsmooth.crossing.expansion import Expansion
from nonsmooth.errors import SceneError

TIMES = np.array([0.3, 1.0, 3.0, 10.0, 100.0])


def drifting(mean, **others):
    """Return dry friction whose velocity is observed with a mean, as at an incline."""
    return ns.Scene("friction", observable=f"y + ({mean})", **others)


@pytest.mark.parametrize("mean", [-1.3, -0.1, 1e-6, 0.1, 1.3])
def test_without_a_layer_it_is_that_of_bachelier_and_levy(mean):
    """One level, by the normal distribution function."""
    D, level = 0.7, 2.0
    constants = LayerConstants(D, (0.0, 0.0), 0.0, mean=mean)
    for side in (1, -1):
        ends = (-np.inf, level) if side > 0 else (-level, np.inf)
        towards, root = side * mean, np.sqrt(2 * D * TIMES)
        exact = ndtr((towards * TIMES - level) / root) + np.exp(
            towards * level / D + log_ndtr(-(towards * TIMES + level) / root)
        )
        assert Expansion(constants, *ends).first(TIMES) == pytest.approx(exact, rel=1e-9)


def test_skewness_moves_the_exponent_of_a_rare_level():
    """One level is ever passed with the probability exp(-q a), Lambda(q) = 0, to order C."""
    D, m, level = 0.5, -0.05, 20.0
    plain = np.exp(m / D * level)
    for C in (1e-4, -1e-4):
        constants = LayerConstants(D, (0.0, 0.0), 0.0, skewness=C, mean=m)
        ever = Expansion(constants, -np.inf, level).first(np.array([1e6]))[0]
        # q = -m/D - C m^2/D^3: Lambda at the first term is -C (m/D)^3, its slope there is -m
        assert ever / plain - 1 == pytest.approx(level * C * m**2 / D**3, rel=1e-2)


def test_a_vanishing_drift_is_none():
    """The formula is continuous at E g = 0."""
    one, two = (
        ns.crossing_probability(scene, (-0.4, 0.6), [0.5, 2.0], 100.0, method="corrected")
        for scene in (drifting("1e-7"), drifting("0"))
    )
    # W changes by at most p T m times the density of int g at the threshold, which is below 1
    assert np.all(np.abs(one.probability - two.probability) < 200 * 1e-7)


@pytest.mark.slow
class TestAgainstTheSolver:
    """The deterministic method."""

    def errors(self, scene, threshold, p, horizons):
        """Distances, which are no larger than stated."""
        found, exact = (
            ns.crossing_probability(scene, threshold, horizons, p, method=method, tol=tol)
            for method, tol in (("corrected", None), ("deterministic", 1e-6))
        )
        distance = np.abs(found.probability - exact.probability).values
        assert np.all(distance <= found.probability_error + exact.probability_error)
        return distance

    @pytest.mark.parametrize("threshold", [(-np.inf, 0.6), (-0.4, 0.6)], ids=["one", "two"])
    def test_order(self, threshold):
        """Errors fall like 1/p if the drift is such that it matters at every p."""
        first, last = (
            self.errors(drifting(0.2 / np.sqrt(p)), threshold, p, [1.0, 2.0, 4.0]).max()
            for p in (200.0, 2000.0)
        )
        assert np.log10(last / first) == pytest.approx(-1, abs=0.2)

    @pytest.mark.parametrize(
        ("scene", "threshold"),
        [
            (drifting(-0.05), (-np.inf, 1.0)),
            (drifting(0.1), 1.0),
            (ns.Scene("friction", n=3, observable="tanh(y) + 0.3*cos(y)"), (-0.7, 1.5)),
            (drifting(0.02, start={"y": 1.0}), (-np.inf, 1.0)),
        ],
        ids=["away", "towards", "skewed", "started"],
    )
    def test_errors_hold(self, scene, threshold):
        """Also where a drift away from the threshold makes crossings rare."""
        for p in (10.0, 100.0):
            self.errors(scene, threshold, p, [0.5, 2.0, 5.0])


def test_too_large_a_drift():
    """The formula says nothing, and its error says so."""
    found = ns.crossing_probability(drifting(1.0), 3.0, [1.0], 1e4, method="corrected")
    assert found.probability_error.item() == 1


def test_higher_orders_need_a_centred_g():
    """One line with the mean."""
    with pytest.raises(SceneError, match=r"of order 2 needs E g = 0, .* the mean 0.5; use order=1"):
        ns.crossing_probability(drifting(0.5), 1.0, [1.0], method="corrected", order=2)
