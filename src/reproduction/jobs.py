"""How a script runs as a job: failures the user can mend cost one line, all others a traceback.

A task is any object with the attributes `rule`, `params`, `input`, `output` and `log`, where
`params` and `input` have named items.
"""

import sys
import traceback
from contextlib import contextmanager
from pathlib import Path

from nonsmooth.errors import NonsmoothError
from reproduction import artifact


@contextmanager
def job(log):
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


def inputs(task):
    """Read the artifacts among a task's inputs: name -> dataset or list of datasets.

    Other inputs, such as source files, are what the script itself reads.
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


def produce(compute, task):
    """Run a task whose output is one artifact.

    Parameters
    ----------
    compute : callable
        Takes the task's input artifacts and parameters by name, returns an xarray.Dataset.
    task : object
    """
    with job(task.log[0]):
        data, parameters = inputs(task), dict(task.params.items())
        first = [d[0] if isinstance(d, list) else d for d in data.values()]
        trail = [d.attrs["history"] for d in first] + [artifact.provenance(task.rule, parameters)]
        artifact.write(compute(**data, **parameters), task.output[0], "\n".join(trail))
