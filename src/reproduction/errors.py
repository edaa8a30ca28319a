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


def dotted(key: tuple) -> str:
    """Spell a key as messages have it."""
    return repr(".".join(map(str, key)))


@contextmanager
def configured_by(*key: str | int) -> Iterator[None]:
    """Say which key of the configuration causes the errors of the body.

    Parameters
    ----------
    *key : str or int
        Keys and positions, from the outermost to the innermost.

    Raises
    ------
    ConfigError
        With the key in front of the message.
    """
    try:
        yield
    except NonsmoothError as error:
        raise ConfigError(f"{dotted(key)}: {error}", key=key) from error
