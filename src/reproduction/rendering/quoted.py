"""Numbers that the text quotes: spelt as they stand there, with their full value and error."""

from collections.abc import Mapping

BOUND = "bound"
STANDARD = "standard error"
INTERVAL = "half of a 95 % interval"
ROUNDING = "rounding to the digits shown"
ERROR = "an error itself"
EFFECTIVE = "an effective sample size"


class Quoted(str):
    """A number as the text spells it.

    Parameters
    ----------
    text : str
    value : float
        Of full precision.
    error : float
        Zero for a number that is an error itself.
    kind : str
        What the error is: `BOUND`, `STANDARD`, `INTERVAL`, `ROUNDING`, `ERROR` or `EFFECTIVE`.
    """

    value: float
    error: float
    kind: str

    def __new__(cls, text: str, value: float, error: float, kind: str) -> "Quoted":
        """Make the string and attach the number."""
        self = super().__new__(cls, text)
        self.value, self.error, self.kind = float(value), float(error), kind
        return self


def decimal(
    value: float, digits: int, error: float | None = None, kind: str = STANDARD, sign: str = ""
) -> Quoted:
    """Spell a number with decimals.

    Parameters
    ----------
    value : float
    digits : int
        After the point.
    error : float, optional
        Unless given, the number is as good as the digits shown.
    kind : str
        Of the error.
    sign : {"", "+"}
        "+" shows the sign of a positive number, too.

    Returns
    -------
    Quoted
    """
    value = float(value)
    text = f"{value:{sign}.{digits}f}"
    if error is None:
        return Quoted(text, value, 0.5 * 10.0**-digits, ROUNDING)
    return Quoted(text, value, error, kind)


def leaves(tree: Mapping | list | str | None, name: str = "") -> dict[str, str]:
    """Name the texts of a nested dict by their ways from the root, joined by dots."""
    if tree is None:
        return {}
    if isinstance(tree, str):
        return {name: tree}
    items = tree.items() if isinstance(tree, Mapping) else enumerate(tree)
    found: dict[str, str] = {}
    for key, branch in items:
        found |= leaves(branch, f"{name}.{key}" if name else str(key))
    return found
