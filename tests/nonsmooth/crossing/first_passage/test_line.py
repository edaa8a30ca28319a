"""First passage of one variable by Case's elementary solutions and inverted transforms."""

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.interpolate import CubicSpline

import nonsmooth as ns
from nonsmooth.crossing.first_passage.line import Intervals, LineProblem
from nonsmooth.errors import AssumptionWarning
from nonsmooth.kinetic.case_modes import modes
from nonsmooth.kinetic.ordinates_line import ordinates
from references import FRICTION, KAPPA, MIRRORED, SKEWED, W

DIGITS = 1e-7  # a unit in the last of seven


def exact(threshold, horizons, p, scene=FRICTION, tol=1e-7):
    """Values of the deterministic method."""
    return ns.crossing_probability(scene, threshold, horizons, p, method="deterministic", tol=tol)


def by_trapezoids(scene, threshold, time, least=1e-12):
    """Invert the Laplace transform on a vertical line, on which nothing grows.

    The error is below 1e-9: exp(-24) of periods, rounding of 1e-12 times exp(8) F(8/t), terms below
    1e-12 of the largest, which is of order 20, unless more of them are left out.
    """
    grid = ordinates(scene, 9, time, 12.0, 40.0, distances=(threshold, threshold))
    step = 2 * np.pi / (3 * time)
    z, terms = 8 / time + 1j * step / 2, []
    while not terms or abs(terms[-1]) > least * abs(terms[0]):
        passage = modes(grid, z).first_passage(-threshold, threshold)
        terms.append(np.exp(z * time) * passage / z)
        z += 1j * step
    return step / np.pi * np.sum(terms).real


@pytest.mark.slow
class TestDeterministic:
    """First passage against published values, Monte Carlo, and itself in the tails."""

    @pytest.mark.parametrize(("p", "value"), W.items())
    def test_published_values(self, p, value):
        """Values of an early prototype on another grid, with seven digits."""
        found = exact(0.6, [2.0], p)
        assert abs(found.probability[0] - value) < found.probability_error[0] + DIGITS

    def test_monte_carlo_of_one_sided_and_unequal_thresholds(self):
        """Two comparisons within 4.5 standard errors and the step's bias: false alarms 1e-5."""
        for threshold in ((-np.inf, 0.6), (-0.3, 0.6)):
            sample = ns.crossing_probability(
                FRICTION, threshold, [2.0], 1, paths=40_000, step=0.02, seed=5
            )
            bias = np.abs(sample.step_bias) + sample.step_bias_error
            gap = np.abs(sample.probability - exact(threshold, [2.0], 1).probability)
            assert gap[0] < 4.5 * sample.standard_error[0] + bias[0]

    @pytest.mark.parametrize("threshold", [(-np.inf, 0.6), (-0.3, 0.6)])
    def test_monte_carlo_without_symmetry(self, threshold):
        """The same for a g that is not odd; false alarms 1e-5."""
        sample = ns.crossing_probability(SKEWED, threshold, [2.0], 1, paths=40_000, step=0.02)
        bias = np.abs(sample.step_bias) + sample.step_bias_error
        gap = np.abs(sample.probability - exact(threshold, [2.0], 1, SKEWED).probability)
        assert gap[0] < 4.5 * sample.standard_error[0] + bias[0]

    def test_the_whole_grid_agrees_with_the_half(self, monkeypatch):
        """For odd g and any thresholds both grids agree within their stated errors."""
        thresholds = 0.6, (-0.3, 0.6)
        halves = [exact(threshold, [2.0], 1) for threshold in thresholds]
        monkeypatch.setattr(ns.Scene, "is_odd", lambda scene: False)
        for threshold, half in zip(thresholds, halves, strict=True):
            whole = exact(threshold, [2.0], 1)
            gap = np.abs(whole.probability - half.probability)
            assert np.all(gap <= whole.probability_error + half.probability_error)

    def test_rounding_of_the_half_grid_is_stated(self, monkeypatch):
        """At late times the half grid loses digits that the whole one keeps; its error says so."""
        halves = exact((-6.0, 7.0), [40.0, 400.0], 1)
        monkeypatch.setattr(ns.Scene, "is_odd", lambda scene: False)
        wholes = exact((-6.0, 7.0), [40.0, 400.0], 1)
        gap = np.abs(wholes.probability - halves.probability)
        assert np.all(gap <= wholes.probability_error + halves.probability_error)

    def test_soon_after_the_rise_without_symmetry(self):
        """Poles off the axis still count."""
        scene = ns.Scene("friction", observable="y + 0.5*sin(y)**2 - 0.0718281158505784")
        found = exact(0.6, [0.5, 1.15, 23.0], 1, scene)
        gap = abs(found.probability[1] - by_trapezoids(scene, 0.6, 1.15))
        assert gap <= found.probability_error[1] + 1e-9

    def test_many_paths_arrive_together(self):
        """Many paths stay near y = 0.5, where g is flat, until they arrive; few come before."""
        scene = ns.Scene("friction", n=100, observable="y + 0.56*cos(2*y)")
        found = exact(0.6, [0.5, 0.703, 20.0], 1, scene, tol=1e-4)
        gap = abs(found.probability[1] - by_trapezoids(scene, 0.6, 0.703, 1e-8))
        # what is left out, times exp(8) F(8/t)
        assert gap <= found.probability_error[1] + 1e-8

    def test_a_rounded_transform_is_not_0(self):
        """On a line for the early times a coarse grid has no digit of F, which is 1e-15 there."""
        asked = 0.6, [0.301, 0.502, 0.703, 20.0], 1, ns.Scene("friction", n=np.inf)
        early, usual = (exact(*asked, tol=tol) for tol in (1e-4, 1e-7))
        gap = np.abs(early.probability - usual.probability)
        assert np.all(gap <= early.probability_error + usual.probability_error)

    def test_reflection(self):
        """-g(-y) crosses the thresholds swapped with the same probability."""
        one = exact((-0.3, 0.6), [2.0], 1, SKEWED, tol=1e-6)
        other = exact((-0.6, 0.3), [2.0], 1, MIRRORED, tol=1e-6)
        gap = np.abs(one.probability - other.probability)
        assert np.all(gap <= one.probability_error + other.probability_error)

    def test_two_zeros_of_g(self):
        """Monte Carlo agrees for a g that is positive in both tails; false alarms 1e-5."""
        with pytest.warns(AssumptionWarning):
            scene = ns.Scene("friction", observable="y + y**2 - 0.1805319960014103")
        sample = ns.crossing_probability(scene, 0.6, [2.0], 1, paths=20_000, step=0.02)
        bias = np.abs(sample.step_bias) + sample.step_bias_error
        found = exact(0.6, [2.0], 1, scene, tol=1e-4)
        gap = np.abs(sample.probability - found.probability)
        assert gap[0] < 4.5 * sample.standard_error[0] + bias[0] + 1e-4

    @pytest.mark.parametrize(("p", "tol"), [(1e4, 1e-7), (1e6, 1e-6)])
    def test_late_times_of_one_wall(self, p, tol):
        """The slow mode is 1e4 times the others; W is that of first order but for O(1/p)."""
        found = exact((-np.inf, 0.6), [100.0], p, tol=tol)
        formula = ns.crossing_probability(
            FRICTION, (-np.inf, 0.6), [100.0], p, method="corrected"
        ).probability
        # (kappa / b)^2 / p and the stated error
        bound = (KAPPA / 0.6) ** 2 / p + found.probability_error[0]
        assert abs(found.probability[0] - formula[0]) < bound
        assert found.probability_error[0] <= tol

    def test_g_that_vanishes_on_a_half_line(self):
        """Int g only increases, with 2 y while y > 0; Monte Carlo agrees; false alarms 1e-5."""
        scene = ns.Scene("friction", observable="y + abs(y)")
        found = exact(0.6, [1.0], 1, scene)
        sample = ns.crossing_probability(scene, 0.6, [1.0], 1, paths=20_000, step=0.02)
        bias = np.abs(sample.step_bias) + sample.step_bias_error
        gap = np.abs(sample.probability - found.probability)
        assert gap[0] < 4.5 * sample.standard_error[0] + bias[0]

    def test_survival_decays_like_its_leading_pole(self):
        """Late 1 - W falls by equal factors in equal times, far below the rounding of W."""
        survival = exact(0.6, [60.0, 80.0, 100.0], 1000).survival.values
        assert survival[-1] < 1e-13
        assert survival[2] / survival[1] == pytest.approx(survival[1] / survival[0], rel=1e-3)

    def test_rare_crossings_are_bounded_or_resolved(self):
        """Below 1e-14 the bound is the error; above, the error is relative."""
        found = exact(0.6, [1e-3, 0.05, 0.1], 1e4)
        assert found.probability[0] == 0
        assert found.probability_error[0] >= 1e-14
        assert np.all(np.diff(found.probability) > 0)
        assert found.probability_error[1] < 1e-3 * found.probability[1] < 1e-10

    def test_a_crossing_that_is_out_of_reach(self):
        """W is 0 and its error below 1e-13 where the transform is below rounding."""
        found = exact(10.0, [0.005, 0.01], 0.01)
        assert np.all(found.probability == 0)
        assert np.all(found.probability_error <= 1e-13)
        assert np.all(found.survival == 1)

    @pytest.mark.parametrize(("threshold", "p"), [(0.05, 1), (0.6, 0.01), (3.0, 30)])
    def test_a_curve_over_four_decades(self, threshold, p):
        """A distribution that rises from nothing, within the error asked for."""
        found = exact(threshold, np.geomspace(0.01, 100, 20), p)
        errors = found.probability_error.values
        assert np.all(np.diff(found.probability) >= -errors[1:] - errors[:-1])
        assert np.all(found.probability_error <= 1e-7)
        assert found.probability[0] < 1e-8
        assert found.probability[-1] > 0.5

    def test_transform_of_the_rise(self):
        """The values have the transform at 2 that comes from a finer grid, on the axis.

        A cubic spline of log P through 28 points per decade leaves less than 1e-5.
        """
        times = np.geomspace(0.3, 40.0, 60)
        found = exact(0.6, times, 1).probability.values
        seen = found > 0
        spline = CubicSpline(np.log(times[seen]), np.log(found[seen]))
        fine = np.geomspace(times[seen][0], times[-1], 20_001)
        transform = simpson(2 * np.exp(-2 * fine + spline(np.log(fine))), x=fine)
        expected = modes(ordinates(FRICTION, 13, 0.1), 2.0).first_passage(-0.6, 0.6).real
        assert transform == pytest.approx(expected, rel=1e-5)

    @pytest.mark.parametrize(
        ("scene", "threshold"),
        [
            (
                ns.Scene(
                    "friction",
                    n=1,
                    damping=0.257,
                    noise=ns.White(1.91),
                    observable="tanh(y)",
                    start={"y": 0.973},
                ),
                (-0.6, 0.8),
            ),
            (ns.Scene("friction", observable="friction_force"), 0.6),
            (ns.Scene("friction", n=np.inf, observable="max(abs(y) - 0.5, 0)*sign(y)"), 0.2),
        ],
    )
    def test_fronts_and_flat_parts(self, scene, threshold):
        """A bounded g reaches the threshold at a time all at once; a flat one stands still.

        Monte Carlo agrees; false alarms 1e-5.
        """
        horizons = [0.7, 1.0, 2.0]
        sample = ns.crossing_probability(scene, threshold, horizons, 1, paths=20_000, step=0.02)
        found = exact(threshold, horizons, 1, scene, tol=1e-5)
        bias = np.abs(sample.step_bias) + 3 * sample.step_bias_error
        gap = np.abs(sample.probability - found.probability)
        assert np.all(gap < 4.5 * sample.standard_error + bias)


@pytest.mark.slow
def test_what_a_basis_is_off_counts(monkeypatch):
    """It is an error of W at late times, by about as much."""
    off = 1e-5

    def stated(inexact):
        def in_basis(self, parts, of_grid, abscissa, accuracy):
            return parts, inexact

        monkeypatch.setattr(LineProblem, "parts_on_line", in_basis)
        return exact((-0.6, 0.8), [0.2, 5.0], 10.0, SKEWED, 1e-3)

    usual, told = stated(0.0), stated(off)
    np.testing.assert_array_equal(told.probability, usual.probability)
    more = (told.probability_error - usual.probability_error).values
    # F is at most 1 on the axis, and exp(s t) is exp(1) at the last time
    assert off < more[-1] <= 3 * np.e * off


@pytest.mark.parametrize(
    ("scene", "levels", "degree"),
    [(FRICTION, (-0.6, 0.8), 11), (SKEWED, (-np.inf, 0.8), 11), (SKEWED, (-0.6, 0.8), 2)],
    ids=["half a grid", "one wall", "few nodes"],
)
def test_some_grids_are_in_no_basis(scene, levels, degree):
    """Then the parts of F are those of the grid."""
    (problem,) = Intervals(scene, [levels]).problems
    of_grid = degree, np.array([1.0, 50.0]), 0.0
    parts, _ = problem.parts(*of_grid)
    assert problem.parts_on_line(parts, of_grid, 0.02, 1e-8) == (parts, 0.0)


def test_early_crossings_are_those_of_integrated_brownian_motion():
    """Int g scales like t^(3/2) while damping is negligible, here at 1e-8 and at 1e-14."""
    early, earlier = (
        exact(b, [b ** (2 / 3), 3 * b ** (2 / 3)], 1.0, tol=1e-5) for b in (1e-12, 1e-20)
    )
    allowed = early.probability_error + earlier.probability_error + 1e-7  # damping: of order T
    assert np.all(np.abs(early.probability - earlier.probability).values < allowed.values)
    assert 0.05 < early.probability[0] < 0.1 < 0.7 < early.probability[1]
