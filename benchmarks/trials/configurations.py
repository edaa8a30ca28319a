"""Bad configurations: each is refused in a line that says what is wrong, and none runs.

Thousands of mutations of config.yaml, and of config/smoke.yaml over it, are made from the schema.
With no argument each is checked in this process, which takes minutes. With ``--command N`` every
N-th is put into a copy of the repository and given to ``snakemake --dry-run`` as a user would.

Prints the counts and what is bad: accepted though it cannot run, refused though it is legal, a line
that does not name file and key, more than two lines, more than four seconds of the processor, a
traceback, files written. Exits with status 1 if anything is bad.
"""

import argparse
import resource
import shutil
import subprocess
import sys
import tempfile
import traceback
from functools import cache
from pathlib import Path

from benchmarks.trials.mutations import CONFIG, ROOT, SMOKE, Mutation, mutations
from benchmarks.trials.tally import Tally
from reproduction.configuration.files import read
from reproduction.configuration.layers import Layers
from reproduction.errors import ConfigError
from workflow.checks.configuration import check

LINES, SECONDS = 2, 4.0


def answer(mutation: Mutation, folder: Path) -> str:
    """Check a mutation in this process.

    Parameters
    ----------
    mutation : Mutation
    folder : Path
        For the file, which must be read from one.

    Returns
    -------
    str
        The error's message, or nothing if it is accepted.
    """
    path, content = folder / "mutated.yaml", mutation.content
    base = [] if mutation.file == CONFIG else [(CONFIG, _configuration())]
    try:
        if isinstance(content, bytes):
            path.write_bytes(content)
            content = read(path)
        check(Layers([*base, (mutation.file, content)]))
    except ConfigError as error:
        return f"error: {error}".replace(str(path), mutation.file)
    except Exception:  # what snakemake would print; it is counted
        return traceback.format_exc()
    return ""


@cache
def _configuration():
    return read(ROOT / CONFIG)


def faults(mutation: Mutation, output: str) -> list[str]:
    """Say what is bad about an answer."""
    if mutation.legal:
        return ["refused though legal"] if output else []
    if not output:
        return ["accepted though it cannot run"]
    found = []
    if "Traceback" in output:
        found.append("traceback")
    lines = output.strip().splitlines()
    if len(lines) > LINES:
        found.append(f"more than {LINES} lines")
    named = {str(part) for part in mutation.key[-2:] if part != "" and "\n" not in str(part)}
    if f"error: {mutation.file}: " not in output:
        found.append("file not named")
    if named and not any(part[:40] in output for part in named):
        found.append("key not named")
    if len(lines[-1]) > 600:
        found.append("a very long line")
    return found


def by_command(mutation: Mutation, folder: Path, *targets: str) -> tuple[str, list[str], float]:
    """Give a mutation to snakemake in a copy of the repository.

    Parameters
    ----------
    mutation : Mutation
    folder : Path
    *targets : str
        What snakemake is asked for; the paper unless given.

    Returns
    -------
    output : str
    faults : list of str
    seconds : float
        Of the processor, which other programs do not lengthen.
    """
    place = folder / mutation.file
    original = place.read_bytes()
    place.write_bytes(mutation.text)
    before = _listing(folder)
    options = ["--configfile", SMOKE] if mutation.file == SMOKE else []
    before_run = _processor_time()
    run = subprocess.run(
        [sys.executable, "-m", "snakemake", "--cores", "1", "--dry-run", *options, "--", *targets],
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=120,
    )
    seconds = _processor_time() - before_run
    output = "" if run.returncode == 0 else run.stdout + run.stderr
    found = faults(mutation, output)
    if seconds > SECONDS and not mutation.legal:
        found.append(f"slower than {SECONDS:g} s")
    if _listing(folder) != before:
        found.append("files written")
    place.write_bytes(original)
    return output, found, seconds


def _processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _listing(folder):
    """Names and times of all files that are not snakemake's own or compiled."""
    return {
        (str(path), path.stat().st_mtime_ns)
        for path in folder.rglob("*")
        if path.is_file() and not {".snakemake", "__pycache__"} & set(path.parts)
    }


def copy_of_repository(folder: Path) -> None:
    """Copy what git tracks, as it stands in the working tree."""
    names = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "-z"],
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    for name in filter(None, names.stdout.decode().split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)
    if not (folder / "profiles").exists():
        (folder / "profiles").symlink_to("workflow/profiles")


def main() -> None:
    """Run the trial."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--command", type=int, metavar="N", help="every N-th through snakemake")
    every = parser.parse_args().command
    chosen, tally = mutations(), Tally()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if every:
            chosen = chosen[::every]
            copy_of_repository(folder)
        for mutation in chosen:
            if every:
                output, found, seconds = by_command(mutation, folder)
            else:
                output, seconds = answer(mutation, folder), 0.0
                found = faults(mutation, output)
            tally.add(mutation.told, output, found, seconds)
    legal = sum(mutation.legal for mutation in chosen)
    print(f"mutations                     {len(chosen)}, of which legal {legal}")
    tally.end()


if __name__ == "__main__":
    main()
