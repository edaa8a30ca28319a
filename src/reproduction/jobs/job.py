"""How a script runs as a job: errors that the user can mend are one line, others a traceback."""

import errno
import hashlib
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

import xarray as xr

from nonsmooth.errors import AccuracyWarning, NonsmoothError
from reproduction.errors import ArtifactError
from reproduction.jobs import artifact
from reproduction.jobs.files import write_whole


class Task(Protocol):
    """What a script is asked to do, as `snakemake` hands it over.

    Attributes
    ----------
    rule : str
    params : mapping
        Parameters of the script's function by name.
    input : mapping
        Files by name; artifacts, which end in ``.nc``, are read for the function.
    output, log : sequence of str
        Files to write.
    """

    rule: str
    params: Mapping
    input: Mapping
    output: Sequence[str]
    log: Sequence[str]


@contextmanager
def job(task: Task) -> Iterator[None]:
    """Run the body; its log has the traceback or, if all went well, the checksums of the output.

    A result that misses the accuracy of its method ends it, like any error.

    Parameters
    ----------
    task : Task
        If its log cannot be written, a line says so; the result of the body counts.

    Raises
    ------
    SystemExit
        With status 1 after a `NonsmoothError`, a full disk or a lack of memory, told in one line.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", AccuracyWarning)
            yield
    except BaseException as error:
        _record(task, traceback.format_exc())
        message = _message(error)
        if message is None:
            raise
        print(f"error: {message}", file=sys.stderr)
        raise SystemExit(1) from None
    sums = "".join(f"{_digest(path)}  {path}\n" for path in task.output)
    _record(task, f"{sums}done\n")


def require_as_written(path: str | Path, log: str | Path) -> None:
    """Compare a file with the checksum in the log of the job that wrote it.

    Artifacts carry their own.

    Parameters
    ----------
    path, log : str or Path

    Raises
    ------
    ArtifactError
        If they differ or one cannot be read.
    """
    again = f"delete {path} and run snakemake again"
    try:
        sums = [line.split(maxsplit=1) for line in Path(log).read_text("utf-8").splitlines()]
        same = [_digest(path), str(path)] in sums
    except (OSError, UnicodeDecodeError) as error:
        raise ArtifactError(f"cannot compare {path} with {log} ({error}); {again}") from None
    if not same:
        raise ArtifactError(f"{path} is damaged or changed: not the checksum of {log}; {again}")


def _digest(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def _record(task, text):
    try:
        write_whole(task.log[0], text.encode())
    except ArtifactError as error:
        print(f"warning: {error}", file=sys.stderr)


def _message(error):
    """Return the line for an error that the user can mend."""
    if isinstance(error, NonsmoothError):
        return str(error)
    if isinstance(error, MemoryError):
        return (
            f"not enough memory ({error or 'none is left'}); close other programs, run with "
            "--cores 1, or reduce the sizes of this rule in the configuration"
        )
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        # not of a result, which `write_whole` writes
        return (
            f"cannot write a cache or a temporary file ({error}); "
            f"free space on the disks of {Path.cwd()} and of TMPDIR"
        )
    return None


def inputs(task: Task) -> dict[str, xr.Dataset | list[xr.Dataset]]:
    """Read the artifacts among a task's inputs.

    The other inputs, such as source files, the script reads itself if at all.

    Returns
    -------
    dict
        From names to a dataset or a list of datasets.
    """
    return {
        name: artifact.read(paths)
        if isinstance(paths, str)
        else [artifact.read(path) for path in paths]
        for name, paths in task.input.items()
        if _are_artifacts(paths)
    }


def _are_artifacts(paths):
    every = [paths] if isinstance(paths, str) else paths
    return all(Path(path).suffix == ".nc" for path in every)


def produce(compute: Callable, task: Task, **options: object) -> None:
    """Run a task whose output is one artifact.

    Parameters
    ----------
    compute : callable
        Takes the task's input artifacts and parameters by name, returns an xarray.Dataset.
    task : Task
    **options
        More arguments of `compute`, on which the result does not depend, such as `threads`.
    """
    with job(task):
        data, parameters = inputs(task), dict(task.params.items())
        first = [d[0] if isinstance(d, list) else d for d in data.values()]
        trail = [d.attrs["history"] for d in first] + [artifact.provenance(task.rule, parameters)]
        result = compute(**data, **parameters, **options)
        artifact.write(result, task.output[0], "\n".join(trail))
