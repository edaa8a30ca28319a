"""All entries of the errata."""

import re

from reproduction.errata import integral, misprints, stationary, theorems
from reproduction.errata.record import Erratum


def _number_and_letter(entry):
    number, letter = re.fullmatch(r"(\d+)([a-z]?)", entry.label).groups()
    return int(number), letter


ERRATA: list[Erratum] = sorted(
    (
        entry
        for module in (stationary, integral, theorems, misprints)
        for entry in vars(module).values()
        if isinstance(entry, Erratum)
    ),
    key=_number_and_letter,
)
