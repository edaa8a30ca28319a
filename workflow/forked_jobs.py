"""Scripts run in processes that a server forks, which has imported their libraries already.

A run of the whole workflow has two hundred jobs, and each would import libraries for two seconds.
Snakemake knows no such server; `fork_scripts` puts it in the place of the command with which
snakemake runs a Python script. Where the server does not serve, the command does.
"""

import json
import os
import select
import signal
import socket
import subprocess
import sys
from contextlib import nullcontext, suppress
from pathlib import Path
from threading import Lock
from typing import Any

from snakemake.benchmark import benchmarked
from snakemake.script import PythonScript

SERVER = Path(__file__).with_name("fork_server.py")
_ONE_THREAD = ("GOTO", "MKL", "OMP", "OPENBLAS")  # as snakemake limits libraries in its jobs
_TEMPORARY = ("TMPDIR", "TMP", "TEMPDIR", "TEMP")


class ForkServer:
    """A process of `fork_server`, which ends with this one.

    Attributes
    ----------
    process : subprocess.Popen
    """

    def __init__(self) -> None:
        # it takes numba, which is not needed where no script is forked
        from nonsmooth.paths.kernels.compilation import features

        self._requests, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._lock, self._ready = Lock(), False
        with theirs:
            self.process = subprocess.Popen(
                [sys.executable, "-P", SERVER, str(theirs.fileno()), features() or ""],
                stdin=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                env=os.environ | {f"{library}_NUM_THREADS": "1" for library in _ONE_THREAD},
            )

    def __enter__(self) -> "ForkServer":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """End the server; its jobs go on."""
        self._requests.close()
        self.process.wait()

    def run(self, script: str, environment: dict[str, str], record: Any = None) -> bool:
        """Run a Python script as if it were the main program of a new process.

        Parameters
        ----------
        script : str
        environment : dict
            Variables besides those of this process.
        record : snakemake.benchmark.BenchmarkRecord, optional
            Gets what the process needs.

        Returns
        -------
        bool
            False if the script has not been run, because the server is not ready yet or gone.

        Raises
        ------
        subprocess.CalledProcessError
            If it ends with another status than 0.
        """
        ours, theirs = socket.socketpair()
        request = json.dumps({"script": script, "environment": environment}).encode()
        with ours, ours.makefile("r") as answers:
            try:
                with theirs, self._lock:
                    if not self._is_ready():
                        return False
                    socket.send_fds(self._requests, [request], [theirs.fileno()])
                job = int(answers.readline())
            except (OSError, ValueError):
                return False
            with benchmarked(job, record) if record is not None else nullcontext():
                # what waits for the job may have been killed
                with suppress(OSError):
                    ours.sendall(b"\n")
                ended = answers.readline() or signal.SIGKILL
            if status := os.waitstatus_to_exitcode(int(ended)):
                raise subprocess.CalledProcessError(status, f"{sys.executable} {script}")
        return True

    def _is_ready(self):
        """Whether the server has imported everything, which it tells once."""
        if not self._ready and select.select([self._requests], [], [], 0)[0]:
            self._ready = bool(self._requests.recv(1))
        return self._ready


def fork_scripts() -> None:
    """Let a server run the scripts of this process that need no other environment or threads.

    Until it has imported everything, they run as ever.
    """
    server, by_command = ForkServer(), PythonScript.execute_script

    def execute_script(self, fname, edit=False):
        elsewhere = self.container_img or self.conda_env or self.env_modules
        folder = self.resources.get("tmpdir")
        environment = dict.fromkeys(_TEMPORARY, folder) if folder else {}
        own = elsewhere or self.threads > 1
        if own or not server.run(fname, environment, self.bench_record):
            by_command(self, fname, edit)

    PythonScript.execute_script = execute_script
