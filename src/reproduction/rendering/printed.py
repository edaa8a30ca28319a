"""What the paper prints: its values, and the numbers that its equations and theorems carry there.

A script that calls one of these functions lists `PRINTED` among its rule's inputs.
"""

import re

import yaml

from reproduction.errors import ArtifactError

PRINTED = "paper/printed.yaml"


def printed_values(label: str) -> dict:
    """Return the values that the paper prints in a table or a figure.

    Parameters
    ----------
    label : str
        Label in the source of the paper.

    Returns
    -------
    dict
    """
    return _read()[label]


def numbered(text: str) -> str:
    r"""Put the printed numbers in the place of the labels: ``\ref{poisson}`` becomes ``(12)``.

    Parameters
    ----------
    text : str
        LaTeX.

    Returns
    -------
    str

    Raises
    ------
    ArtifactError
        If a label has no number in `PRINTED`.
    """
    numbers = _read()["numbers"]

    def number(match):
        label = match[1]
        if label not in numbers:
            raise ArtifactError(f"{PRINTED} has no number for the label {label}; add it there")
        return numbers[label]

    return re.sub(r"\\ref\{([^}]*)\}", number, text)


def _read():
    with open(PRINTED, encoding="utf-8") as file:
        return yaml.safe_load(file)
