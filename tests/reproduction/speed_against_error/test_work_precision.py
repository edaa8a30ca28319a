"""Work-precision diagrams: what is measured, and the references against which."""

import sys

import numpy as np
import pytest
import xarray as xr

import nonsmooth as ns
from nonsmooth.errors import SceneError
from references import FRICTION, GAMMA2, GAMMA2_OBSTACLE, W
from reproduction.errors import CheckError
from reproduction.speed_against_error.pathwise import BrownianPaths
from reproduction.speed_against_error.work_precision import (
    Case,
    exponent,
    front,
    measured,
    peer,
    timed,
    unseeded,
)
from support import ROOT

DIFFERENCES = ROOT / "benchmarks" / "peers" / "differences.py"


def case(values, seconds=1.0):
    """Return a case that gives the values in turn; the first is the round that is not counted."""
    return Case("a", "b", 1.0, lambda seed: (values[seed], seconds * (seed + 1)))


class TestMeasured:
    """Median and spread of the seconds, root mean square of the error."""

    def test_of_a_random_method(self):
        """Bias 3 and chance 4 make 5; the error of it is 1/sqrt(2 rounds)."""
        data = measured("t", "s", [case([99.0, 11.0, 3.0 - 4.0 + 4.0])], 2, {"a": (4.0, 0.0)})
        assert data["error"].item() == pytest.approx(5.0)
        assert data["error_error"].item() == pytest.approx(5.0 / 2)
        assert data["seconds"].item() == 2.5
        assert (data["seconds_least"].item(), data["seconds_most"].item()) == (2.0, 3.0)
        assert data["seconds"].attrs["units"] == "s"

    def test_of_a_deterministic_method(self):
        """The doubt is the reference's alone."""
        data = measured("t", "s", [case([1.5] * 4)], 3, {"a": (1.0, 1e-3)})
        assert data["error"].item() == 0.5
        assert data["error_error"].item() == 1e-3

    def test_times_alone(self):
        """Without a reference there is no error."""
        assert "error" not in measured("t", "s", [case([1.0] * 3)], 2)

    def test_refuses_what_is_unstable(self):
        """A result that is not a number is refused with the method and its size."""
        with pytest.raises(CheckError, match="b at size 1 of a gives nan"):
            measured("t", "s", [case([1.0, np.nan, 1.0])], 2, {"a": (1.0, 0.0)})

    def test_timed(self):
        """Seeds go to random methods only."""
        assert timed(lambda a, seed: a + seed, 1)(2)[0] == 3.0
        value, seconds = timed(unseeded(lambda a: a), 1)(2)
        assert value == 1.0
        assert seconds > 0


def test_front():
    """Neither slower nor worse than another; of equals in time the better."""
    assert front(np.array([1.0, 2.0, 2.0, 3.0]), np.array([5.0, 6.0, 4.0, 4.0])) == [0, 2]


def test_exponent():
    """It is exact for a power, and has the textbook's error for what is not quite one."""
    size = np.array([1.0, 10.0, 100.0])
    assert exponent(size, 3 * size**1.5) == pytest.approx((1.5, 0.0), abs=1e-7)
    # residuals (1, -2, 1) e, so that the variance is 6 e^2 / (2 ln(10)^2)
    slope, error = exponent(size, np.exp([0.1, -0.2, 0.1]))
    assert slope == pytest.approx(0.0, abs=1e-12)
    assert error == pytest.approx(np.sqrt(6) * 0.1 / np.sqrt(2) / np.log(10))


class TestPeers:
    """Programs of their own that answer requests."""

    def test_fitted_grid_is_of_second_order(self):
        """Half the widths give a quarter of the error to within 15 %, for small and large n.

        The next term of the expansion is of the order of the error's ratio, 1/16, again.
        """
        with peer(sys.executable, DIFFERENCES) as request:
            for n in (2, 1e4):
                exact = float(ns.variance(ns.Scene("friction", n=n), [100.0], 1e-8)["v"][0]) / 100
                size = {"method": "method_of_lines", "n": n, "horizon": 100, "rtol": 1e-6}
                errors = [request(cells=c, **size)(0)[0] - exact for c in (80, 160)]
                assert errors[0] / errors[1] == pytest.approx(4, rel=0.15)

    def test_failure_is_told(self, capfd):
        """A program that fails is told with the request that failed."""
        with (
            peer(sys.executable, DIFFERENCES) as request,
            pytest.raises(CheckError, match=r"differences.py failed at {'method': 'none'}"),
        ):
            request(method="none")(0)
        assert "KeyError" in capfd.readouterr().err


class TestReferences:
    """They agree with the solvers that they judge, and do not share their discretisation."""

    @pytest.mark.parametrize("n", [2.0, 100.0, 1e4])
    def test_quadrature_of_the_long_run(self, script, n):
        """It agrees with spectral elements, whose rounding grows with n."""
        found = ns.variance(ns.Scene("friction", n=n), [100.0], 1e-8)
        value, error = (float(found[name][0]) / 100 for name in ("v", "v_error"))
        assert abs(script("pde")["long_run"](n, 100.0) - value) <= error + 1e-13

    @pytest.mark.slow
    @pytest.mark.parametrize(("p", "published"), [(1, W[1]), (1000, W[1000])])
    def test_inversion_on_a_line(self, script, p, published):
        """It agrees with the seven digits that are published."""
        value, error = script("crossing")["on_a_line"](FRICTION, 0.6, 2.0, p)
        assert error < 1e-7
        assert abs(value - published) < error + 1e-7


class TestPathwise:
    """The same path with different steps."""

    @pytest.mark.slow
    def test_coarse_increments_are_the_fine_ones(self):
        """Without friction the velocity is the Gaussian step, exact with every step."""
        paths = BrownianPaths(ns.Scene("friction", n=1e-9), 1.0, 8, 10, 1)
        for level in (1, 4, 8):
            assert paths.error(level)[0] < 1e-8  # the friction of n = 1e-9 is left

    @pytest.mark.slow
    @pytest.mark.parametrize("model", ["friction", "elasto_plastic", "obstacle"])
    def test_error_falls(self, model):
        """A sixteenth of the step: for strong order 1/2, the least of these, a quarter."""
        potential = "0" if model == "friction" else "x**2/2"
        paths = BrownianPaths(ns.Scene(model, n=100, potential=potential), 2.0, 12, 50, 2)
        assert paths.error(8)[0] < paths.error(4)[0] / 4

    def test_refuses_colored_noise(self):
        """The increments are of one variable."""
        with pytest.raises(SceneError, match="white"):
            BrownianPaths(ns.Scene("friction", "langevin"), 1.0, 4, 2, 1)


class TestScripts:
    """Each measures every method at tiny sizes."""

    @pytest.mark.slow
    def test_monte_carlo(self, script):
        """Errors of about a standard error, sqrt(2/paths) v/T, and larger biases of first order."""
        data = script("monte_carlo")["monte_carlo"](
            2, 100, [0.015625], [4_000], [0.015625], [1_000], 4, None
        )
        assert set(data["method"].values) >= {"Lie", "exact dry friction", "plain numba loop"}
        assert float(data["error"].max()) < 0.1 * 0.1

    def test_gamma2(self, script):
        """One scene of one variable and one of two."""
        scenes = {
            "friction": {"scene": {"model": "friction", "n": 100}},
            "obstacle": {"scene": {"model": "obstacle", "potential": "x**2/2", "observable": "x"}},
        }
        solved = [
            xr.Dataset({"gamma2": value, "gamma2_error": 1e-9})
            for value in (GAMMA2, GAMMA2_OBSTACLE)
        ]
        data = script("gamma2")["gamma2"](
            solved, list(scenes), scenes, [8], [[1e-2]] * 3, [2, 4, 6], 0.05, [1_000], 2
        )
        exact = data["error"].where(data["method"] == "deterministic", drop=True)
        assert float(exact[0]) < 1e-8
        assert float(exact[1]) < 1e-2

    @pytest.mark.slow
    def test_cost(self, script):
        """Ten times the paths take longer."""
        scenes = {"friction": {"scene": {"model": "friction", "n": 100}}}
        data = script("cost")["cost"](
            [1_000, 100_000],
            [1, 2],
            [1],
            [2],
            ["friction"],
            scenes,
            0.05,
            1_000,
            0.1,
            {"half_width": 10, "nodes": 401, "time_step": 0.5},
            2,
        )
        seconds = data["seconds"].where(data["panel"] == "samples", drop=True)
        assert float(seconds[2]) > float(seconds[0])
