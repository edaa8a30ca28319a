"""A configuration made of layers: config.yaml, further files, the command line."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from pathlib import Path
from typing import Any

from reproduction.configuration.files import read
from reproduction.errors import ConfigError


@dataclass(frozen=True)
class Layers:
    """Mappings laid over each other; later ones override single keys of earlier ones.

    Parameters
    ----------
    layers : sequence of (str, dict)
        What the user calls each layer, such as its file, and its keys.
    """

    layers: Sequence[tuple[str, dict]]

    @classmethod
    def of_files(cls, files: Sequence[str | Path], command_line: dict) -> "Layers":
        """Read files and lay the command line's own keys over them.

        Parameters
        ----------
        files : sequence of str or Path
        command_line : dict
            Keys of ``--config``.

        Returns
        -------
        Layers

        Raises
        ------
        ConfigError
            If a file cannot be read.
        """
        own = []
        for file in map(Path, files):
            inside = file.is_relative_to(Path.cwd())
            name = file.relative_to(Path.cwd()) if inside else file
            own.append((str(name), read(name)))
        return cls([*own, ("--config", command_line)])

    @property
    def merged(self) -> dict[str, Any]:
        """The configuration that they make."""
        return reduce(_over, (own for _, own in self.layers), {})

    def origin(self, *keys: tuple) -> str:
        """Return the name of the layer that has the last word on keys.

        Parameters
        ----------
        *keys : tuple
            Keys and positions, from the outermost to the innermost.
        """
        last = 0
        for key in keys:
            depth = [_depth(own, key) for _, own in self.layers]
            last = max(last, *(k for k, value in enumerate(depth) if value == max(depth)))
        return self.layers[last][0]

    def named(self, error: ConfigError) -> ConfigError:
        """Return the error with the layer that is to blame at its beginning."""
        return ConfigError(str(error), self.origin(*error.keys))


def _over(base, own):
    if not (isinstance(base, dict) and isinstance(own, dict)):
        return own
    return base | {key: _over(base.get(key), value) for key, value in own.items()}


def _depth(own, key):
    """Count the leading parts of a key that a layer has."""
    for count, part in enumerate(key):
        try:
            own = own[part]
        except (LookupError, TypeError):
            return count
    return len(key)
