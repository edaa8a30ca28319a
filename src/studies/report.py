"""The report of a study: what it shows, once as HTML in one file and once as PDF."""

import base64
import json
import math
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jinja2
import matplotlib as mpl
import numpy as np
import tylax
import typst
import xarray as xr

import nonsmooth
from reproduction.errors import ArtifactError
from reproduction.jobs import artifact
from studies import drawing, equations, figures
from studies.questions import QUESTIONS
from studies.scenes import is_structure, scene_of, structure_of
from studies.study import Study
from studies.surveys import seconds_of, survey
from studies.units import pretty, readable, spelt, told

_SYMBOLS = {"friction": "$F_s$", "elasto_plastic": "$F_y$", "obstacle": "$d$"}


def contents(study: Study, results: str | Path) -> dict[str, Any]:
    """Collect what a report shows.

    Parameters
    ----------
    study : Study
    results : str or Path
        Folder of the results.

    Returns
    -------
    dict
        Texts, and figures as SVG.
    """
    folder = Path(results) / "studies" / study.name
    timings = Path(results) / "benchmarks" / "studies" / study.name
    with mpl.rc_context(drawing.STYLE):
        found = {
            "title": study.title,
            "summary": study.content.get("summary", ""),
            "name": study.name,
            "version": nonsmooth.__version__,
            "seed": study.seed,
            "count": len(study.scenes),
            "pages": [],
            "surveys": [],
            "system_of": {},
        }
        if study.has_pages:
            found["pages"] = [
                _page(study, name, parameters, folder, timings)
                for name, parameters in study.scenes.items()
            ]
        else:
            found["system_of"] = _system(next(iter(study.scenes.values())), study)
            found["surveys"] = [survey(study, name, folder, timings) for name in study.questions]
    return found


def _page(study, name, parameters, folder, timings):
    answers = [
        _answer(question, study.questions[question], folder / name / f"{question}.nc",
                timings / name / f"{question}.tsv")
        for question in study.questions
    ]  # fmt: skip
    return {"name": name, "answers": answers, **_system(parameters, study)}


def _system(parameters, study):
    scene, units = scene_of(parameters, study.units)
    varied = dict.fromkeys(study.axes, "varied")
    given = [(key.replace("_", " "), told(value)) for key, value in (parameters | varied).items()]
    derived = []
    if is_structure(parameters):
        structure = structure_of(parameters)
        laws = equations.of_structure(structure, scene.n)
        derived = [
            (f"unit of {name}", f"{float(f'{value:.4g}'):g} {unit}")  # 40000, not 4e+04
            for name, value, unit in (
                ("length L", units.scales.length, "m"),
                ("time T", units.scales.time, "s"),
                ("force", units.scales.force, "N"),
            )
        ]
    else:
        laws = []
    scaled = [
        ("n", "∞" if math.isinf(scene.n) else f"{scene.n:.6g}"),
        ("C_b", f"{scene.damping:.4g}"),
        ("noise intensity σ", f"{scene.noise.sigma:.4g}"),
        ("U", scene.potential),
        ("observable g", scene.observable),
        ("state", ", ".join(scene.state)),
    ]
    limit = _SYMBOLS[scene.mechanics.name]
    return {
        "drawing": drawing.as_svg(drawing.drawn(scene, limit)),
        "title": scene.mechanics.title,
        "laws": _spelt_laws(laws),
        "dimensionless": _spelt_laws(equations.of_scene(scene)),
        "given": given,
        "scaled": [] if study.axes else derived + scaled,
    }


def _spelt_laws(laws):
    return [{"latex": law, "typst": tylax.latex_to_typst(law)} for law in laws]


def _answer(name, question, path, timing):
    asked, data = QUESTIONS[question["ask"]], artifact.read(path)
    first = next(key for key in asked.values if key in data.data_vars)
    content = path.read_bytes()
    return {
        "name": name,
        "title": asked.title,
        "asked": told(question),
        "numbers": _numbers(data, asked),
        "table": _table(data, asked),
        "figures": [drawing.as_svg(figure) for figure in figures.of_answer(data, asked)],
        "method": data[first].attrs.get("method", ""),
        "remark": data[first].attrs.get("comment", ""),
        "seconds": seconds_of(timing),
        "file": str(Path(*path.parts[-2:])),
        "download": f"{path.parent.name}-{path.name}",
        "data": base64.b64encode(content).decode(),
    }


def _numbers(data, asked):
    """Spell values without dimensions, each with its error."""
    return [
        (
            readable(data[name].attrs["long_name"]),
            spelt(
                float(data[name]),
                float(data[f"{name}_error"]),
                data[name].attrs["units"],
                tuple(map(float, figures.limits(data, name))),
            ),
        )
        for name in asked.values
        if name in data.data_vars and data[name].ndim == 0
    ]


def _table(data: xr.Dataset, asked):
    """Spell curves as a table, unless they are densities."""
    names = [
        name for name in asked.values
        if name in data.data_vars and data[name].ndim > 0 and f"{name}_error" in data
        and not name.startswith("density_")
    ]  # fmt: skip
    if not names:
        return {}
    over = data[data[names[0]].dims[-1]]
    columns, head = [], [_headed(over.name, over)]
    for name in names:
        shown = data[name], data[f"{name}_error"], *figures.limits(data, name)
        curves = (np.atleast_2d(part.values) for part in shown)
        head += figures.levels(data, name) or [_headed(name, data[name])]
        columns += [
            [spelt(v, e, limits=(low, high)) for v, e, low, high in zip(*curve, strict=True)]
            for curve in zip(*curves, strict=True)
        ]
    rows = [[f"{float(over[k]):.6g}", *(c[k] for c in columns)] for k in range(over.size)]
    return {"head": head, "rows": rows}


def _headed(name, variable):
    name, unit = str(name).replace("_", " "), pretty(variable.attrs["units"])
    return f"{name}, {unit}" if unit else name


def as_html(content: Mapping[str, Any], template: str | Path) -> bytes:
    """Render a report as one file of HTML that needs no other.

    Parameters
    ----------
    content : mapping
        See `contents`.
    template : str or Path
        Of jinja2.
    """
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["equations"] = _equations_svg
    text = environment.from_string(Path(template).read_text(encoding="utf-8")).render(**content)
    return text.encode()


def _equations_svg(laws):
    """Typeset equations as one SVG, which every browser shows alike."""
    lines = " \\ ".join(f"&{law['typst']}" for law in laws)
    source = (
        "#set page(width: auto, height: auto, margin: 3pt, fill: none)\n"
        f'#set text(font: "New Computer Modern", size: 12pt)\n$ {lines} $'
    )
    text = _compiled(source.encode(), "svg").decode()
    return text[text.index("<svg") :]


def as_pdf(content: Mapping[str, Any], template: str | Path) -> bytes:
    """Typeset a report.

    Parameters
    ----------
    content : mapping
        See `contents`.
    template : str or Path
        Of typst; it reads report.json beside it.
    """
    with tempfile.TemporaryDirectory() as folder:
        main = Path(folder) / "report.typ"
        main.write_bytes(Path(template).read_bytes())
        plain = json.dumps(content, default=str)
        (Path(folder) / "report.json").write_text(plain, encoding="utf-8")
        return _compiled(main, "pdf", root=folder)


def _compiled(source, form, **options):
    try:
        return typst.compile(source, format=form, ignore_system_fonts=True, **options)
    except typst.TypstError as error:
        raise ArtifactError(f"a report does not compile: {error}; mend its template") from None
