"""Snakemake in a process that has imported its libraries already: that takes half of a dry run.

Nothing of this repository is imported before the fork: copies of it have modules of their own.
"""

import multiprocessing
import os
import runpy
import subprocess
import sys
import tempfile
from pathlib import Path

TESTS = Path(__file__).parent
_CONTEXT = multiprocessing.get_context("forkserver")
_CONTEXT.set_forkserver_preload(["jsonschema", "snakemake.cli", "sympy"])


def run(folder: Path, arguments: list[str], environment: dict, timeout: float):
    """Run `python -m snakemake` in a folder; return the finished process."""
    with tempfile.TemporaryDirectory() as outputs:
        files = [Path(outputs, name) for name in ("stdout", "stderr")]
        process = _CONTEXT.Process(target=_main, args=(folder, arguments, environment, files))
        process.start()
        process.join(timeout)
        if process.exitcode is None:
            process.kill()
            raise subprocess.TimeoutExpired(arguments, timeout)
        texts = (file.read_text() for file in files)
        return subprocess.CompletedProcess(arguments, process.exitcode, *texts)


def _main(folder, arguments, environment, files):
    """Become the process."""
    for number, file in enumerate(files, start=1):
        os.dup2(os.open(file, os.O_WRONLY | os.O_CREAT), number)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.argv[:] = ["snakemake", *arguments]
    others = (entry for entry in sys.path if Path(entry) not in (TESTS, TESTS.parent))
    sys.path[:] = [str(folder), *others]
    runpy.run_module("snakemake", run_name="__main__", alter_sys=True)
