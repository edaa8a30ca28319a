"""Where generated files may go: nowhere that a source, or somebody's file, would be lost."""

import os
import subprocess
from functools import lru_cache
from pathlib import Path

from reproduction.configuration.schema import shown
from reproduction.errors import ConfigError, dotted

ROOT = Path(__file__).resolve().parents[2]
# what a repository holds besides its outputs; also where there is no git to ask
SOURCES = {
    *("src", "workflow", "tests", "docs", "config", "examples", "benchmarks", "profiles"),
    *("node_modules", "build", "dist"),
}
# what the operating system holds
SYSTEM = {"bin", "boot", "dev", "etc", "lib", "lib32", "lib64", "proc", "sbin", "sys", "usr"}
# what holds the folders of many
SHARED = {Path("/") / name for name in ("home", "media", "mnt", "opt", "run", "srv", "tmp", "var")}
# folders of the results that belong to rules
GENERATED = {"figures", "tables", "logs", "benchmarks"} | {
    path.stem for path in Path(__file__).parents[1].glob("rules/*.smk")
}
# of a name, and of a whole path, which names of artifacts and partial files lengthen
LONGEST_NAME, LONGEST_PATH = 200, 3000


def check_outputs(outputs: dict) -> None:
    """Refuse outputs that would overwrite what no rule made, or that cannot be written.

    Parameters
    ----------
    outputs : dict
        The folder of the results and the file of the paper, by the keys of the configuration.

    Raises
    ------
    ConfigError
    """
    places = {name: _place(name, outputs[name]) for name in ("results", "paper")}
    for name, place in places.items():
        _require_own(name, outputs[name], place)
        _require_writable(name, outputs[name], place)
    _require_apart(outputs["paper"], places["paper"], places["results"])


def _refused(name, text, problem):
    key = ("outputs", name)
    return ConfigError(f"{dotted(key)} = {shown(text)} {problem}", key=key)


def _place(name, text):
    """Return the place that a path leads to, through links, if it is spelt plainly."""
    if not text.strip() or text != text.strip():
        raise _refused(name, text, "is blank, or begins or ends so; choose a path without")
    if odd := next((c for c in text if not c.isprintable() or c in "{}<>\\*?$"), None):
        raise _refused(name, text, f"has the character {odd!r}; choose a path without it")
    if text.startswith("~") or "://" in text:
        raise _refused(name, text, "is not a path of this machine; write it in full")
    if os.path.normpath(text) != text:
        raise _refused(name, text, f"is not spelt plainly; write {shown(os.path.normpath(text))}")
    path = ROOT / text
    if len(os.fsencode(path)) > LONGEST_PATH or any(
        len(os.fsencode(part)) > LONGEST_NAME for part in path.parts
    ):
        raise _refused(name, text, "is too long a name; choose a shorter one")
    try:
        return path.resolve()
    except (OSError, RuntimeError):
        raise _refused(name, text, "is a link that leads nowhere; choose another") from None


def _require_own(name, text, place):
    """Refuse places where sources are, or that hold everything."""
    if place in (ROOT, *ROOT.parents, Path.home(), *SHARED):
        raise _refused(name, text, "holds other files than results; choose a folder below it")
    if SYSTEM.intersection(place.parts[1:2]) and place.parts[1:3] != ("dev", "shm"):
        raise _refused(name, text, "is a folder of the operating system; choose another")
    if ".git" in place.parts:
        raise _refused(name, text, "lies in a repository's .git; choose another")
    # where it is, and where it seems to be
    for path in (place, Path(os.path.normpath(ROOT / text))):
        if path.is_relative_to(ROOT):
            first = path.relative_to(ROOT).parts[0]
            mixed = name == "results" and first.casefold() == "paper"
            # some file systems do not tell upper from lower case
            if first.casefold() in SOURCES or first.startswith(".") or mixed:
                raise _refused(
                    name,
                    text,
                    f"lies in {first!r}, where sources are; choose a folder such as results/mine",
                )
    for file in tracked():
        if file == place or (place in file.parents and file != ROOT / "results" / "README.md"):
            problem = f"holds {str(file.relative_to(ROOT))!r}, which git tracks; choose another"
            raise _refused(name, text, problem)


@lru_cache(maxsize=1)
def tracked() -> list[Path]:
    """List what git tracks here.

    Returns
    -------
    list of Path
        Empty where there is no git, or no repository of its own.
    """
    if not (ROOT / ".git").exists():
        return []
    try:
        found = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, timeout=10)
    except (OSError, subprocess.TimeoutExpired):
        return []
    return [ROOT / os.fsdecode(name) for name in found.stdout.split(b"\0") if name]


def _require_writable(name, text, place):
    if name == "paper" and place.suffix != ".pdf":
        raise _refused(name, text, "does not end with .pdf; choose a name such as mine.pdf")
    if name == "paper" and place.exists() and not (place.is_file() and _is_typeset(place)):
        raise _refused(
            name, text, "exists and was not typeset by this workflow; choose another name"
        )
    folder = place if name == "results" else place.parent
    while not os.path.lexists(folder):
        folder = folder.parent
    if not folder.is_dir():
        raise _refused(name, text, f"is impossible: {str(folder)!r} is no folder; choose another")
    if not os.access(folder, os.W_OK | os.X_OK):
        problem = f"cannot be written into {str(folder)!r}; make it writable or choose another"
        raise _refused(name, text, problem)


def _is_typeset(path):
    """Whether a file is empty or a PDF by typst, which the paper is."""
    try:
        content = path.read_bytes()
    except OSError:
        return False
    return not content or (content.startswith(b"%PDF") and b"Typst" in content)


def _require_apart(text, paper, results):
    """Refuse a paper where the results have their artifacts."""
    if paper == results or paper in results.parents:
        raise _refused("paper", text, "is the folder of the results, too; choose another name")
    if paper.is_relative_to(results):
        first, *rest = paper.relative_to(results).parts
        if rest and first.casefold() in GENERATED - {"paper"}:
            raise _refused(
                "paper", text, f"lies among the results' own {first!r}; choose another folder"
            )
