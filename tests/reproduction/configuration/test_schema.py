"""A bad configuration costs one line that names the key and the cure."""

import copy

import pytest
import yaml

from reproduction.configuration.layers import Layers
from reproduction.configuration.schema import validate
from reproduction.errors import ConfigError
from support import ROOT
from workflow.checks.configuration import SCHEMA, check
from workflow.experiment import label, shards

CONFIG = yaml.safe_load((ROOT / "config.yaml").read_text())
SMOKE = yaml.safe_load((ROOT / "config" / "smoke.yaml").read_text())


def changed(path, value):
    """Return the configuration with one key set, given as a dotted path."""
    config = copy.deepcopy(CONFIG)
    *parents, last = path.split(".")
    place = config
    for key in parents:
        place = place[int(key) if isinstance(place, list) else key]
    place[last] = value
    return config


def leaves(schema, path=()):
    """Yield every property of the schema with its path."""
    for key, value in schema.get("properties", {}).items():
        yield (*path, key), value
        yield from leaves(value, (*path, key))


def test_the_paper_configuration_is_valid():
    """config.yaml is valid as it stands in the repository."""
    check(Layers([("config.yaml", CONFIG)]))


def test_every_key_is_described():
    """The schema describes every key, directly or through a reference."""
    schema = yaml.safe_load(SCHEMA.read_text())
    definitions = schema["$defs"]
    for path, value in [*leaves(schema), *leaves({"properties": definitions})]:
        if path[0] in ("positive", "scale"):
            continue
        reference = definitions.get(value.get("$ref", "").rpartition("/")[2], {})
        assert "description" in value or "description" in reference, ".".join(path)


def test_the_smoke_configuration_only_overrides():
    """Every key of config/smoke.yaml exists in config.yaml."""

    def compare(small, large):
        for key, value in small.items():
            assert key in large
            if isinstance(value, dict):
                compare(value, large[key])

    compare(SMOKE, CONFIG)


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("sede", 1, "unknown key 'sede'; did you mean 'seed'?"),
        ("crossing.treshold", 1, "unknown key 'treshold' in 'crossing'; did you mean 'threshold'?"),
        ("variance.alhpa", 1, "unknown key 'alhpa' in 'variance'"),
        ("crossing.threshold", -1, "'crossing.threshold' = -1: must be greater than 0"),
        ("crossing.p", [], "'crossing.p'"),
        ("crossing.paths", 1.5, "'crossing.paths' = 1.5: must be of type integer"),
        ("crossing.shard", 7500, "'crossing.shard'"),
        ("seed", "x", "'seed' = 'x': must be of type integer"),
        ("variance.scene.model", "fricton", "must be one of elasto_plastic, friction, obstacle"),
        ("variance.scene.potential", "x**2", "choose friction with potential '0'"),
        ("variance.scene.potential", "import os", "cannot read the formula"),
        ("variance.scene.observable", "q", "cannot read the formula"),
        (
            "crossing.scene.model",
            "obstacle",
            "= 'obstacle' has the state (y, x)",
        ),
        ("trajectories.models.friction.damping", 0, "must be greater than 0"),
        ("trajectories.models.friction.potential", "x +", "cannot read the formula"),
        ("convergence.scene.n", 5, "unknown key 'n' in 'convergence.scene'"),
        ("variance.scene.n", float("inf"), "must be at most"),
        ("crossing.threshold", float("nan"), "'crossing.threshold' is not a number"),
        ("crossing.p", [1, float("inf")], "'crossing.p.1' = inf: must be at most"),
        ("crossing.scene.noise", "langevin", "with white noise only"),
        ("crossing.outputs", 1, "must be at least 2"),
        ("variance.finite_difference.nodes", 4003, "use 4001"),
        ("variance.finite_difference.time_step", 0.003, "must be half of a divisor"),
        ("variance.horizon", 0.01, "must be a larger multiple"),
        ("variance.first_time", 0.07, "must be a larger multiple"),
        ("limit_theorem.scenes", ["no_such_scene"], "not a simulated scene of the sweep"),
        ("theorems.ergodicity.scenes", ["no_such_scene"], "not a scene of the sweep"),
        ("theorems.ergodicity.scenes", ["obstacle_langevin"], "of more than two state variables"),
        ("theorems.ergodicity.enlargement", 1, "'theorems.ergodicity.enlargement'"),
        ("limit_theorem.p", [1, 100, 10], "must increase"),
        ("limit_theorem.p", [1, 10], "'limit_theorem.p'"),
        ("finite_p.p", [1, 100, 10], "must increase"),
        ("finite_p.tabulated", 3, "must be one of finite_p.horizons"),
        ("finite_p.first_time", 11, "is above half of crossing.horizon"),
        ("plasticity.oscillator.damping", 0, "must be greater than 0"),
        ("plasticity.oscillator.potential", "x +", "cannot read the formula"),
        ("plasticity.limits", [1, 1], "'plasticity.limits'"),
        ("gamma2.potentials.scenes.0.potential", "x +", "cannot read the formula"),
        ("gamma2.potentials.scenes.3.noise.potential", "-eta**2", "is not confining"),
        ("gamma2.potentials.scenes.3.noise", "langevin", "'gamma2.potentials.scenes.3.noise'"),
        ("gamma2.potentials.times", [10, 60, 20], "'gamma2.potentials.times'"),
        ("outputs.results", "config.yaml/results", "is no folder"),
    ],
)
def test_bad_keys(path, value, message, monkeypatch):
    """The message names the key; it is one line."""
    monkeypatch.chdir(ROOT)
    with pytest.raises(ConfigError) as error:
        check(Layers([("config.yaml", changed(path, value))]))
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_missing_key():
    """The key and where it is missing."""
    config = copy.deepcopy(CONFIG)
    del config["crossing"]["p"]
    with pytest.raises(ConfigError, match="'p' is missing in 'crossing'"):
        validate(config, yaml.safe_load(SCHEMA.read_text()))


def test_labels_and_shards():
    """Numbers as they stand in file names, and the last shard may be smaller."""
    numbers = (2, 0.5, 1e6, 1234567, 0.12345678, 1e-5, float("inf"))
    assert [float(label(x)) for x in numbers] == list(numbers)
    assert [label(x) for x in (2, 2.0, 0.5, float("inf"))] == ["2", "2", "0.5", "inf"]
    assert shards({"paths": 12_000, "shard": 5_000}) == [0, 1, 2]
