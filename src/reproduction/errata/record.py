"""The record of an erratum and of its evidence."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Evidence:
    """One quantity by the printed formula, by the mended one, and independently of both.

    Attributes
    ----------
    quantity : str
        What is evaluated, LaTeX.
    printed, mended, reference : float
    error : float
        Error of the comparison: of the reference, of the quadratures, or of the last digit.
    relation : {"equal", "at least", "at most"}
        How a right value compares with the reference.
    kind : {"numerical", "symbolic", "consistency"}
        Where the reference is from: a second computation, algebra without rounding, or a law that
        any right formula obeys.
    """

    quantity: str
    printed: float
    mended: float
    reference: float
    error: float = 0.0
    relation: str = "equal"
    kind: str = "numerical"

    def holds(self, value: float) -> bool:
        """Whether a value stands in the relation to the reference."""
        excess = value - self.reference
        return {
            "equal": abs(excess) <= self.error,
            "at least": excess >= -self.error,
            "at most": excess <= self.error,
        }[self.relation]


@dataclass(frozen=True)
class Erratum:
    r"""An entry of the list.

    Attributes
    ----------
    label : str
        Number of the entry, with a letter where it has several parts.
    place : str
        Where in the paper, LaTeX; ``\ref{label}`` stands for the number that the paper prints.
    wrong, right : str
        What is printed there and what should be, LaTeX.
    evaluate : callable
        Takes no arguments and returns the `Evidence`.
    """

    label: str
    place: str
    wrong: str
    right: str
    evaluate: Callable[[], Evidence]


def erratum(
    label: str, place: str, wrong: str, right: str
) -> Callable[[Callable[[], Evidence]], Erratum]:
    """Make an entry of the function below, which evaluates it; arguments as for `Erratum`."""
    return lambda evaluate: Erratum(label, place, wrong, right, evaluate)
