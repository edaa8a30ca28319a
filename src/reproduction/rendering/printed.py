"""What the paper prints: its values, and the numbers that its equations and theorems carry there.

A script that calls one of these functions lists `PRINTED` among its rule's inputs.
"""

import re
from pathlib import Path

import yaml

from reproduction.errors import ArtifactError

PRINTED = "paper/printed.yaml"
_ROOT = Path(__file__).parents[3]  # the workflow may run elsewhere


def printed_values(label: str) -> dict:
    """Return the values that the paper prints in a table or a figure.

    Parameters
    ----------
    label : str
        Label in the source of the paper.

    Returns
    -------
    dict

    Raises
    ------
    ArtifactError
        If `PRINTED` cannot be read or has no such label.
    """
    return _read(label)


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
        If `PRINTED` cannot be read or a label has no number there.
    """
    numbers = _read("numbers")

    def number(match):
        label = match[1]
        if label not in numbers:
            raise ArtifactError(f"{PRINTED} has no number for the label {label}; add it there")
        return numbers[label]

    return re.sub(r"\\ref\{([^}]*)\}", number, text)


def _read(key):
    try:
        with open(_ROOT / PRINTED, encoding="utf-8") as file:
            return dict(yaml.safe_load(file)[key])
    except (OSError, ValueError, TypeError, KeyError, yaml.YAMLError) as error:
        reason = " ".join(str(error).split())
        raise ArtifactError(
            f"{PRINTED} has no readable entry {key!r} ({reason}); restore it with git"
        ) from None
