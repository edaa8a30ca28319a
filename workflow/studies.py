"""The studies that a run is asked for: files of the folder `studies`, or of the configuration."""

import re
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Any

from reproduction.errors import ConfigError
from studies.study import Study
from workflow.dependencies import imported

NAME = "[a-z0-9_]{1,100}"


class Studies:
    """Finds studies by name; a file is read when its study is needed.

    Parameters
    ----------
    own : dict
        Studies in the configuration, by name.
    folder : str
        Where the files of others are.
    """

    def __init__(self, own: dict, folder: str) -> None:
        self.own, self.folder = own, Path(folder)
        found = sorted(own or (path.stem for path in self.folder.glob("*.yaml")))
        self.names = [name for name in found if re.fullmatch(NAME, name)]
        self.misnamed = [name for name in found if name not in self.names]
        self.get = cache(self._get)

    def _get(self, name):
        return Study(name, self.own[name]) if name in self.own else Study.of_file(self.file(name))

    def having(self, attribute: str, wildcard: str | None = None) -> Callable:
        """Return a parameter's function: what a study has, all of it or by a wildcard."""

        def found(wildcards):
            value = getattr(self.get(wildcards.study), attribute)
            return value if wildcard is None else value[wildcards[wildcard]]

        return found

    def modules(self, wildcards: Any) -> list[str]:
        """List the source files of the functions that answer a question."""
        # the units take a second, which other targets need not wait for
        from studies.questions import QUESTIONS

        question = self.get(wildcards.study).questions[wildcards.question]
        root = self.folder.parent
        return [str(root / path) for path in imported(QUESTIONS[question["ask"]].modules)]

    def file(self, name: str) -> Path:
        """Name the file of a study."""
        return self.folder / f"{name}.yaml"

    def wanted(self, targets: Iterable[str]) -> list[str]:
        """Return the names of the studies that snakemake's arguments ask for."""
        targets = set(targets)
        parts = {part for target in targets for part in Path(target).parts}

        def named(rule):  # of a module, whose rules may have a prefix
            return any(target == rule or target.endswith(f"_{rule}") for target in targets)

        if named("studies"):
            return self.names
        return [name for name in self.names if name in parts or named(f"study_{name}")]

    def check(self, targets: Iterable[str]) -> None:
        """Refuse studies that some targets ask for and that cannot be computed.

        Raises
        ------
        ConfigError
            One line with the file, the key and the cure.
        """
        targets = set(targets)
        for name in self.misnamed:
            if {"studies", f"study_{name}"} & targets:
                cure = "rename it with lower-case letters, digits and underscores"
                raise ConfigError(f"is no name of a study; {cure}", self.file(name))
        wanted = self.wanted(targets)
        if not wanted:
            return
        # the library takes seconds, which other targets need not wait for
        from studies.checks import require_sound

        for name in wanted:
            place = f"studies.{name}" if name in self.own else self.file(name)
            study = self.get(name)
            try:
                require_sound(study)
            except ConfigError as error:
                own = str(error).startswith(str(study.folder)) and name not in self.own
                raise error if own else ConfigError(str(error), place) from None
