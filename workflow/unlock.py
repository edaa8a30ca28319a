"""Give free the folder that a killed run has left locked: ``python -m workflow.unlock``.

Snakemake locks the files of a run by files in ``.snakemake/locks``, which stay if it is killed.
They are removed if no snakemake is alive in this folder, on this machine.
"""

import fcntl
import os
import platform
import sys
from collections.abc import Iterator
from pathlib import Path

import psutil

STATE = Path(".snakemake")


def unlock(folder: Path) -> list[Path]:
    """Remove the locks of runs that are no more.

    Parameters
    ----------
    folder : Path
        In which snakemake runs.

    Returns
    -------
    list of Path
        The locks removed; none if a run is alive, or may be on another machine.
    """
    state = folder / STATE
    state.mkdir(exist_ok=True)
    with open(state / "unlocking", "a+", encoding="utf-8", errors="replace") as guard:
        # two programs like this one take turns
        fcntl.flock(guard, fcntl.LOCK_EX)
        # first the locks, then the processes: a run that starts meanwhile has other locks
        locks = sorted((state / "locks").glob("*.lock"))
        guard.seek(0)
        # the processes of another machine are not seen from here
        elsewhere = guard.read() not in ("", platform.node())
        if locks and (elsewhere or any(alive(folder))):
            return []
        for lock in locks:
            lock.unlink(missing_ok=True)
        guard.truncate(0)
        guard.write(platform.node())
        return locks


def alive(folder: Path) -> Iterator[psutil.Process]:
    """Yield the snakemakes that run in a folder, and those of which nobody may know where.

    Parameters
    ----------
    folder : Path
    """
    own = {os.getpid(), *(parent.pid for parent in psutil.Process().parents())}
    for process in psutil.process_iter(["cmdline", "cwd", "status"]):
        words = process.info["cmdline"] or []
        # the interpreter, perhaps its options, and the program
        program = {Path(word).name for word in words[:2]} | set(words[1:3])
        if (
            "snakemake" in program
            and process.pid not in own
            and process.info["status"] != psutil.STATUS_ZOMBIE
            and process.info["cwd"] in (None, str(folder.resolve()))
        ):
            yield process


def main() -> None:
    """Unlock this folder."""
    try:
        removed = unlock(Path())
    except OSError as error:
        sys.exit(
            f"error: {error.filename or STATE}: {error.strerror}; delete it, or make it writable"
        )
    if removed:
        print("the last run was killed: its locks are removed, its results are taken up")


if __name__ == "__main__":
    main()
