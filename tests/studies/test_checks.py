"""Bad studies: one line that names the key and the cure. The studies that come along are sound."""

import copy

import pytest
import yaml

from reproduction.errors import ConfigError
from studies.checks import require_sound
from studies.study import Study
from support import ROOT

SOUND = yaml.safe_load("""
title: A study
base: {model: friction, n: 10}
scenes: {weak: {damping: 0.5}, strong: {damping: 2}}
questions:
  spread: {ask: asymptotic_variance, tol: 0.01}
  crossing: {ask: crossing_probability, threshold: 1, horizons: [1, 2]}
""")
IN_SI = yaml.safe_load("""
title: A study
base: {model: friction, mass: 10 kg, damping: 3 N s/m, ground_spectral_density: 0.1 m^2/s^3}
scenes: {weak: {slip_force: 5 N}}
questions: {crossing: {ask: crossing_probability, threshold: 5 mm, horizons: [1 s, 2 s]}}
""")


def refused(content, keys, value):
    """Return the message about a study in which a value is another; None deletes it."""
    content = copy.deepcopy(content)
    place = content
    for key in keys[:-1]:
        place = place[key]
    if value is None:
        del place[keys[-1]]
    else:
        place[keys[-1]] = value
    with pytest.raises(ConfigError) as caught:
        require_sound(Study("mine", content))
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("keys", "value", "message"),
    [
        (["titel"], "x", "unknown key 'titel'; did you mean 'title'?"),
        (["title"], None, "the key 'title' is missing"),
        (["questions", "spread", "ask"], "asymptotic_varience", "'asymptotic_variance'?"),
        (["questions", "spread", "tool"], 1, "unknown key 'tool' in 'questions.spread'; did"),
        (["questions", "crossing", "horizons"], None, "the key 'horizons' is missing in"),
        (["scenes", "weak", "dampling"], 1, "'scenes.weak': unknown key 'dampling'; did you mean"),
        (["scenes", "weak", "damping"], -1, "'scenes.weak': 'damping' = -1: must be"),
        (["scenes", "weak", "observable"], "y +", "'scenes.weak.observable': cannot read"),
        (["scenes"], "rows.txt", "'scenes' = 'rows.txt': must end with .csv"),
        (["scenes"], "rows.csv", "'scenes' = 'rows.csv' cannot be read (No such file or"),
        (["sweep"], {"damping": [1]}, "'scenes' and 'sweep' are both given"),
        (["questions", "crossing", "tol"], -1, "'questions.crossing.tol' = -1, of 'scenes.weak': "),
        (["questions", "crossing", "method"], "count", "'questions.crossing.method' = 'count'"),
        (["questions", "crossing", "horizons"], [2, 1], "give positive numbers that increase"),
        (["questions", "spread", "method"], "corrected", "'questions.spread.method' = 'corrected'"),
        (["questions", "rate"], {"ask": "hazard_rate", "threshold": [1, 2, 3], "horizons": [1]},
         "'questions.rate.threshold' = [1, 2, 3], of 'scenes.weak': threshold is [1, 2, 3]; give"),
        (["scenes"], {"a" * 201: {}}, "must have at most 100 characters"),
        (["scenes", "heavy"], {"mass": "1 kg"}, "'ground_spectral_density' is missing"),
    ],
)  # fmt: skip
def test_bad_study(keys, value, message):
    """Refused with its key."""
    assert message in refused(SOUND, keys, value)


@pytest.mark.parametrize(
    ("keys", "value", "message"),
    [
        (["base", "mass"], "10", "'10' has no unit; write such as '2 kg'"),
        (["base", "mass"], "10 m", "'10 m' is no quantity in kg"),
        (["base", "damping"], None, "of 'damping' and 'damping_ratio' there are none"),
        (["base", "damping_ratio"], 0.1, "there are both"),
        (["base", "ground_frequency"], "3 Hz", "'ground_damping_ratio' is missing"),
        (["scenes", "weak", "gap"], "2 mm", "'gap' is of the model 'obstacle'"),
        (["scenes", "weak", "slip_force"], None, "'slip_force' is missing: the model 'friction'"),
        (["questions", "crossing", "threshold"], "5 s", "'questions.crossing'"),
        (["questions", "crossing", "threshold"], 5, "has no unit; write such as '2 m'"),
        (
            ["questions", "crossing", "envelope"],
            "exp(-2t)",
            "'questions.crossing', of 'scenes.weak",
        ),
        # in the user's time: 0 after half of 2 s
        (["questions", "crossing", "envelope"], "1 - t", "'1 - t' is -0.00"),
        (["questions", "crossing", "envelope"], 2, "cannot read the formula 2: it is not text"),
    ],
)
def test_bad_study_in_si_units(keys, value, message):
    """Refused with its key, in the units that are wanted."""
    assert message in refused(IN_SI, keys, value)


@pytest.mark.parametrize("path", sorted(ROOT.glob("studies/*.yaml")), ids=lambda path: path.stem)
def test_the_studies_that_come_along_are_sound(path):
    """Each of them."""
    require_sound(Study.of_file(path))


def test_sizes_without_end_are_refused():
    """Before anything runs, with the hours that they would take."""
    size = {"method": "monte_carlo", "paths": 10**15, "step": 0.1}
    question = SOUND["questions"]["crossing"] | size
    message = refused(SOUND, ["questions", "crossing"], question)
    assert "'questions.crossing.paths' = 1000000000000000" in message
    assert "hours" in message


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("name,n\na,[1\n", "line 2: the cell '[1' is no value of YAML"),
        ("name,n\na,!!python/name:os.system\n", "is no value of YAML"),
        ("name,n,n\na,1,2\n", "has the column 'n' twice"),
    ],
)
def test_a_bad_table(tmp_path, rows, message):
    """Refused with its file and line; nothing in it is run."""
    (tmp_path / "rows.csv").write_text(rows)
    with pytest.raises(ConfigError, match=r"rows\.csv") as caught:
        require_sound(Study("mine", SOUND | {"scenes": "rows.csv"}, tmp_path))
    assert message in str(caught.value)
