"""Refinement of one part at a time, on solutions whose errors are known."""

from dataclasses import replace

import numpy as np
import pytest

from nonsmooth.crossing.first_passage import tuning
from nonsmooth.crossing.first_passage.each_part import refine_each_part
from nonsmooth.crossing.first_passage.problem import Part
from nonsmooth.errors import ToleranceError
from nonsmooth.kinetic.ordinates_plane import UnstableError

PARTS = (Part(0, 12, 1), Part(0, 12, 1), Part(1, 12, -1))


def solution(errors):
    """Zero, but for the errors of the three parts at their resolutions."""
    return lambda at, count: np.array(
        [[sum(error(n) for error, n in zip(errors, at, strict=True))], [0.0]]
    )


class TestRefineEachPart:
    """The error is the sum of what each part changes."""

    @pytest.mark.parametrize("tol", [1e-2, 1e-4, 1e-6])
    def test_holds_if_errors_halve(self, tol):
        """A part changes by half of its error then, and what is left after adding it is as much."""
        errors = [lambda n: 0.5**n, lambda n: -(3.0**-n), lambda n: 0.2**n]
        found = refine_each_part(
            PARTS, solution(errors), lambda found: np.all(found.change <= tol), tol
        )
        assert abs(found.value[0, 0]) <= found.change[0, 0]

    def test_sees_the_part_that_others_leave_coarse(self):
        """Two parts that are exact do not hide the third, whose error is refined alone."""
        asked = []

        def solve(at, count):
            asked.append(at)
            return solution([lambda n: 0.1**n, lambda n: 0.0, lambda n: 0.0])(at, count)

        found = refine_each_part(PARTS, solve, lambda found: found.change.max() <= 1e-3, 1e-3)
        assert found.change.max() <= 1e-3
        assert {at[1] for at in asked} == {0, 1}  # never refined, only looked at
        assert len(asked) == len(set(asked))

    @pytest.mark.parametrize(("size", "once"), [(1e-3, True), (1e-2, False)])
    def test_what_hardly_counts_is_measured_once(self, size, once):
        """A change below a fifth of the tolerance goes on to count while the others are refined."""
        asked, tol = set(), 1e-2

        def solve(at, count):
            asked.add(at)
            return solution([lambda n: 0.2**n, lambda n: size * 0.5**n])(at, count)

        parts = Part(0, 9, 1), Part(0, 9, 1)
        found = refine_each_part(parts, solve, lambda found: found.change.max() <= tol, tol)
        assert (len([at for at in asked if at[1] > 0]) == 1) == once
        assert abs(found.value[0, 0]) <= found.change[0, 0]

    def test_what_another_part_hides_is_found(self):
        """A grid that changes nothing while steps are long, and much when they are short."""

        def solve(at, count):
            return np.array([[0.2 ** at[0] + 0.5 * (1 - 0.2 ** at[0]) * 0.4 ** (at[1] + 1)], [0.0]])

        tol = 1e-2
        parts = Part(0, 9, 1, beyond=1 / 3), Part(0, 9, 1)
        found = refine_each_part(parts, solve, lambda found: found.change.max() <= tol, tol)
        assert abs(found.value[0, 0]) <= found.change[0, 0] <= tol

    @pytest.mark.parametrize(("product", "coarser"), [(0.0, 2), (100.0, 1)])
    def test_others_stay_coarse_where_changes_add_up(self, product, coarser):
        """The finest of one part is asked with the other before refining, or at the same level."""
        asked = set()

        def solve(at, count):
            asked.add(at)
            errors = 0.2 ** np.array(at)
            return np.array([[errors.sum() + product * errors.prod()], [0.0]])

        parts, tol = (Part(1, 9, 1), Part(1, 9, 1)), 1e-2
        found = refine_each_part(parts, solve, lambda found: found.change.max() <= tol, tol)
        assert abs(found.value[0, 0]) <= found.change[0, 0] <= tol
        finest = max(at[0] for at in asked)
        assert finest - max(at[1] for at in asked if at[0] == finest) == coarser

    def test_late_times_that_are_met_are_left_out(self):
        """They keep what was found for them; finer resolutions are asked for the others."""
        asked, tol = {}, 1e-3

        def solve(at, count):
            asked[at[0]] = count
            return np.outer([0.2 ** at[0], 0.0], [1.0, 1e-6])[:, :count]

        def met(found):
            return found.change.max(axis=0) <= tol

        found = refine_each_part((Part(0, 9, 1),), solve, met, tol)
        assert np.all(np.abs(found.value) <= found.change)
        assert met(found).all()
        assert asked.pop(0) is asked.pop(1) is None
        assert set(asked.values()) == {1}

    @pytest.mark.parametrize("irregular", [0.0, 0.3, -0.3])
    def test_extrapolates_a_known_order(self, irregular):
        """Errors of order 2 cancel; what is left of order 3 is below what is stated."""

        def solve(at, count):
            return np.array([[0.25 ** at[0] + irregular * 0.125 ** at[0]], [0.0]])

        part = Part(1, 9, 1, falls=0.1, beyond=1 / 3)
        found = refine_each_part((part,), solve, lambda found: found.change.max() <= 1e-4, 1e-4)
        assert abs(found.value[0, 0]) <= found.change.max() <= 1e-4
        if not irregular:
            assert abs(found.value[0, 0]) < 1e-15

    @pytest.mark.parametrize(("tol", "finest"), [(2e-2, 2), (1e-3, 3)])
    def test_extrapolations_that_agree_twice_are_believed(self, tol, finest):
        """At first a tenth of the last change counts, then half of what extrapolation changed."""
        solved = []

        def solve(at, count):
            solved.append(at[0])
            return np.array([[0.25 ** at[0] + 0.01 * 0.125 ** at[0]], [0.0]])

        part = Part(1, 9, 1, falls=0.1, beyond=1 / 3)
        found = refine_each_part((part,), solve, lambda found: found.change.max() <= tol, tol)
        assert max(solved) == finest
        assert abs(found.value[0, 0]) <= found.change.max() <= tol
        tenth = 0.1 * 3 * 0.25**finest
        assert (tenth > tol) == (finest == 3), "a tenth of the last change would not do"

    def test_a_change_counts_a_tenth_of_the_one_before(self):
        """An error that changes its sign and seems to vanish is not taken to be zero."""
        values = [0.0, 1e-2, 1e-2, 1e-2]
        found = refine_each_part(
            (Part(0, 2, 1),),
            lambda at, count: np.array([[values[at[0]]], [0.0]]),
            lambda found: found.change.max() <= 1e-4,
            1e-4,
        )
        assert found.change.max() == pytest.approx(1e-4)

    def test_ends_at_the_finest(self):
        """What is not met comes back with its error; changes that do not fall count ten times."""

        def solve(at, count):
            return np.array([[(-1.0) ** at[0]], [0.0]])

        found = refine_each_part((Part(2, 2, 1),), solve, lambda found: False, 0.1)
        assert found.change.max() == pytest.approx(20.0)

    def test_three_resolutions_must_agree(self):
        """Where the second and the third agree by chance, the first one tells."""
        values = [0.0, 1e-2, 1e-2, 1.2e-2]
        found = refine_each_part(
            (Part(1, 2, 1, falls=0.3),),
            lambda at, count: np.array([[values[at[0]]], [0.0]]),
            lambda found: True,
            1e-2,
        )
        assert found.change.max() == pytest.approx(3e-3)

    @pytest.mark.parametrize("most", [1, 2, 3])
    def test_ends_where_another_method_may_take_less(self, most):
        """Errors are measured so many times, and what is known comes back with its own."""
        asked = []

        def solve(at, count):
            asked.append(at[0])
            return np.array([[0.1 ** at[0]], [0.0]])

        found = refine_each_part(
            (Part(0, 12, 1),), solve, lambda found: found.change.max() <= 1e-9, 1e-9, most
        )
        assert max(asked) == most  # the change to the next one is the error
        assert abs(found.value[0, 0]) <= found.change[0, 0]

    @pytest.mark.parametrize(("tol", "coarsest"), [(1e-2, 0), (1e-4, 1)])
    def test_a_loose_tolerance_begins_coarser(self, tol, coarsest):
        """Nothing below the resolution before it is solved."""
        asked = []

        def solve(at, count):
            asked.append(at[0])
            return np.zeros((2, 1))

        refine_each_part((Part(2, 4, 1, coarser=True),), solve, lambda found: True, tol)
        assert min(asked) == coarsest

    def test_what_no_longer_helps_is_left_out(self):
        """Where changes grow, the best result comes back, with what the next one differs by."""
        values = [0.0, 1e-2, 5e-2]

        def solve(at, count):
            if at[0] == len(values):
                raise UnstableError("too fine")
            return np.array([[values[at[0]]], [0.0]])

        for last in (1, 2):
            found = refine_each_part((Part(0, last, 1),), solve, lambda found: False, 1e-4)
            assert found.value.max() == 1e-2
            assert found.change.max() == pytest.approx(5e-2)
        with pytest.raises(UnstableError, match="too fine"):
            refine_each_part((Part(2, 3, 1),), solve, lambda found: False, 1e-4)

    def test_a_grid_that_is_too_coarse_to_be_stable(self):
        """The next one is tried; where the coarser one of the first comparison is, as well."""

        def solve(at, count):
            if at[0] < 2:
                raise UnstableError("too coarse")
            return np.array([[0.1 ** at[0]], [0.0]])

        for first in (2, 3):
            found = refine_each_part((Part(first, 5, 1),), solve, lambda found: True, 1e-2)
            assert found.value[0, 0] == pytest.approx(1e-4)
        with pytest.raises(UnstableError, match="too coarse"):
            refine_each_part((Part(1, 5, 1),), solve, lambda found: True, 1e-2)

    @pytest.mark.parametrize(
        "failure",
        [np.linalg.LinAlgError("not of full rank"), MemoryError(), ToleranceError("the factors")],
    )
    def test_what_is_known_outlives_a_grid_that_fails(self, failure):
        """A first comparison has a value and an error; without it there is none."""

        def solve(at, count):
            if at[0] == 4:
                raise failure
            return np.array([[2.0 ** -at[0]], [0.0]])

        found = refine_each_part((Part(2, 9, 1),), solve, lambda found: False, 1e-2)
        assert found.value[0, 0] == pytest.approx(2.0**-3)
        assert found.change[0, 0] >= 2.0**-3
        with pytest.raises(ToleranceError, match=r"full rank|memory|factors"):
            refine_each_part((Part(3, 9, 1),), solve, lambda found: False, 1e-2)

    @pytest.mark.parametrize(("rate", "asked"), [(0.9, 3), (0.5, 5)])
    def test_ends_without_hope(self, rate, asked):
        """At 0.9 a resolution, five leave more than ten times a thousandth; at 0.5 they do not."""
        seen = set()

        def solve(at, count):
            seen.add(at)
            return np.array([[rate ** at[0]], [0.0]])

        refine_each_part((Part(1, 6, 1),), solve, lambda found: len(seen) > 4, 1e-3)
        assert len(seen) == asked

    @pytest.mark.parametrize(("patience", "met"), [(0, False), (1, True)])
    def test_an_error_may_grow_once(self, patience, met, monkeypatch):
        """Resolutions that see a layer for the first time change more than those before."""
        monkeypatch.setattr(tuning, "EACH_PART", replace(tuning.EACH_PART, patience=patience))
        values, tol = [0.0, 1e-5, 3e-5, 10e-5, 10.3e-5, 10.35e-5], 1e-5

        def solve(at, count):
            return np.array([[values[at[0]]], [0.0]])

        parts = (Part(1, 4, 1),)
        found = refine_each_part(parts, solve, lambda found: found.change.max() <= tol, tol)
        assert (found.change[0, 0] <= tol) == met
        if met:
            assert abs(found.value[0, 0] - values[-1]) <= found.change[0, 0]

    def test_all_that_was_worse_is_an_error(self):
        """The best result has what any later one differs from it by, not only the last."""
        values = [0.0, 2e-5, 3e-5, 20e-5, 4e-5, 20e-5]

        def solve(at, count):
            return np.array([[values[at[0]]], [0.0]])

        found = refine_each_part((Part(1, 4, 1),), solve, lambda found: False, 1e-5)
        assert found.value[0, 0] == pytest.approx(3e-5)
        assert found.change[0, 0] >= 17e-5

    @pytest.mark.parametrize(("over", "finest"), [(2.8, 3), (3.2, 2)])
    def test_what_is_close_goes_on(self, over, finest):
        """It does if the first error is less than three times the tolerance."""
        asked = []

        def solve(at, count):
            asked.append(at[0])
            return np.array([[0.2 ** at[0]], [0.0]])

        tol = (0.2 - 0.04) / over
        refine_each_part((Part(1, 9, 1),), solve, lambda found: max(asked) > 2, tol, 1)
        assert max(asked) == finest
