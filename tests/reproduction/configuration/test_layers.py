"""Layers of a configuration: the later override single keys, and each key has an origin."""

from reproduction.configuration.layers import Layers
from reproduction.errors import ConfigError

LAYERS = Layers(
    [
        ("config.yaml", {"a": {"b": 1, "c": [1, 2]}, "d": 3}),
        ("mine.yaml", {"a": {"b": 2}}),
        ("--config", {"d": 4}),
    ]
)


def test_later_layers_override_single_keys():
    """What they do not name stays."""
    assert LAYERS.merged == {"a": {"b": 2, "c": [1, 2]}, "d": 4}


def test_a_value_in_the_place_of_a_mapping():
    """It replaces the mapping, and a mapping replaces it."""
    assert Layers([("1", {"a": {"b": 1}}), ("2", {"a": 5})]).merged == {"a": 5}
    assert Layers([("1", {"a": 5}), ("2", {"a": {"b": 1}})]).merged == {"a": {"b": 1}}


def test_the_origin_of_a_key():
    """It is the last layer that has it, or has most of it."""
    assert LAYERS.origin(("a", "b")) == "mine.yaml"
    assert LAYERS.origin(("a", "c", 1)) == "config.yaml"
    assert LAYERS.origin(("d",)) == "--config"
    assert LAYERS.origin(("a", "missing")) == "mine.yaml"


def test_an_error_is_named_after_the_origin_of_its_key():
    """The origin begins the message."""
    assert str(LAYERS.named(ConfigError("is bad", key=("d",)))) == "--config: is bad"


def test_files_are_called_as_they_lie_in_the_folder(tmp_path, monkeypatch):
    """Those elsewhere by their full names; the command line comes last."""
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    (folder / "a.yaml").write_text("a: 1\nb: 1\n")
    (tmp_path / "b.yaml").write_text("b: 2\n")
    layers = Layers.of_files([folder / "a.yaml", tmp_path / "b.yaml"], {"c": 3})
    assert layers.merged == {"a": 1, "b": 2, "c": 3}
    names = [layers.origin((key,)) for key in "abc"]
    assert names == ["a.yaml", str(tmp_path / "b.yaml"), "--config"]
