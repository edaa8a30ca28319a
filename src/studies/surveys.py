"""What a report shows of many scenes: maps of each answer over the sweep, and its extremes."""

import csv
from pathlib import Path
from typing import Any

import numpy as np

from nonsmooth.errors import NonsmoothError
from reproduction.jobs import artifact
from studies import drawing, figures
from studies.answers import joined
from studies.questions import QUESTIONS
from studies.scenes import QUANTITIES
from studies.study import Study
from studies.units import in_figures, in_si, pretty, readable, spelt, told

SHOWN = 12  # scenes up to which all of them are tabled


def seconds_of(path: str | Path) -> float | None:
    """Read the seconds that a job took from its benchmark file; None if that is gone."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            return float(next(csv.DictReader(file, delimiter="\t"))["s"])
    except (OSError, StopIteration, KeyError, ValueError):
        return None


def survey(study: Study, name: str, folder: Path, timings: Path) -> dict[str, Any]:
    """Collect what is shown of a question over all scenes.

    Parameters
    ----------
    study : Study
    name : str
        Of the question.
    folder, timings : Path
        Where the artifacts of the study and its benchmark files are.

    Returns
    -------
    dict
    """
    asked, question = QUESTIONS[study.questions[name]["ask"]], study.questions[name]
    files = study.artifacts(name)
    found = _merged([artifact.read(folder / file) for file in files])
    seconds = [seconds_of(timings / Path(file).with_suffix(".tsv")) for file in files]
    total = None if None in seconds else sum(filter(None, seconds))
    shown = [key for key in asked.values if key in found and f"{key}_error" in found]
    values = {key: _last(found[key]) for key in shown}
    errors = {key: _last(found[f"{key}_error"]) for key in shown}
    limits = {key: [_last(end) for end in figures.limits(found, key)] for key in shown}
    return {
        "name": name,
        "title": asked.title,
        "asked": told(question),
        "figures": [_map(study, found[key], values[key]) for key in shown if study.axes],
        "table": _extremes(list(study.scenes), values, errors, limits),
        "method": found[shown[0]].attrs["method"],
        "total": total,
        "each": None if total is None else total / len(study.scenes),
        "largest": max(_relative(values[key], errors[key]) for key in shown),
        "files": files,
    }


def _merged(parts):
    """Put the answers of all jobs after each other; a job has one scene or many."""
    parts = [part if "scene" in part.dims else part.expand_dims("scene") for part in parts]
    return joined(parts)


def _last(variable):
    """Take a curve at its end."""
    return variable if variable.ndim == 1 else variable[(slice(None), *[-1] * (variable.ndim - 1))]


def _relative(value, error):
    known = (value.values != 0) & np.isfinite(value.values)
    return float(np.max(error.values[known] / np.abs(value.values[known]), initial=0.0))


def _map(study, variable, values):
    title = readable(variable.attrs["long_name"])
    for dim in variable.dims[1:]:
        title += f", at {dim} = {figures.level(values, dim, pretty)}"
    label = f"{variable.name.replace('_', ' ')}, {in_figures(variable.attrs['units'])}".rstrip(", ")
    numbers = {name: _numbers(name, values) for name, values in study.axes.items()}
    figure = figures.maps(values.values, study.axes, label, numbers)
    return {"title": title, "svg": drawing.as_svg(figure)}


def _numbers(name, values):
    """Return the values of a parameter in SI units, or their positions if they are no numbers."""
    try:
        return [in_si(v, QUANTITIES[name]) if name in QUANTITIES else float(v) for v in values]
    except (TypeError, ValueError, NonsmoothError):
        return list(range(len(values)))


def _extremes(names, values, errors, limits):
    """Table the scenes with the smallest and the largest values, or all if they are few."""
    rows = []
    for key, value in values.items():
        order = [int(k) for k in np.argsort(value.values, kind="stable")]
        picked = order if len(order) <= SHOWN else [*order[:3], *order[-3:]]
        unit = value.attrs["units"]
        rows += [
            [names[k], key.replace("_", " "), spelt(float(value[k]), float(errors[key][k]), unit,
             tuple(float(end[k]) for end in limits[key]))]
            for k in picked
        ]  # fmt: skip
    return {"head": ["scene", "value of", "value"], "rows": rows}
