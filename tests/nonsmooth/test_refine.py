"""The loop that refines ends where it should, and says whether the error is small enough."""

import numpy as np
import pytest

from nonsmooth.errors import ToleranceError
from nonsmooth.refine import MOST, further_terms, until_agreement


def halvings(levels, tol, hopeless=lambda value, error: False):
    """Refine 2^-level, whose error is the change by the last level."""
    return until_agreement(
        levels,
        lambda level: 2.0**-level,
        lambda solutions: solutions[-2] - solutions[-1],
        lambda value, error: error <= tol,
        hopeless,
    )


def test_ends_at_the_first_level_that_is_good_enough():
    """The change 1/2 - 1/4 is above the tolerance, 1/4 - 1/8 is at it."""
    found = halvings(range(1, 9), tol=1 / 8)
    assert (found.value, found.error, found.met) == (1 / 8, 1 / 8, True)
    assert found.solutions == (1 / 2, 1 / 4, 1 / 8)


def test_the_finest_level_is_returned_if_none_is_good_enough():
    """With its error, and the statement that it is too large."""
    found = halvings(range(1, 4), tol=1e-9)
    assert (found.value, found.error, found.met) == (1 / 8, 1 / 8, False)


def test_one_level_has_no_error():
    """So that it is never good enough."""
    found = halvings([1], tol=1.0)
    assert (found.error, found.met) == (None, False)


def test_hopeless_refinements_end_early():
    """Finer levels are not solved."""
    found = halvings(range(1, 9), tol=0.0, hopeless=lambda value, error: True)
    assert found.solutions == (1 / 2, 1 / 4)
    assert not found.met


def test_singular_equations_are_refused():
    """What libraries raise becomes one line for the user."""
    with pytest.raises(ToleranceError, match="singular in double precision"):
        until_agreement([1], lambda level: np.linalg.inv(np.zeros((2, 2))), None, None)


@pytest.mark.parametrize(
    "failure",
    [np.linalg.LinAlgError("not of full rank"), MemoryError(), ToleranceError("the factors")],
)
def test_what_is_known_outlives_a_level_that_fails(failure):
    """Two levels have a value and an error; one has none."""

    def solve(level):
        if level == 3:
            raise failure
        return 2.0**-level

    found = until_agreement(range(1, 9), solve, lambda s: s[-1], lambda value, error: False)
    assert (found.value, found.error, found.met) == (1 / 4, 1 / 4, False)
    with pytest.raises(ToleranceError, match=r"full rank|memory|factors"):
        until_agreement(range(2, 9), solve, lambda s: s[-1], lambda value, error: False)


@pytest.mark.parametrize("ratio", [0.5, 0.75, 0.9])
def test_what_follows_of_a_geometric_series(ratio):
    """The sum of all further terms is counted in units of the last one."""
    further = ratio ** np.arange(1, 500)
    assert further_terms(ratio) == pytest.approx(further.sum(), rel=1e-12)


def test_what_follows_of_other_series():
    """At least the last term is left, at most ten times it where terms hardly shrink."""
    assert np.all(further_terms([-2.0, -0.9, 0.0, 0.3]) == 1.0)
    assert np.allclose(further_terms([0.95, 1.0, 3.0, np.inf]), MOST, rtol=1e-14)
