"""Tables in three forms from one content: CSV for computing, LaTeX and Typst for reading.

Cells are LaTeX, with mathematics between dollar signs.
"""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, SupportsFloat

import pandas as pd
import tylax
import xarray as xr

from reproduction.jobs.files import write_whole
from reproduction.jobs.job import Task, inputs, job

if TYPE_CHECKING:  # most tables are made without the formulas of scenes
    from nonsmooth.scenes.scene import Scene


def typeset(build: Callable, task: Task) -> None:
    """Run a task whose outputs are one table as .csv, .tex and .typ.

    Parameters
    ----------
    build : callable
        Takes the task's input artifacts and parameters by name; returns two pandas.DataFrame, the
        table of plain numbers for the CSV file and the table of cells for reading.
    task : Task
    """
    with job(task):
        plain, cells = build(**inputs(task), **dict(task.params.items()))
        render = {
            ".csv": lambda: plain.to_csv(index=False),
            ".tex": lambda: latex(cells),
            ".typ": lambda: typst(cells),
        }
        for path in map(Path, task.output):
            write_whole(path, render[path.suffix]().encode())


def latex(cells: pd.DataFrame) -> str:
    """Return a booktabs tabular."""
    return cells.to_latex(index=False, escape=False, column_format="l" * len(cells.columns))


def typst(cells: pd.DataFrame) -> str:
    """Return a Typst table with three rules, as booktabs has them.

    ``cells.attrs["widths"]`` are Typst's widths of the columns, where text has to be broken.
    """
    widths = cells.attrs.get("widths")
    columns = f"({', '.join(widths)})" if widths else len(cells.columns)
    header = ", ".join(f"[{_typst(str(name))}]" for name in cells.columns)
    rows = "".join(
        "  " + ", ".join(f"[{_typst(str(cell))}]" for cell in row) + ",\n"
        for row in cells.itertuples(index=False)
    )
    return (
        f"#table(\n  columns: {columns},\n  table.hline(),\n"
        f"  table.header({header}),\n  table.hline(stroke: 0.4pt),\n{rows}  table.hline(),\n)\n"
    )


def _typst(cell):
    parts = cell.split("$")
    if len(parts) % 2 == 0:
        raise ValueError(f"unbalanced dollar signs in the cell {cell!r}")
    return "".join(
        f"${tylax.latex_to_typst(part)}$" if k % 2 else part for k, part in enumerate(parts)
    )


def scientific(value: SupportsFloat, digits: int = 1, bound: bool = False) -> str:
    """Spell a number as LaTeX mathematics in scientific notation; a bound is rounded up."""
    value = float(value) * (1 + 10.0**-digits / 2 if bound else 1)
    mantissa, exponent = f"{value:.{digits}e}".split("e")
    return rf"${mantissa} \times 10^{{{int(exponent)}}}$"


def penalization(n: float) -> str:
    """Spell n as LaTeX mathematics."""
    return r"$\infty$" if n == float("inf") else f"${n:g}$"


def symbol(name: str) -> str:
    """Spell a variable, or an observable that is one, as LaTeX mathematics."""
    return f"${name}$" if len(name) == 1 else rf"$\{name}$"


def described(scene: "Scene") -> dict[str, str]:
    """Spell a scene in four cells: its model, noise, state and observable."""
    return {
        "model": scene.mechanics.name.replace("_", "-"),
        "noise": scene.noise.kind,
        "state": ", ".join(map(symbol, scene.state)),
        "$g$": symbol(scene.observable),
    }


def sorted_by(name: str, datasets: Iterable[xr.Dataset]) -> list[xr.Dataset]:
    """Return artifacts in the order of a scalar coordinate."""
    return sorted(datasets, key=lambda dataset: float(dataset[name]))
