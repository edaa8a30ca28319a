"""A study as the rules see it: scenes by name, questions, and which scenes share a job."""

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from math import ceil
from pathlib import Path
from typing import Any

import yaml

from reproduction.configuration.files import read
from reproduction.configuration.schema import shown
from reproduction.errors import ConfigError

BATCH = 50  # scenes of a sweep that share a job, so that starting it takes less than its work
PAGES = 24  # scenes up to which a report has a page for each


@dataclass(frozen=True)
class Study:
    """A table of scenes and questions.

    Parameters
    ----------
    name : str
    content : dict
        What the file says, valid by the schema of studies.
    folder : Path
        Where the file of its scenes is looked for.
    """

    name: str
    content: Mapping[str, Any]
    folder: Path = field(default_factory=Path)

    @classmethod
    def of_file(cls, path: str | Path) -> "Study":
        """Read a study; it is not checked.

        Raises
        ------
        ConfigError
            If the file cannot be read.
        """
        path = Path(path)
        return cls(path.stem, read(path), path.parent)

    @property
    def title(self) -> str:
        """Heading of the report."""
        return self.content["title"]

    @property
    def seed(self) -> int:
        """Seed of every random stream."""
        return self.content.get("seed", 0)

    @property
    def units(self) -> dict[str, str]:
        """The user's units."""
        return self.content.get("units", {})

    @property
    def questions(self) -> dict[str, dict]:
        """Questions by name."""
        return self.content["questions"]

    @property
    def axes(self) -> dict[str, list]:
        """Values of the parameters that a sweep changes; empty if there is none."""
        return self.content.get("sweep", {})

    @cached_property
    def scenes(self) -> dict[str, dict]:
        """Parameters of every scene by its name, in the order of the study."""
        base, scenes = self.content.get("base", {}), self.content.get("scenes")
        if self.axes:
            points = [
                dict(zip(self.axes, point, strict=True)) for point in product(*self.axes.values())
            ]
            return {label(point): base | point for point in points}
        if scenes is None:
            return {self.name: base}
        if isinstance(scenes, str):
            scenes = self._table(scenes)
        return {name: base | own for name, own in scenes.items()}

    def _table(self, name):
        """Read a CSV file of scenes; its cells are read like values of the study itself."""
        path = self.folder / name
        try:
            with open(path, encoding="utf-8-sig", newline="") as file:
                table = csv.DictReader(file, skipinitialspace=True)
                rows, names = list(table), table.fieldnames or []
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            reason = getattr(error, "strerror", None) or error
            raise ConfigError(
                f"'scenes' = {shown(name)} cannot be read ({reason}); name a CSV file in UTF-8"
            ) from None
        if "name" not in names:
            raise ConfigError("has no column 'name'; add it, and separate cells by commas", path)
        if doubled := {name for name in names if names.count(name) > 1}:
            raise ConfigError(f"has the column {min(doubled)!r} twice; delete one of the two", path)
        found = {}
        for number, row in enumerate(rows, start=2):
            key = (row.get("name") or "").strip()
            if None in row or None in row.values():
                raise ConfigError(f"line {number} has not as many cells as line 1; mend it", path)
            if not re.fullmatch(r"[a-z0-9_]+", key):
                raise ConfigError(
                    f"line {number}: the name {key!r} must be lower-case letters, digits and "
                    "underscores; write one in the column 'name'",
                    path,
                )
            if key in found:
                raise ConfigError(f"line {number}: the name {key!r} is taken; choose another", path)
            cells = {name: cell.strip() for name, cell in row.items() if name != "name"}
            found[key] = {name: _value(cell, number, path) for name, cell in cells.items() if cell}
        if not found:
            raise ConfigError("has no scenes; write a line with names of columns, and more", path)
        return found

    @property
    def has_pages(self) -> bool:
        """Whether the report has a page for each scene."""
        return self.batch == 1 and len(self.scenes) <= PAGES

    @property
    def batch(self) -> int:
        """Number of scenes that share a job."""
        return self.content.get("batch", BATCH if self.axes else 1)

    @property
    def batches(self) -> list[int]:
        """Numbers of the batches."""
        return list(range(ceil(len(self.scenes) / self.batch)))

    def of_batch(self, number: int) -> dict[str, dict]:
        """Return the scenes of a batch by name."""
        first = number * self.batch
        return dict(list(self.scenes.items())[first : first + self.batch])

    def artifacts(self, question: str) -> list[str]:
        """Name the artifacts of a question, relative to the folder of the study."""
        if self.batch == 1:
            return [f"{name}/{question}.nc" for name in self.scenes]
        return [f"batches/{question}/{number}.nc" for number in self.batches]


def _value(cell, number, path):
    """Read a cell as a value of YAML."""
    try:
        return yaml.safe_load(cell)
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError):
        raise ConfigError(
            f"line {number}: the cell {shown(cell)} is no value of YAML; mend or quote it", path
        ) from None


def label(point: Mapping[str, Any]) -> str:
    """Name a scene of a sweep after its parameters, as files may be named."""
    text = ",".join(f"{name}={value}" for name, value in point.items())
    return re.sub(r"[^A-Za-z0-9_.,=+-]+", "_", text)
