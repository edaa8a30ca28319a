"""The record of a run: every number of the paper with its error, and checksums of the artifacts."""

import csv
import hashlib
import json
import re
from dataclasses import asdict, dataclass
from pathlib import Path

from reproduction.errors import ArtifactError
from reproduction.jobs import artifact
from reproduction.jobs.files import write_whole
from reproduction.rendering.quoted import BOUND, EFFECTIVE, ERROR, INTERVAL, STANDARD

ON_DEMAND = {"speed_against_error", "hard_cases"}  # topics that are not part of the paper's run
# a column of a table with one of these endings is the error of the column without it
ERRORS = {"_standard_error": STANDARD, "_half_interval": INTERVAL, "_error": BOUND}
SEED = re.compile(r"\bseed=\d+")


@dataclass(frozen=True)
class Number:
    """A computed number.

    Attributes
    ----------
    value, error : float
    kind : str
        What the error is, see `reproduction.rendering.quoted`.
    """

    value: float
    error: float
    kind: str


@dataclass(frozen=True)
class Record:
    """A run.

    Attributes
    ----------
    seed : str
    sections : dict
        Table, or section of the text -> name -> `Number`, or a string, which is a text, a count or
        a parameter.
    artifacts : dict
        Path in the folder of results -> ``sha256`` of the file and of the ``parameters`` that it
        was made with, the seed left out.
    """

    seed: str
    sections: dict[str, dict[str, Number | str]]
    artifacts: dict[str, dict[str, str]]


def gather(results: Path) -> Record:
    """Collect the record of a finished run.

    Parameters
    ----------
    results : Path
        Folder of the results.

    Returns
    -------
    Record

    Raises
    ------
    ArtifactError
        If there is no finished run.
    """
    text = _sections_of_the_text(results / "paper" / "numbers.json")
    seed = str(text.pop("text: seed")["seed"])
    tables = {
        path.stem: _numbers_of_a_table(path)
        for path in (results / "tables").glob("table_*.csv")
        if path.stem.removeprefix("table_") not in ON_DEMAND
    }
    return Record(seed, tables | text, _artifacts(results))


def write(record: Record, path: Path) -> None:
    """Write a record, sorted, with one line for each value."""
    content = json.dumps(asdict(record), indent=1, sort_keys=True, ensure_ascii=False)
    write_whole(path, f"{content}\n".encode())


def read(path: Path) -> Record:
    """Read a record.

    Raises
    ------
    ArtifactError
        If it is missing or not a record.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        sections = {
            section: {
                name: Number(**entry) if isinstance(entry, dict) else entry
                for name, entry in entries.items()
            }
            for section, entries in content["sections"].items()
        }
        return Record(content["seed"], sections, content["artifacts"])
    except (OSError, ValueError, KeyError, TypeError):
        raise ArtifactError(
            f"{path} is not the record of a run; restore it with git, or make it with make publish"
        ) from None


def _sections_of_the_text(path):
    if not path.exists():
        raise ArtifactError(f"{path} does not exist; run make paper first")
    sections: dict[str, dict] = {}
    for name, entry in json.loads(path.read_text(encoding="utf-8")).items():
        section, _, rest = name.partition(".")
        if isinstance(entry, dict):
            entry = Number(**{key: entry[key] for key in ("value", "error", "kind")})
        sections.setdefault(f"text: {section}", {})[rest or section] = entry
    return sections


def _numbers_of_a_table(path):
    """Entries by row and column; empty cells are left out."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    errors = {
        column: (column + ending, kind)
        for column in rows[0]
        for ending, kind in ERRORS.items()
        if column + ending in rows[0]
    }
    # the error of an error is none
    errors = {column: known for column, known in errors.items() if not _is_error(column, rows[0])}
    entries: dict[str, Number | str] = {}
    for number, row in enumerate(rows, 1):
        for column, cell in row.items():
            if cell == "" or _is_error(column, rows[0]):
                continue
            if column in errors:
                name, kind = errors[column]
                entry = Number(float(cell), float(row[name]), kind)
            elif column == "standard_error":
                entry = Number(float(cell), 0.0, ERROR)
            elif column.startswith("effective_"):
                entry = Number(float(cell), 0.0, EFFECTIVE)
            else:
                entry = cell
            entries[f"row {number}, {column}"] = entry
    return entries


def _is_error(column, columns):
    return any(
        column.endswith(ending) and column.removesuffix(ending) in columns for ending in ERRORS
    )


def _artifacts(results):
    """Checksums of the artifacts, without those of other runs in folders of this one."""
    others = ON_DEMAND | {folder.parent.name for folder in results.glob("*/logs")}
    found = {}
    for path in sorted(results.rglob("*.nc")):
        name = path.relative_to(results)
        if name.parts[0] not in others:
            made = artifact.read(path).attrs["history"].splitlines()[-1].partition(";")[0]
            found[name.as_posix()] = {
                "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
                "parameters": hashlib.sha256(SEED.sub("seed", made).encode()).hexdigest(),
            }
    return found
