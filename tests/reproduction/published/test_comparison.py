"""A run is identical with the published one, within the stated errors, or off."""

from dataclasses import replace
from statistics import NormalDist

import pytest

from reproduction.agreement import FALSE_ALARM, standard_errors
from reproduction.errors import ArtifactError
from reproduction.published.comparison import (
    DIFFERENT,
    IDENTICAL,
    MISSING,
    OFF,
    WITHIN,
    compare,
    spelled,
    state,
    statistical,
)
from reproduction.published.record import Number, Record
from reproduction.rendering.quoted import BOUND, EFFECTIVE, ERROR, INTERVAL, ROUNDING, STANDARD

Z = 5.0


def moved(number, by):
    """Return the number with its value moved."""
    return replace(number, value=number.value + by)


@pytest.mark.parametrize("kind", [BOUND, ROUNDING])
def test_bounds_add_up(kind):
    """Two values may differ by the sum of their bounds, and by no more."""
    number = Number(1.0, 0.25, kind)
    assert state(number, number, Z) == IDENTICAL
    assert state(number, moved(number, -0.5), Z) == WITHIN
    assert state(number, moved(number, 0.51), Z) == OFF


def test_standard_errors_add_up_in_squares():
    """3 and 4 make 5, of which as many are allowed as the false alarm says."""
    published, found = Number(0.0, 3.0, STANDARD), Number(0.0, 4.0, STANDARD)
    assert state(published, moved(found, Z * 5.0), Z) == WITHIN
    assert state(published, moved(found, Z * 5.01), Z) == OFF


def test_half_an_interval_is_two_standard_errors():
    """1.96 of them, at 95 %."""
    published, found = Number(0.0, 3.0, INTERVAL), Number(0.0, 4.0, INTERVAL)
    assert state(published, moved(found, Z * 5.0 / 1.961), Z) == WITHIN
    assert state(published, moved(found, Z * 5.0 / 1.95), Z) == OFF


def test_effective_sizes_are_samples_too():
    """They differ between processors and seeds; a tenth says that weights went wrong."""
    published = Number(3000.0, 0.0, EFFECTIVE)
    assert state(published, replace(published, value=5000.0), Z) == WITHIN
    assert state(published, replace(published, value=301.0), Z) == WITHIN
    assert state(published, replace(published, value=299.0), Z) == OFF


def test_what_has_no_error_must_be_equal():
    """Texts, counts and parameters; a number without an error; what is missing or new."""
    assert state("1,000", "1,000", Z) == IDENTICAL
    assert state("1,000", "1,001", Z) == OFF
    assert state(Number(1.0, 0.0, BOUND), Number(1.0 + 1e-16 + 3e-16, 0.0, BOUND), Z) == OFF
    assert state("1", None, Z) == OFF
    assert state(None, "1", Z) == OFF
    assert state("1", Number(1.0, 1.0, BOUND), Z) == OFF


def test_an_error_may_not_grow_by_an_order_of_magnitude():
    """Neither beside a value nor by itself; it may shrink. What is not a number is off."""
    assert state(Number(1.0, 0.1, BOUND), Number(1.0, 1.0, BOUND), Z) == WITHIN
    assert state(Number(1.0, 0.1, BOUND), Number(1.0, 1.1, BOUND), Z) == OFF
    assert state(Number(0.1, 0.0, ERROR), Number(0.0, 0.0, ERROR), Z) == WITHIN
    assert state(Number(0.1, 0.0, ERROR), Number(1.1, 0.0, ERROR), Z) == OFF
    assert state(Number(1.0, 0.1, BOUND), Number(float("nan"), 0.1, BOUND), Z) == OFF
    assert state(Number(1.0, 0.1, BOUND), Number(1.0, float("nan"), BOUND), Z) == OFF


def record(**artifacts):
    """Return a record with 100 statistical numbers and one bound."""
    statistical = {f"row {k}, W": Number(0.5, 0.1, STANDARD) for k in range(100)}
    return Record("1", {"table_6": statistical, "table_4": {"row 1, v": "2"}}, artifacts)


def artifact(sha256, parameters="p"):
    """Return the entry of an artifact."""
    return {"sha256": sha256, "parameters": parameters}


def test_the_false_alarm_is_shared_among_the_statistical_numbers():
    """Two-sided, and by Bonferroni."""
    assert statistical(record()) == 100
    tail = 2 * (1 - NormalDist().cdf(standard_errors(100)))
    assert 100 * tail == pytest.approx(FALSE_ALARM, rel=1e-6)


def test_other_parameters_are_refused():
    """In one line that names the first artifact's file."""
    published, found = record(a=artifact("1")), record(a=artifact("1", "other sizes"))
    with pytest.raises(ArtifactError, match=r"^results/a was made with other parameters"):
        compare(published, found)


def test_artifacts_are_identical_different_or_missing():
    """Only what is missing is off; an additional one does not matter."""
    published = record(**{name: artifact(name) for name in "abc"})
    found = record(a=artifact("a"), b=artifact("other"), d=artifact("d"))
    outcome = compare(published, found)
    assert outcome.artifacts == [IDENTICAL, DIFFERENT, MISSING]
    assert outcome.off == ["results/c is missing"]


def test_a_table_that_is_missing_is_one_line():
    """Not one for each of its numbers, which are off nevertheless."""
    found = record()
    del found.sections["table_6"]
    outcome = compare(record(), found)
    assert outcome.off == ["table_6 is missing"]
    assert outcome.sections["table_6"] == [OFF] * 100


def test_the_table_names_what_is_off():
    """With both values and errors."""
    found = record()
    found.sections["table_6"]["row 7, W"] = Number(2.5, 0.1, STANDARD)
    found.sections["table_6"]["row 8, W"] = Number(0.6, 0.1, STANDARD)
    text = spelled(compare(record(), found))
    assert "table_6, row 7, W: published 0.5 ± 0.1 (standard error), found 2.5 ± 0.1" in text
    assert "row 8" not in text
    (total,) = (line for line in text.splitlines() if line.startswith("all numbers"))
    assert total.split()[2:] == ["101", "99", "1", "1"]
