"""Quantities with units: what is read, what is refused, and the way back."""

import math

import pytest

from nonsmooth.dimensions import Scales
from nonsmooth.errors import ExpressionError
from reproduction.errors import ConfigError
from studies.units import Units, in_si, spelt


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("2 mm", "m", 2e-3),
        ("1200 kg", "kg", 1200),
        ("5 %", "1", 0.05),
        (0.05, "1", 0.05),
        ("40 kN/m", "N/m", 4e4),
        ("300 N s/m", "N*s/m", 300),
        ("0.01 m²/s³", "m**2/s**3", 0.01),
        ("1.5e-2 m^2/s^3", "m**2/s**3", 0.015),
        ("15 rad/s", "rad/s", 15),
        ("2.4 Hz", "rad/s", 2.4 * 2 * math.pi),
        # a spectral density over frequencies in Hz is 2 pi times that over rad/s
        ("0.01 m^2/s^4/Hz", "m**2/s**3", 0.01 / (2 * math.pi)),
    ],
)
def test_is_read(text, unit, value):
    """In SI units; a frequency in Hz counts cycles."""
    assert in_si(text, unit) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "unit", "message"),
    [
        ("2", "m", "has no unit; write such as '2 m'"),
        ("2 s", "m", "is no quantity in m"),
        ("2 parsnips", "m", "a unit that is not known"),
        ("two mm", "m", "is no number with a unit"),
        ("2 kg", "1", "is no plain number"),
        ("__import__('os')", "m", "is no number with a unit"),
        (True, "1", "is no number with a unit"),
        ("5 kg/0", "kg", "a unit that is not known"),
        ("5 kg)", "kg", "a unit that is not known"),
        ("5 " + 3000 * "mm*" + "1", "m", r"^'5 mm[^\n]{60,80}\.\.\. has a unit that is not known"),
    ],
)
def test_is_refused(text, unit, message):
    """One line with the value and the cure."""
    with pytest.raises(ConfigError, match=message):
        in_si(text, unit)


def test_numbers_go_there_and_back():
    """A velocity in the user's units is the scene's number times the factor, and back."""
    units = Units(Scales(length=0.004, time=0.1, force=700.0), {"length": "mm", "time": "min"})
    velocity = {"length": 1, "time": -1}
    number = units.number("12 mm/s", velocity)
    assert number == pytest.approx(12 / 40)
    assert number * units.factor(velocity) == pytest.approx(12 * 60)
    assert units.unit(velocity) == "mm min-1"
    assert units.number(["2 mm", "4 mm"], {"length": 1}) == pytest.approx([0.5, 1.0])


def test_dimensionless_numbers_stay():
    """Without scales nothing has a unit."""
    assert Units().number(3.0, {"length": 1}) == 3.0
    assert Units().unit({"length": 1}) == "1"


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (201.93, 2.61, "201.9 ± 2.6 mm² s⁻¹"),
        (0.0, 0.0, "0 mm² s⁻¹ (exact)"),
        (0.137696412899501, 1.7e-14, "0.137696412899501 ± 1.7·10⁻¹⁴ mm² s⁻¹"),
        (3.3e-4, 1.5e-17, "3.30000000000000·10⁻⁴ ± 1.5·10⁻¹⁷ mm² s⁻¹"),
        (-3e-5, 1.2e-3, "0.0000 ± 0.0012 mm² s⁻¹"),
        (3.14159e-7, 2.2e-9, "(3.142 ± 0.022)·10⁻⁷ mm² s⁻¹"),
        (12.0, 130.0, "12 ± 130 mm² s⁻¹"),
    ],
)
def test_is_spelt_to_two_digits_of_its_error(value, error, text):
    """As reports have it."""
    assert spelt(value, error, "mm2 s-1") == text


@pytest.mark.parametrize(
    ("limits", "text"),
    [
        ((3.1, math.inf), "≥ 3.1 s"),
        ((-math.inf, -2.0), "≤ -2 s"),
        ((3.1, 4.2), "3.1 to 4.2 s"),
        ((-math.inf, math.inf), "unknown"),
    ],
)
def test_without_an_error_the_limits_are_spelt(limits, text):
    """As for the index of what no path has crossed."""
    assert spelt(math.inf, math.inf, "s", limits) == text


def test_what_no_path_has_crossed_has_an_upper_limit():
    """A probability of 0 with the limits 0 and 6e-4."""
    assert spelt(0.0, 3e-4, limits=(0.0, 6.2e-4)) == "≤ 6.2·10⁻⁴"
    assert spelt(0.0, 3e-3, limits=(0.0, 6.2e-3)) == "≤ 0.0062"
    assert spelt(0.0, 3e-4, limits=(-3e-4, 3e-4)) == "(0.0 ± 3.0)·10⁻⁴"


def test_a_formula_of_time():
    """Its t is in the user's time: of ms, 100 make the unit of the scene's."""
    units = Units(Scales(length=0.004, time=0.1, force=700.0), {"time": "ms"})
    t = 0.7
    scaled = units.formula_of_time("t/50*exp(1 - t/50) + sqrt(t)")
    value = eval(scaled, {"t": t, "exp": math.exp, "sqrt": math.sqrt})  # ours, of the line above
    assert value == pytest.approx(70 / 50 * math.exp(1 - 70 / 50) + math.sqrt(70))
    assert Units().formula_of_time("exp(-t)") == "exp(-t)"
    with pytest.raises(ExpressionError, match="cannot read the formula '2t'"):
        units.formula_of_time("2t")
