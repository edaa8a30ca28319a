"""A configuration made of layers: config.yaml, further files, the command line."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

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

    @property
    def merged(self) -> dict[str, Any]:
        """The configuration that they make."""
        return reduce(_over, (own for _, own in self.layers), {})

    def origin(self, key: tuple) -> str:
        """Return the name of the layer that has the last word on a key.

        Parameters
        ----------
        key : tuple
            Keys and positions, from the outermost to the innermost.
        """
        depth = {name: _depth(own, key) for name, own in self.layers}
        deepest = max(depth.values())
        return [name for name, value in depth.items() if value == deepest][-1]

    def named(self, error: ConfigError) -> ConfigError:
        """Return the error with the layer that is to blame at its beginning."""
        return ConfigError(str(error), self.origin(error.key))


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
