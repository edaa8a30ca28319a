"""How a script runs as a job: errors that the user can mend are one line, others a traceback."""

import sys
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

import xarray as xr

from nonsmooth.errors import NonsmoothError
from reproduction.jobs import artifact


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
def job(log: str | Path) -> Iterator[None]:
    """Run the body; on failure write the traceback to `log` and exit with status 1.

    Parameters
    ----------
    log : str or Path

    Raises
    ------
    SystemExit
        After a `NonsmoothError`, whose message is printed as one line.
    """
    log = Path(log)
    log.parent.mkdir(parents=True, exist_ok=True)
    try:
        yield
    except NonsmoothError as error:
        log.write_text(traceback.format_exc(), encoding="utf-8")
        print(f"error: {error}", file=sys.stderr)
        raise SystemExit(1) from None
    except BaseException:
        log.write_text(traceback.format_exc(), encoding="utf-8")
        raise
    log.write_text("done\n", encoding="utf-8")


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
    with job(task.log[0]):
        data, parameters = inputs(task), dict(task.params.items())
        first = [d[0] if isinstance(d, list) else d for d in data.values()]
        trail = [d.attrs["history"] for d in first] + [artifact.provenance(task.rule, parameters)]
        result = compute(**data, **parameters, **options)
        artifact.write(result, task.output[0], "\n".join(trail))
