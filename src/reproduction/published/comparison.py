"""Comparison of a run with the published one: identical, within the stated errors, or off."""

import math
import re
from dataclasses import dataclass, field

from reproduction.agreement import standard_errors
from reproduction.errors import ArtifactError
from reproduction.published.record import Number, Record
from reproduction.rendering.quoted import EFFECTIVE, ERROR, INTERVAL, STANDARD

MAGNITUDE = 10.0  # an error is stated by its order of magnitude
HALF_INTERVAL = 1.96  # standard errors

IDENTICAL, WITHIN, OFF = "identical", "within errors", "off"
DIFFERENT, MISSING = "different bytes", "missing"


@dataclass
class Comparison:
    """Outcome of a comparison.

    Attributes
    ----------
    sections : dict
        Section -> outcome of each of its numbers.
    artifacts : list of str
        Outcome of each artifact.
    off : list of str
        A line for each number that is off and each artifact that is missing.
    """

    sections: dict[str, list[str]] = field(default_factory=dict)
    artifacts: list[str] = field(default_factory=list)
    off: list[str] = field(default_factory=list)


def compare(published: Record, found: Record, results: str = "results") -> Comparison:
    """Compare two runs with the same parameters; their seeds may differ.

    Parameters
    ----------
    published, found : Record
    results : str
        Folder of the second, for messages.

    Returns
    -------
    Comparison

    Raises
    ------
    ArtifactError
        If an artifact was made with other parameters.
    """
    for name in sorted(published.artifacts.keys() & found.artifacts.keys()):
        if published.artifacts[name]["parameters"] != found.artifacts[name]["parameters"]:
            raise ArtifactError(
                f"{results}/{name} was made with other parameters (sizes, scenes, times) than the "
                "published one; verify a full run, made by make paper with config.yaml as it is"
            )
    outcome, z = Comparison(), standard_errors(max(statistical(published), 1))
    for section in sorted(published.sections | found.sections, key=_in_order):
        left, right = (record.sections.get(section, {}) for record in (published, found))
        states = outcome.sections.setdefault(section, [])
        for name in sorted(left | right, key=_in_order):
            pair = left.get(name), right.get(name)
            states.append(state(*pair, z))
            if states[-1] == OFF and right:
                outcome.off.append(f"{section}, {name}: published {_spelt(*pair)}")
        if not right:
            outcome.off.append(f"{section} is missing")
    for name, published_one in published.artifacts.items():
        found_one = found.artifacts.get(name, {"sha256": MISSING})
        same = found_one["sha256"] == published_one["sha256"]
        missing = found_one["sha256"] == MISSING
        outcome.artifacts.append(IDENTICAL if same else MISSING if missing else DIFFERENT)
        if missing:
            outcome.off.append(f"{results}/{name} is missing")
    return outcome


def statistical(record: Record) -> int:
    """Return the number of entries that differ by chance between independent runs."""
    return sum(
        isinstance(entry, Number) and entry.kind in (STANDARD, INTERVAL)
        for entries in record.sections.values()
        for entry in entries.values()
    )


def state(published: Number | str | None, found: Number | str | None, z: float) -> str:
    """Compare one entry.

    Parameters
    ----------
    published, found : Number, str or None
        None where the entry is missing.
    z : float
        Standard errors that are allowed.

    Returns
    -------
    str
        `IDENTICAL`, `WITHIN` or `OFF`. Without an error, only what is equal is not off. Bounds and
        roundings add up; standard errors add up in squares. An error of more than `MAGNITUDE` times
        the published one is off, too, and an effective size of less than a part of it.
    """
    if published == found:
        return IDENTICAL
    if not (isinstance(published, Number) and isinstance(found, Number)):
        return OFF
    if published.kind != found.kind:
        return OFF
    if published.kind == ERROR:
        return WITHIN if 0 <= found.value <= MAGNITUDE * published.value else OFF
    if published.kind == EFFECTIVE:
        return WITHIN if MAGNITUDE * found.value >= published.value else OFF
    if published.kind in (STANDARD, INTERVAL):
        multiple = z / (HALF_INTERVAL if published.kind == INTERVAL else 1.0)
        allowed = multiple * math.hypot(published.error, found.error)
    else:
        allowed = published.error + found.error
    close = abs(published.value - found.value) <= allowed
    return WITHIN if close and found.error <= MAGNITUDE * published.error else OFF


def spelled(outcome: Comparison) -> str:
    """Spell the outcome as a table, with a line for each number that is off."""
    states = (IDENTICAL, WITHIN, OFF)
    lines = [_line("", "numbers", *states)]
    every = [state for section in outcome.sections.values() for state in section]
    for section, found in [*outcome.sections.items(), ("all numbers", every)]:
        lines.append(_line(section, len(found), *map(found.count, states)))
    states = (IDENTICAL, DIFFERENT, MISSING)
    lines += ["", _line("", "files", *states)]
    lines.append(_line("artifacts", len(outcome.artifacts), *map(outcome.artifacts.count, states)))
    return "\n".join([*lines, "", *outcome.off])


def _line(name, *cells):
    return f"{name:<22}" + "".join(f"{cell:>16}" for cell in cells)


def _spelt(published, found):
    return f"{_one(published)}, found {_one(found)}"


def _one(entry):
    if entry is None:
        return "nothing"
    if isinstance(entry, str):
        return repr(entry)
    if entry.kind == ERROR:
        return f"an error of {entry.value:.2g}"
    if entry.kind == EFFECTIVE:
        return f"an effective size of {entry.value:.4g}"
    return f"{entry.value:.12g} ± {entry.error:.2g} ({entry.kind})"


def _in_order(name):
    """Sort by the numbers within names, where there are some."""
    parts = re.split(r"(\d+)", name)
    return [int(part) if k % 2 else part for k, part in enumerate(parts)]
