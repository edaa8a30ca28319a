"""The whole configuration: what cannot run is refused in one line before anything runs."""

from pathlib import Path

from reproduction.configuration.layers import Layers
from reproduction.configuration.schema import read_schema, validate
from reproduction.errors import ConfigError
from workflow.checks.outputs import check_outputs

SCHEMA = Path(__file__).parents[1] / "schemas" / "config.schema.yaml"


def check(layers: Layers) -> None:
    """Refuse a configuration that cannot be run, before anything runs.

    Parameters
    ----------
    layers : Layers

    Raises
    ------
    ConfigError
        With one line that names the file, the key, its value and the cure.
    """
    config = layers.merged
    try:
        validate(config, read_schema(SCHEMA))
        check_outputs(config["outputs"])
        # sympy takes a second, which most answers need not wait for
        from workflow.checks.meaning import check_meaning

        check_meaning(config)
    except ConfigError as error:
        raise layers.named(error) from None
