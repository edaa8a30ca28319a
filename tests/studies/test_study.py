"""Studies: scenes from a table, a file or a sweep, and the jobs that they make."""

import pytest

from reproduction.errors import ConfigError
from studies.study import Study

QUESTIONS = {"spread": {"ask": "asymptotic_variance"}}


def test_scenes_go_before_base():
    """Parameters of a scene replace those that all share."""
    content = {"base": {"n": 1, "damping": 2}, "scenes": {"a": {}, "b": {"n": 3}}}
    assert Study("s", content).scenes == {"a": {"n": 1, "damping": 2}, "b": {"n": 3, "damping": 2}}


def test_a_sweep_is_the_product_of_its_values():
    """A thousand scenes are twenty jobs a question; names may stand in paths."""
    axes = {"damping": [k / 10 for k in range(1, 11)], "n": list(range(1, 11))}
    axes["slip_force"] = [f"{k} kN/1" for k in range(10)]
    study = Study("s", {"sweep": axes, "questions": QUESTIONS})
    assert len(study.scenes) == 1000
    assert len(study.artifacts("spread")) == 20
    assert not any("/" in name or " " in name for name in study.scenes)
    together = {}
    for number in study.batches:
        together |= study.of_batch(number)
    assert together == study.scenes


def test_a_file_of_scenes(tmp_path):
    """Its cells are read like values of the study; empty ones are those of base."""
    (tmp_path / "rows.csv").write_text("name, n, mass\na, .inf, 2 kg\nb,, 3 kg\n")
    study = Study("s", {"base": {"n": 5}, "scenes": "rows.csv"}, tmp_path)
    assert study.scenes == {"a": {"n": float("inf"), "mass": "2 kg"}, "b": {"n": 5, "mass": "3 kg"}}


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("name,n\n", "has no scenes"),
        ("name,n\na,1\na,2\n", "line 3: the name 'a' is taken"),
        ("name,n\nA b,1\n", "line 2: the name 'A b' must be lower-case"),
        ("name,n\na,1,2\n", "line 2 has not as many cells"),
        ("name,n\n,1\n", "line 2: the name ''"),
        ("n\n1\n", "has no column 'name'"),
        ("name;n\na;1\n", "separate cells by commas"),
    ],
)
def test_a_bad_file_of_scenes(tmp_path, rows, message):
    """The line and the cure."""
    (tmp_path / "rows.csv").write_text(rows)
    with pytest.raises(ConfigError, match=message):
        _ = Study("s", {"scenes": "rows.csv"}, tmp_path).scenes
