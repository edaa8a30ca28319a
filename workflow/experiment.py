"""What the rules need to know of the configuration."""

import os
from math import ceil, isfinite
from pathlib import Path

import yaml

from nonsmooth.configuration import validate
from nonsmooth.errors import ConfigError, SceneError
from nonsmooth.scene import Scene

SCHEMA = Path(__file__).parent / "schemas" / "config.schema.yaml"


def check(config):
    """Refuse a configuration that cannot be run, before anything runs.

    Raises
    ------
    NonsmoothError
        One line: unknown or out-of-range key, impossible scene, unwritable folder.
    """
    validate(config, yaml.safe_load(SCHEMA.read_text(encoding="utf-8")))
    for topic in ("variance", "crossing", "convergence"):
        scene = Scene(**config[topic]["scene"])
        if scene.state != ("y",):
            raise SceneError(
                f"config: {topic}.scene has the state ({', '.join(scene.state)}), but its "
                "reference solver takes (y) only; choose friction with potential '0' and g of y"
            )
    for model, parameters in config["trajectories"]["models"].items():
        Scene(model, potential=parameters["potential"], damping=parameters["damping"])
    for key, path in config["outputs"].items():
        folder = Path(path) if key == "results" else Path(path).parent
        while not folder.exists():
            folder = folder.parent
        if not (folder.is_dir() and os.access(folder, os.W_OK)):
            raise ConfigError(
                f"config: outputs.{key} = {path!r}: cannot write into {str(folder)!r}; "
                "make it writable or choose another folder"
            )


def label(number):
    """Spell a number of the configuration as it stands in file names."""
    return f"{number:g}"


def shards(topic):
    """List the shards of a Monte Carlo section of the configuration."""
    return list(range(ceil(topic["paths"] / topic["shard"])))


def part(topic, shard):
    """First path of a shard and number of its paths; the other shards do not enter."""
    first = int(shard) * topic["shard"]
    return first, min(topic["shard"], topic["paths"] - first)


def finite(numbers):
    """Those of the numbers that are finite: the paper's scheme needs a finite n."""
    return [number for number in numbers if isfinite(number)]
