"""The public function for kappa; its values are tested with the methods that compute them."""

import pytest

import nonsmooth as ns
from references import FRICTION


def test_both_sides_of_an_odd_g():
    """An odd g has one extrapolation length for both sides."""
    lower, upper = (ns.extrapolation_length(FRICTION, side=side) for side in ("lower", "upper"))
    assert (lower.value, lower.error) == (upper.value, upper.error)


def test_the_start_does_not_matter():
    """Also where the stationary density at the start is 0 in double precision."""
    far = FRICTION.with_start({"y": 1e6})
    assert ns.extrapolation_length(far).value == ns.extrapolation_length(FRICTION).value


def test_unknown_side():
    """A side that is neither is refused; the message has the choices."""
    with pytest.raises(ns.NonsmoothError, match="choose from lower, upper"):
        ns.extrapolation_length(FRICTION, side="left")
