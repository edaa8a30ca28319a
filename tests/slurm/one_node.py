"""A Slurm cluster of one node, this machine, for as long as a program needs it."""

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

import psutil

PROGRAMS = ("munged", "slurmctld", "slurmd")
# Only here do the jobs look for it: Snakemake's plugin leaves SLURM_CONF out of their environment.
SETTINGS_FILE = Path("/etc/slurm/slurm.conf")
# There is no database of accounts, so that squeue must tell the state of jobs.
OPTIONS = ["--slurm-status-command", "squeue", "--slurm-no-account"]

SETTINGS = """\
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser=root
StateSaveLocation={folder}/controller
SlurmdSpoolDir={folder}/node
SlurmctldPidFile={folder}/controller.pid
SlurmdPidFile={folder}/node.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/affinity
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
ReturnToService=2
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory}
PartitionName=main Nodes={host} Default=YES State=UP
"""


def answers():
    """Whether a cluster is there."""
    return (
        bool(shutil.which("sinfo"))
        and not subprocess.run(["sinfo"], capture_output=True, check=False).returncode
    )


def find(program):
    """Return the path of a daemon; install it if that is possible."""
    path = f"{os.environ['PATH']}:/usr/local/sbin:/usr/sbin:/sbin"
    if not shutil.which(program, path=path) and shutil.which("apt-get"):
        subprocess.run(["apt-get", "update", "-qq"], check=True)
        subprocess.run(["apt-get", "install", "-y", "-qq", "slurm-wlm", "munge"], check=True)
    found = shutil.which(program, path=path)
    if not found:
        sys.exit(f"error: {program} is not installed; install Slurm and munge")
    return found


def commands(folder):
    """Prepare a folder for the daemons and list the commands that start them."""
    (folder / "munge.key").write_bytes(os.urandom(128))
    (folder / "munge.key").chmod(0o600)
    for name in ("controller", "node"):
        (folder / name).mkdir()
    SETTINGS_FILE.parent.mkdir(exist_ok=True)
    SETTINGS_FILE.write_text(
        SETTINGS.format(
            folder=folder,
            host=socket.gethostname().partition(".")[0],
            cpus=os.cpu_count(),
            memory=psutil.virtual_memory().total * 9 // 10 // 2**20,
        )
    )
    files = {"key-file": "key", "socket": "socket", "pid-file": "pid", "seed-file": "seed"}
    munge = [f"--{option}={folder}/munge.{name}" for option, name in files.items()]
    munged, controller, node = map(find, PROGRAMS)
    return [
        [munged, "--foreground", "--force", f"--log-file={folder}/munge.log", *munge],
        [controller, "-D"],
        [node, "-D"],
    ]


def wait_until(ready, seconds):
    """Wait until something is so; tell whether it is."""
    end = time.monotonic() + seconds
    while not ready() and time.monotonic() < end:
        time.sleep(0.5)
    return ready()


@contextmanager
def stopped_at_exit(command, log):
    """Run a daemon in the foreground and stop it in the end."""
    with (
        log.open("w") as stream,
        subprocess.Popen(command, stdout=stream, stderr=stream, start_new_session=True) as process,
    ):
        try:
            yield
        finally:
            process.terminate()


@contextmanager
def cluster():
    """Give a cluster: that of this machine, or a node of its own, which is stopped in the end.

    Yields
    ------
    list of str
        Options that snakemake needs on it.
    """
    if answers():
        yield []
        return
    if SETTINGS_FILE.exists() or os.geteuid():
        sys.exit(
            "error: Slurm does not answer; start it, or be root and without "
            f"{SETTINGS_FILE}, so that this machine alone can become a cluster"
        )
    with ExitStack() as stack:
        # short names, because those of sockets must be
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="slurm")))
        folder.chmod(0o755)
        stack.callback(SETTINGS_FILE.unlink, missing_ok=True)
        for command in commands(folder):
            log = folder / f"{Path(command[0]).name}.out"
            stack.enter_context(stopped_at_exit(command, log))
            time.sleep(1)
        works = wait_until(
            lambda: (
                not subprocess.run(
                    ["srun", "--immediate=2", "true"], capture_output=True, check=False
                ).returncode
            ),
            30,
        )
        if not works:
            logs = "".join(path.read_text() for path in sorted(folder.glob("*.out")))
            sys.exit(f"error: Slurm does not start; its daemons say:\n{logs[-2000:]}")
        yield OPTIONS
