"""Numbers that the text quotes are strings that know their value and error."""

import json

import pytest

from reproduction.rendering.quoted import BOUND, ROUNDING, STANDARD, Quoted, decimal, leaves


def test_a_number_without_an_error_is_as_good_as_its_digits():
    """Half a unit of the last."""
    number = decimal(0.12345, 2)
    assert (str(number), number.value, number.kind) == ("0.12", 0.12345, ROUNDING)
    assert number.error == pytest.approx(0.005)


def test_a_number_keeps_its_stated_error():
    """A standard error unless said otherwise; the sign is shown on demand."""
    assert vars(decimal(1.25, 1, 0.5)) == {"value": 1.25, "error": 0.5, "kind": STANDARD}
    assert decimal(1.25, 3, 0.5, BOUND, sign="+") == "+1.250"


def test_texts_are_named_by_their_way():
    """Through dicts and lists; what is not shown has no name. JSON sees a string."""
    number = Quoted("1.0 times 10^(- 6)", 1e-6, 1e-7, BOUND)
    tree = {"a": {"b": [{"c": number}, None, "2"]}, "seed": "1"}
    assert leaves(tree) == {"a.b.0.c": number, "a.b.2": "2", "seed": "1"}
    assert isinstance(leaves(tree)["a.b.0.c"], Quoted)
    assert json.dumps(number) == '"1.0 times 10^(- 6)"'
