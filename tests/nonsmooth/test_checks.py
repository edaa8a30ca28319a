"""What public functions accept as numbers, counts, seeds and times, and what they refuse."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import xarray as xr

from nonsmooth import checks
from nonsmooth.errors import SceneError

NUMBERS = (2, 2.0, np.float32(2), np.uint8(2), np.array(2), xr.DataArray(2.0), Decimal(2))
NO_NUMBERS = ("2", True, np.bool_(True), 2j, None, [2.0], 10**400, np.ma.masked, Decimal("sNaN"))


@pytest.mark.parametrize("value", [*NUMBERS, Fraction(2)])
def test_numbers(value):
    """Real numbers of every kind become floats, and counts if they are whole."""
    number, count = checks.require_positive("a", value), checks.require_count("a", value)
    assert (number, type(number)) == (2.0, float)
    assert (count, type(count)) == (2, int)
    assert checks.require_list("a", value).tolist() == [2.0]


@pytest.mark.parametrize("value", [*NO_NUMBERS, 0, -1, float("nan"), float("inf"), 1e-300, 1e300])
def test_what_is_no_positive_number(value):
    """Texts, booleans, complex numbers and numbers beyond double precision are refused."""
    with pytest.raises(SceneError, match=r"^a is .*; give a [^\n]*$"):
        checks.require_positive("a", value)


def test_lists_end():
    """Longer ones take memory and minutes."""
    assert len(checks.require_list("a", np.ones(checks.LONGEST))) == checks.LONGEST
    with pytest.raises(SceneError, match="a has 5001 numbers; give at most 5000"):
        checks.require_list("a", np.ones(checks.LONGEST + 1))


@pytest.mark.parametrize("value", [*NO_NUMBERS, 0, -1, 1.5])
def test_what_is_no_count(value):
    """Counts are whole and positive."""
    with pytest.raises(SceneError, match=r"^a is .*; give a positive whole number$"):
        checks.require_count("a", value)


@pytest.mark.parametrize("values", [[1, 2.5], (1, 2.5), np.array([1, 2.5]), [1, Fraction(5, 2)]])
def test_lists(values):
    """Lists, tuples and arrays become arrays of floats."""
    for given in (values, xr.DataArray([1, 2.5], dims="time")):
        assert checks.require_increasing("a", given).tolist() == [1.0, 2.5]


@pytest.mark.parametrize(
    "values",
    [
        *([], [[1.0, 2.0]], [1.0, [2.0]], ["a"], [1.0, None], [1.0, np.nan], [1.0, np.inf], {1.0}),
        *({"y": 1.0}, "1", iter([1.0]), [2.0, 1.0], [1.0, 1.0], [0.0, 1.0], [True, 2.0, None]),
        *(np.ma.array([1.0, 2.0], mask=[True, False]), np.array(["2020"], dtype="M8[D]")),
        xr.Dataset({"a": ("b", [1.0, 2.0])}),
    ],
)
def test_what_is_no_increasing_list(values):
    """Everything else is refused in one line, whatever it is."""
    with pytest.raises(SceneError, match=r"^a is .*; [^\n]*$"):
        checks.require_increasing("a", values)


def test_seeds():
    """A seed is a whole number, or one with labels; numpy's integers are the same seeds."""
    assert checks.require_seed(np.int64(3)) == 3
    assert checks.require_seed((np.uint8(3), "a", 1)) == (3, "a", 1)
    for seed in (-1, 1.0, True, None, "1", (), (1, None), (-1, "a"), ((1, 2), 3), [1]):
        with pytest.raises(SceneError, match="seed is"):
            checks.require_seed(seed)


def test_choices():
    """The nearest name is proposed; all names if none is near."""
    assert checks.require_choice("a", np.str_("lie"), ("lie", "strang")) == "lie"
    for wrong, cure in (
        ("Strang", "did you mean 'strang'"),
        ("x", "from lie, strang"),
        (["lie"], "from lie, strang"),
    ):
        with pytest.raises(SceneError, match=cure):
            checks.require_choice("a", wrong, ("lie", "strang"))
    with pytest.raises(SceneError, match="did you mean 'lie'"):
        checks.require_choice("a", "Trotter", ("lie", "strang"), {"trotter": "lie"})
