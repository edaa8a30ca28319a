"""What is asked of a study before anything runs."""

import difflib
import math
import re
import warnings
from pathlib import Path

import numpy as np

from nonsmooth.errors import NonsmoothError, ToleranceError, quoted
from nonsmooth.paths.absorption.envelope import squares
from nonsmooth.progress import bar
from reproduction.configuration.schema import read_schema, shown, validate
from reproduction.errors import ConfigError, dotted
from studies.answers import arguments, meanings, rehearse
from studies.questions import QUESTIONS, TIME
from studies.scenes import is_structure, scene_of
from studies.study import Study

SCHEMA = Path(__file__).parents[2] / "workflow" / "schemas" / "study.schema.yaml"
MOST_SCENES = 100_000
ENVELOPE_POINTS = 500
LONGEST_NAME = 200  # bytes of a name of a file, with its ending
REHEARSED = 50  # scenes of which every question is tried


def require_sound(study: Study) -> None:
    """Refuse a study that cannot be computed.

    Parameters
    ----------
    study : Study

    Raises
    ------
    ConfigError
        One line with the key, its value and the cure; the caller puts the file before it.
    """
    validate(study.content, read_schema(SCHEMA))
    if "scenes" in study.content and study.axes:
        raise ConfigError("'scenes' and 'sweep' are both given; delete one of the two")
    if not {"scenes", "sweep", "base"} & study.content.keys():
        raise ConfigError("the study has no scenes; add 'base', 'scenes' or 'sweep'")
    count = math.prod(map(len, study.axes.values()))
    if count > MOST_SCENES:
        raise ConfigError(
            f"'sweep' makes {count} scenes, more than {MOST_SCENES}; leave out values"
        )
    for name in study.scenes:
        if len(name) > LONGEST_NAME:
            raise ConfigError(
                f"the name {shown(name)} of a scene has more than {LONGEST_NAME} characters; "
                "shorten it, or give a sweep fewer parameters and shorter values"
            )
    if study.axes and len(study.scenes) < count:
        raise ConfigError("'sweep' names two scenes alike; give values that differ as texts")
    for name, question in study.questions.items():
        _check_question(name, question)
    if not study.has_pages:
        for name, question in study.questions.items():
            if question["ask"] == "invariant_density":
                raise ConfigError(
                    f"'questions.{name}.ask' = 'invariant_density' needs a page for each scene; "
                    "ask it in a study of fewer scenes, with batch: 1"
                )
    kinds = set()
    for name, parameters in study.scenes.items():
        _check_scene(study, name, parameters)
        kinds.add(is_structure(parameters))
    if len(kinds) > 1:
        raise ConfigError(
            "some scenes are in SI units and others are dimensionless; make two studies of them"
        )
    _check_meaning(study)


def _check_question(name, question):
    key = ("questions", name)
    if question["ask"] not in QUESTIONS:
        near = difflib.get_close_matches(question["ask"], QUESTIONS, n=1)
        cure = f"did you mean {near[0]!r}?" if near else f"choose from {', '.join(QUESTIONS)}"
        raise ConfigError(f"{dotted((*key, 'ask'))} = {shown(question['ask'])}: {cure}", key=key)
    asked = QUESTIONS[question["ask"]]
    for argument in question:
        if argument not in {"ask", *asked.arguments}:
            near = difflib.get_close_matches(argument, asked.arguments, n=1)
            cure = (
                f"did you mean {near[0]!r}?"
                if near
                else f"{question['ask']} takes {', '.join(asked.arguments)}"
            )
            raise ConfigError(f"unknown key {argument!r} in {dotted(key)}; {cure}", key=key)
    for argument in asked.required:
        if argument not in question:
            raise ConfigError(
                f"the key {argument!r} is missing in {dotted(key)}; {question['ask']} needs it",
                key=key,
            )


def _check_scene(study, name, parameters):
    """Compare the keys of a scene with the schema of its kind."""
    definitions = read_schema(SCHEMA)["$defs"]
    kind = "system" if is_structure(parameters) else "scene"
    try:
        validate(parameters, definitions[kind] | {"$defs": definitions})
    except ConfigError as error:
        raise _located(study, name, error) from None


def _check_meaning(study):
    """Make every scene once, or of a sweep its corners, and read all quantities."""
    examples = _examples(study)
    with bar("checking scenes", len(examples)) as advance:
        for number, (name, parameters) in enumerate(examples):
            _check_example(study, name, parameters, number < REHEARSED)
            advance(1)


def _check_example(study, name, parameters, rehearsed):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            thing, units = scene_of(parameters, study.units)
    except NonsmoothError as error:
        raise _located(study, name, error, parameters) from None
    for question_name, question in study.questions.items():
        try:
            given = arguments(question, units, meanings(question, parameters))
            _check_envelope(question, given, units)
            if rehearsed:
                rehearse(thing, question, given)
        except ToleranceError as error:
            if error.result is None:
                raise _about(question_name, question, name, error) from None
        except NonsmoothError as error:
            raise _about(question_name, question, name, error) from None


def _about(name, question, scene, error):
    """Put before an error the argument that it is about, as the study gives it."""
    text = str(error)
    words = re.findall("[a-z]+", text)
    blamed = [word for word in words if word in question.keys() - {"ask"}]
    key = ("questions", name, *blamed[:1])
    value = f" = {shown(question[blamed[0]])}" if blamed else ""
    return ConfigError(f"{dotted(key)}{value}, of {dotted(('scenes', scene))}: {text}", key=key)


def _check_envelope(question, given, units):
    """Evaluate an envelope at many of the user's times up to the last one."""
    if "envelope" not in question:
        return
    try:
        times = given["horizons"] if "horizons" in given else given["times"]
        last = float(np.max(times)) * float(given.get("p", 1.0))
    except (TypeError, ValueError):  # is refused by the question itself
        return
    places = (np.arange(ENVELOPE_POINTS) + 0.5) / ENVELOPE_POINTS
    squares(question["envelope"], last * units.factor(TIME) * places)


def _examples(study):
    """Scenes in which every value of a sweep occurs; all scenes if there is no sweep."""
    if not study.axes:
        return list(study.scenes.items())
    names = list(study.scenes)
    first = {axis: values[0] for axis, values in study.axes.items()}
    wanted = [first | {axis: value} for axis, values in study.axes.items() for value in values]
    base = study.content.get("base", {})
    return [(names[0] if point == first else str(point), base | point) for point in wanted]


def _located(study, name, error, parameters=None):
    """Put before an error its scene, and the parameter whose value it quotes."""
    key = ("sweep",) if study.axes else ("scenes", name)
    for parameter, value in (parameters or {}).items():
        if isinstance(value, str) and quoted(value)[1:41] in str(error):
            key = (*key, parameter)
            break
    return ConfigError(f"{dotted(key)}: {error}", key=key)
