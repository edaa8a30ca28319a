"""Quantities with units as numbers of a scene, and numbers of a scene in the user's units."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache
from tokenize import TokenError
from typing import Any

import pint
import sympy

from nonsmooth.dimensions import Scales
from nonsmooth.scenes.formulas import parse
from reproduction.configuration.schema import shown
from reproduction.errors import ConfigError

# powers of the base quantities, as in {"length": 1, "time": -1} for a velocity
Powers = Mapping[str, int]
BASE = {"length": "m", "time": "s", "force": "N"}
LONGEST_ERROR = 6  # decimals of an error that is not written with a power of ten
# what a text may be: a number and a unit of letters, digits and signs
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([\w\s/*^().%µ·²³-]*)")

# what is raised for units such as kg/0, kg) and kg*kg*kg*...
_UNREADABLE = (pint.PintError, TokenError, ArithmeticError, AssertionError, RecursionError)


@cache
def _registry():
    # a frequency in Hz counts cycles, of 2 pi rad each; pint takes one for 1 rad/s
    registry = pint.UnitRegistry(on_redefinition="ignore")
    registry.define("hertz = 2 * pi * radian / second = Hz")
    return registry


def in_si(value: Any, unit: str) -> float:
    """Read a quantity.

    Parameters
    ----------
    value : str or float
        Such as ``"2 mm"``; a plain number only if `unit` is "1".
    unit : str
        An SI unit of its kind.

    Returns
    -------
    float
        In that unit.

    Raises
    ------
    ConfigError
        If there is no unit, an unknown one, or one of another kind.
    """
    if isinstance(value, int | float) and not isinstance(value, bool):
        value = str(value)
    if not isinstance(value, str):
        raise ConfigError(f"{shown(value)} is no number with a unit; {_example(unit)}")
    return _read(value, unit)


def _example(unit):
    return f"write such as '2 {unit}'" if unit != "1" else "write a number, or such as '5 %'"


@lru_cache(maxsize=4096)  # scenes have most of their quantities in common
def _read(value, unit):
    example, found = _example(unit), _QUANTITY.fullmatch(value)
    if found is None:
        raise ConfigError(f"{shown(value)} is no number with a unit; {example}")
    number, own = float(found[1]), found[2].strip().replace("²", "^2").replace("³", "^3")
    if not own and unit != "1":
        raise ConfigError(f"{shown(value)} has no unit; {example}")
    try:
        factor = _registry().parse_units(own.replace("%", "percent")) if own else 1.0
        return float(
            (number * factor * _registry().dimensionless).to("" if unit == "1" else unit).m
        )
    except pint.DimensionalityError:
        raise ConfigError(f"{shown(value)} is no {_kind(unit)}; {example}") from None
    except (*_UNREADABLE, ValueError, TypeError):
        raise ConfigError(f"{shown(value)} has a unit that is not known; {example}") from None


def _kind(unit):
    return "plain number" if unit == "1" else f"quantity in {unit}"


@dataclass(frozen=True)
class Units:
    """Converts between a scene's numbers and the user's quantities.

    Parameters
    ----------
    scales : Scales, optional
        The scene's units; None for a dimensionless scene, whose numbers stay as they are.
    names : dict
        The user's units of length, time and force, SI units where not given.
    """

    scales: Scales | None = None
    names: Mapping[str, str] = field(default_factory=dict)

    def factor(self, powers: Powers) -> float:
        """Return what a scene's unit of a quantity is in the user's unit."""
        if self.scales is None:
            return 1.0
        value = 1.0
        for base, power in powers.items():
            user = in_si(f"1 {self._name(base)}", BASE[base])
            value *= (getattr(self.scales, base) / user) ** power
        return value

    def unit(self, powers: Powers) -> str:
        """Spell the user's unit of a quantity as the CF conventions have it."""
        parts = [
            self._name(base) + (str(power) if power != 1 else "")
            for base, power in sorted(powers.items(), key=lambda item: -item[1])
            if power != 0
        ]
        return " ".join(parts) if parts and self.scales is not None else "1"

    def number(self, value: Any, powers: Powers) -> Any:
        """Read a quantity, or a list of them, as numbers of the scene.

        Raises
        ------
        ConfigError
            As from `in_si`, for scenes in SI units.
        """
        if isinstance(value, list):
            return [self.number(one, powers) for one in value]
        # plain numbers, infinity among them, are dimensionless
        if self.scales is None or value in (float("inf"), float("-inf")):
            return value
        return in_si(value, _in_si_units(powers)) / Units(self.scales).factor(powers)

    def formula_of_time(self, text: str) -> str:
        """Write a formula in t, in the user's unit of time, as one in the scene's.

        Raises
        ------
        ExpressionError
            If it cannot be read.
        """
        parse(text, (sympy.Symbol("t", real=True),))
        factor = self.factor({"time": 1})
        return text if factor == 1 else re.sub(r"\bt\b", f"({factor!r}*t)", text)

    def _name(self, base):
        return self.names.get(base, BASE[base])


def _in_si_units(powers):
    """Spell the SI unit of a quantity as a user would, and as `in_si` reads it: N*s, m/s**2."""
    over, under = (
        "*".join(
            BASE[base] + (f"**{abs(power)}" if abs(power) > 1 else "")
            for base, power in powers.items()
            if power * sign > 0
        )
        for sign in (1, -1)
    )
    return f"{over or 1}/{under}" if under else over or "1"


def pretty(unit: str) -> str:
    """Spell a unit of `Units.unit` for reading: mm2 s-1 as mm² s⁻¹."""
    return "" if unit == "1" else unit.translate(str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"))


def in_figures(unit: str) -> str:
    """Spell a unit as the labels of figures have it, whose fonts lack some superscripts."""
    return "" if unit == "1" else re.sub(r"([A-Za-z]+)(-?\d+)", r"\1$^{\2}$", unit)


def spelt(
    value: float,
    error: float,
    unit: str = "1",
    limits: tuple[float, float] = (-math.inf, math.inf),
) -> str:
    """Spell a number with its error, to two digits of the error: 200.5 ± 2.6 mm² s⁻¹.

    Parameters
    ----------
    value, error : float
    unit : str
        As the CF conventions have it.
    limits : (float, float)
        Between which it is; they are spelt where the error is infinite, and the upper one where
        the value and the lower one are 0, as of what no path has crossed.

    Returns
    -------
    str
    """
    unit = pretty(unit)
    tail = f" {unit}" if unit else ""
    if math.isinf(error):
        low, high = (f"{limit:.3g}{tail}" for limit in limits)
        if math.isinf(limits[1]):
            return "unknown" if math.isinf(limits[0]) else f"≥ {low}"
        return f"≤ {high}" if math.isinf(limits[0]) else f"{limits[0]:.3g} to {high}"
    if value == limits[0] == 0 < limits[1] < math.inf:
        return f"≤ {_rounded(limits[1])}{tail}"
    if error == 0:
        return f"{value:.6g}{tail}" + (" (exact)" if value == 0 else "")
    size = max(abs(value), error)
    exponent = 0 if 1e-3 <= size < 1e5 else math.floor(math.log10(size))
    power, scale = _power(exponent), 10.0**exponent
    digits = max(1 - math.floor(math.log10(error)) + exponent, 0)
    number = f"{round(value / scale, digits) + 0.0:.{digits}f}"  # no -0
    if digits > LONGEST_ERROR:
        return f"{number}{power} ± {_rounded(error)}{tail}"
    spread = f"{error / scale:.{digits}f}"
    return (f"({number} ± {spread}){power}" if power else f"{number} ± {spread}") + tail


def readable(text: str) -> str:
    """Write the formulas of a long name as they are read."""
    return text.replace("gamma^2", "γ²")


def _power(exponent):
    digits = str(exponent).translate(str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"))
    return f"·10{digits}" if exponent else ""


def _rounded(number):
    """Spell a positive number to two digits."""
    exponent = math.floor(math.log10(number))
    if exponent >= -3:
        return f"{number:.2g}"
    return f"{number / 10.0**exponent:.1f}{_power(exponent)}"


def told(value: Any) -> str:
    """Spell a value of a study on one line."""
    if isinstance(value, Mapping):
        return ", ".join(f"{key}: {told(inner)}" for key, inner in value.items())
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
