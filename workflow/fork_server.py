"""A process that imports the libraries of the jobs once, and forks a process for each of them.

Most jobs are shorter than their imports. `forked_jobs` starts ``python -P fork_server.py N F``, N
the number of a socket and F what kernels may use of the processor, and asks it to run scripts.
Modules of this repository may be edited during a run. After that, each job imports them itself.
"""

import contextlib
import gc
import importlib
import importlib.util
import json
import os
import runpy
import signal
import socket
import sys
from pathlib import Path

LIBRARIES = (
    "PIL.PngImagePlugin",
    "fontTools.subset",
    "lazy_loader",
    "matplotlib.backends.backend_agg",
    "matplotlib.backends.backend_pdf",
    "matplotlib.pyplot",
    "mpmath",
    "netCDF4",
    "numba",
    "pandas",
    "pandas.io.formats.style",
    "pint",
    "platformdirs",
    "scipy.integrate",
    "scipy.interpolate",
    "scipy.linalg",
    "scipy.ndimage",
    "scipy.optimize",
    "scipy.sparse.linalg",
    "scipy.special",
    "scipy.stats",
    "snakemake.iocontainers",
    "snakemake.script",
    "sympy.codegen.ast",
    "sympy.tensor.tensor",
    "threadpoolctl",
    "tqdm",
    "tylax",
    "xarray",
)
# packages of this repository, and modules of theirs with which most of the others come
OWN = ("nonsmooth", "reproduction")
MODULES = (
    "nonsmooth.crossing.probability",
    "nonsmooth.paths.simulation",
    "nonsmooth.statistics.asymptotic_variance",
    "reproduction.agreement",
    "reproduction.rendering.panels",
    "reproduction.rendering.tables",
)
LONGEST = 2**16  # bytes of a request


def prepare(features: str) -> None:
    """Import what jobs import, and what numba imports when it compiles for the first time.

    Numba keeps to the features of the processor that it is told before. With others, jobs would
    compile all kernels again.
    """
    for library in LIBRARIES:
        with contextlib.suppress(ImportError):  # a job that needs it says so
            importlib.import_module(library)
    with contextlib.suppress(ImportError):
        import numba
        import numpy as np

        if features:
            numba.config.CPU_FEATURES = features
        numba.njit(lambda values: np.exp(values).sum())(np.ones(1))
    for module in MODULES:
        with contextlib.suppress(Exception):  # it may be half edited
            importlib.import_module(module)
    gc.collect()
    gc.freeze()  # what is there stays: no job looks through it again


def sources() -> dict[Path, tuple[int, int]]:
    """Tell the state of the modules of this repository: when they were written, and their sizes."""
    known = {}
    for found in map(importlib.util.find_spec, OWN):
        for top in (found and found.submodule_search_locations) or []:
            for folder, inner, files in os.walk(top):
                inner[:] = set(inner) - {"__pycache__"}
                for path in (Path(folder, name) for name in files if name.endswith(".py")):
                    with contextlib.suppress(OSError):  # an editor's lock, or gone again
                        state = path.stat()
                        known[path] = state.st_mtime_ns, state.st_size
    return known


def forget() -> None:
    """Let the modules of this repository be imported anew."""
    for name in list(sys.modules):
        if name.partition(".")[0] in OWN:
            del sys.modules[name]


def serve(requests: socket.socket) -> dict:
    """Fork for every request; return in the process of a job, with what it is asked for.

    The first word says that the server is ready. A request comes with a socket. There the server
    tells the number of the process, waits for a word, and tells how the process has ended, as
    `os.waitpid` does.

    Parameters
    ----------
    requests : socket.socket
        When it is closed at the other end, the server exits.

    Returns
    -------
    dict
        `script`, and `environment` besides that of the server.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the jobs
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for those that wait for jobs
    requests.sendall(b"r")
    while True:
        request, sockets, _, _ = socket.recv_fds(requests, LONGEST, 1)
        if not request:
            sys.exit()
        with socket.socket(fileno=sockets[0]) as answers:
            if os.fork() == 0:
                requests.close()
                signal.signal(signal.SIGCHLD, signal.SIG_DFL)
                job = os.fork()
                if job == 0:
                    signal.signal(signal.SIGINT, signal.default_int_handler)
                    return json.loads(request)
                with contextlib.suppress(OSError):  # snakemake has been killed
                    answers.sendall(b"%d\n" % job)
                    answers.recv(1)
                    answers.sendall(b"%d\n" % os.waitpid(job, 0)[1])
                os._exit(0)


if __name__ == "__main__":
    channel = socket.socket(fileno=int(sys.argv[1]))
    before = sources()
    prepare(sys.argv[2])
    task = serve(channel)
    if sources() != before:
        forget()
    os.environ.update(task["environment"])
    sys.argv[:] = [task["script"]]
    sys.path.insert(0, os.path.dirname(task["script"]))
    runpy.run_path(task["script"], run_name="__main__")
