"""Answers: what the library returns, as datasets in the user's units."""

import hashlib
import json
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from nonsmooth.checks import require_count, require_increasing, require_positive
from nonsmooth.errors import AccuracyWarning, ToleranceError
from nonsmooth.estimate import Estimate
from nonsmooth.paths.cost import require_time
from nonsmooth.paths.sampling import Sampling
from nonsmooth.progress import rehearsal
from nonsmooth.scenes.scene import Scene
from reproduction.errors import ArtifactError
from reproduction.jobs import artifact
from studies.questions import INTEGRAL, OF_TIME, PLAIN, QUESTIONS, VARIABLES
from studies.scenes import observed, scene_of
from studies.units import Powers, Units


def answer(
    scene: Mapping[str, Any],
    question: Mapping[str, Any],
    units: Mapping[str, str],
    seed: int,
    threads: int = 1,
) -> xr.Dataset:
    """Answer a question about a scene.

    Parameters
    ----------
    scene, question : mapping
        As in a study.
    units : mapping
        The user's units, for scenes in SI units.
    seed : int
    threads : int

    Returns
    -------
    xarray.Dataset
        The first variable of the question has the method as an attribute, and, where the accuracy
        asked for or aimed at was missed, what was said about that as a comment.
    """
    thing, ruler = scene_of(scene, units)
    asked = QUESTIONS[question["ask"]]
    known = meanings(question, scene)
    given = arguments(question, ruler, known)
    if asked.sampled:
        given |= {"seed": (seed, "study"), "threads": threads}
    found, remark = _best(asked, thing, given)
    return _described(found, asked, ruler, known, f"{thing}, {dict(question)}", remark)


def rehearse(thing: Scene, question: Mapping[str, Any], given: Mapping[str, Any]) -> None:
    """Raise what the library refuses before it computes an answer.

    Parameters
    ----------
    thing : Scene
    question : mapping
    given : mapping
        See `arguments`.

    Raises
    ------
    NonsmoothError
        If an argument or the scene is none that the question takes, or it would take too long.
    """
    with rehearsal(), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if {"step", "paths"} <= given.keys():
            last = np.max(require_increasing("horizons", given.get("horizons", 1.0)))
            last *= require_positive("p", given.get("p", 1.0))
            step = require_positive("step", given["step"])
            require_time(last / step, Sampling(step, require_count("paths", given["paths"]), 0))
        QUESTIONS[question["ask"]].solve(thing, **given)


def meanings(question: Mapping[str, Any], scene: Mapping[str, Any]) -> dict[str, Powers]:
    """Return what the observable, variable and parameter of a question are in base quantities."""
    g = observed(scene)
    # the other parameters are dimensionless, also those of a structure
    by_threshold = question.get("parameter") == "threshold"
    return {
        "g": g,
        "variable": VARIABLES.get(question.get("variable", ""), PLAIN),
        "parameter": resolved(INTEGRAL, {"g": g}) if by_threshold else PLAIN,
    }


def arguments(
    question: Mapping[str, Any], units: Units, known: Mapping[str, Powers]
) -> dict[str, Any]:
    """Return the arguments of a question as numbers of the scene.

    Parameters
    ----------
    question : mapping
    units : Units
    known : mapping
        See `meanings`.

    Raises
    ------
    ConfigError, ExpressionError
        If a quantity or a formula cannot be read.
    """
    kinds = QUESTIONS[question["ask"]].arguments

    def read(name, value):
        kind = kinds[name]
        if isinstance(kind, str):
            assert kind == OF_TIME
            return units.formula_of_time(value)
        return value if kind == PLAIN else units.number(value, resolved(kind, known))

    return {name: read(name, value) for name, value in question.items() if name != "ask"}


def resolved(powers: Powers, known: Mapping[str, Powers]) -> dict[str, int]:
    """Put powers of the base quantities in the place of ``"g"`` and ``"variable"``."""
    total: dict[str, int] = {}
    for name, power in powers.items():
        for base, inner in known.get(name, {name: 1}).items():
            total[base] = total.get(base, 0) + power * inner
    return {base: power for base, power in total.items() if power}


def _best(asked, scene, given):
    """Return the answer and a remark, which says by how much a tolerance was missed."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", AccuracyWarning)
        try:
            found = asked.solve(scene, **given)
        except ToleranceError as error:
            if error.result is None:
                raise
            return asked.turned(error.result), str(error)
    return asked.turned(found), "; ".join(str(warning.message) for warning in caught)


def _described(found, asked, units, known, summary, remark):
    if isinstance(found, Estimate):
        name = next(iter(asked.values))
        own = xr.Dataset({name: found.value, f"{name}_error": found.error})
        own.attrs["method"] = found.method
        found = own
    variables = {}
    for name in found.variables:
        powers, text = _meaning(str(name), asked)
        powers = resolved(powers, known)
        # some errors are one for all values
        whole = str(name).removesuffix("_error")
        values = found[name].broadcast_like(found[whole]) if whole in found else found[name]
        attrs = {"long_name": text, "units": units.unit(powers)}
        variables[name] = (values.dims, values.values * units.factor(powers), attrs)
    result = xr.Dataset(variables).set_coords(list(found.coords))
    first = next(name for name in asked.values if name in result.data_vars)
    result[first].attrs["method"] = found.attrs.get("method", "deterministic")
    if remark:
        result[first].attrs["comment"] = remark
    result.attrs = {"title": asked.title, "summary": summary}
    return _with_infinities(result)


def _with_infinities(data):
    """Say what infinite values mean, where there are some."""
    for variable in data.data_vars.values():
        if np.isinf(variable).any():
            variable.attrs["infinite"] = "where nothing more is known"
    return data


def _meaning(name, asked):
    if name in asked.values:
        return asked.values[name]
    whole = name.removesuffix("_error")
    if whole != name and whole in asked.values:
        powers, text = asked.values[whole]
        return powers, f"error of: {text}"
    return PLAIN, name.replace("_", " ")


def answer_batch(
    scenes: Mapping[str, Mapping[str, Any]],
    question: Mapping[str, Any],
    units: Mapping[str, str],
    seed: int,
    store: str | Path,
    sources: Sequence[str],
    threads: int = 1,
) -> xr.Dataset:
    """Answer a question about many scenes, each of which is computed once.

    Parameters
    ----------
    scenes : mapping
        From names to scenes.
    question, units, seed, threads
        As for `answer`.
    store : str or Path
        Folder in which answers are kept, by what they depend on.
    sources : sequence of str
        Files on which answers depend besides.

    Returns
    -------
    xarray.Dataset
        Over `scene`, the position among the scenes.
    """
    code = hashlib.sha256(b"".join(Path(path).read_bytes() for path in sorted(sources)))
    found = []
    for scene in scenes.values():
        parameters = {"scene": scene, "question": question, "units": units, "seed": seed}
        key = code.copy()
        key.update(json.dumps(parameters, sort_keys=True).encode())
        found.append(_kept(Path(store) / f"{key.hexdigest()[:32]}.nc", parameters, threads))
    merged = joined(found)
    position = {"long_name": "position of the scene in the batch", "units": "1"}
    merged = merged.assign_coords(scene=("scene", np.arange(len(found)), position))
    first = next(name for name in QUESTIONS[question["ask"]].values if name in merged.data_vars)
    methods = {data[first].attrs["method"] for data in found}
    merged[first].attrs["method"] = ", ".join(sorted(methods))
    merged.attrs["summary"] = f"{len(found)} scenes: {', '.join(scenes)}"
    return _with_infinities(merged)


def joined(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Put answers to one question after each other, over `scene`; each has one scene or many."""
    return xr.concat(
        parts, "scene", data_vars="all", coords="minimal", compat="override", join="override",
        combine_attrs="override",
    )  # fmt: skip


def _kept(path, parameters, threads):
    try:
        return artifact.read(path)
    except ArtifactError:
        result = answer(**parameters, threads=threads)
        artifact.write(result, path, artifact.provenance("study_batch", parameters))
        return artifact.read(path)
