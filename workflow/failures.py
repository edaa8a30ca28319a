"""What to do about failures that no job can tell itself."""

from collections.abc import Iterable
from pathlib import Path

HINTS = {
    "died with <Signals.SIGKILL": "a job was killed, as systems do when memory is short; close "
    "other programs or run with --cores 1, and run snakemake again",
    "[Errno 28]": "a disk is full; free space and run snakemake again",
    "[Errno 122]": "a quota is used up; free space and run snakemake again",
}


def hints(logs: Iterable[str]) -> list[str]:
    """Find in the logs of a run what they do not explain.

    Parameters
    ----------
    logs : iterable of str
        Of snakemake.

    Returns
    -------
    list of str
        One line for each kind of failure.
    """
    text = "".join(Path(log).read_text(encoding="utf-8", errors="replace") for log in logs)
    return [f"error: {hint}" for sign, hint in HINTS.items() if sign in text]
