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
        (["scenes", "weak", "observable"], "y +", "'scenes.weak': cannot read the formula"),
        (["scenes"], "rows.txt", "'scenes' = 'rows.txt': must end with .csv"),
        (["scenes"], "rows.csv", "rows.csv: cannot be read (No such file or directory)"),
        (["sweep"], {"damping": [1]}, "'scenes' and 'sweep' are both given"),
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
