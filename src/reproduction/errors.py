"""The errors of the workflow: each message is one line naming the offender and the cure."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from nonsmooth.errors import NonsmoothError


class ConfigError(NonsmoothError):
    """A configuration that cannot be run.

    Parameters
    ----------
    message : str
        What is wrong and what helps.
    place : str or Path, optional
        Where: the file, which becomes the beginning of the message.
    key : tuple
        Keys and positions of the value to blame, from the outermost to the innermost.
    others : sequence of tuple
        Keys of values that it does not fit.
    """

    def __init__(
        self,
        message: str,
        place: str | Path = "",
        key: tuple = (),
        others: Sequence[tuple] = (),
    ) -> None:
        super().__init__(f"{place}: {message}" if place else message)
        self.keys = (key, *others)


class ArtifactError(NonsmoothError):
    """A result file that is missing, truncated or not written by the workflow."""


class CheckError(NonsmoothError):
    """Results that contradict each other."""


@contextmanager
def configured_by(section: str) -> Iterator[None]:
    """Name the section of the configuration in the errors of the body, which it causes.

    Parameters
    ----------
    section : str
        Dotted key.

    Raises
    ------
    NonsmoothError
        That of the body, with the section in front of its message.
    """
    try:
        yield
    except NonsmoothError as error:
        raise type(error)(f"{section}: {error}") from error
