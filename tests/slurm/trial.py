"""Run the workflow and a study at reduced sizes here and through Slurm, and compare every byte.

`make test-slurm` runs this. It uses the machine's Slurm or starts one of a single node; a running
job is cancelled, which must be tried again. Printed are how many jobs there were of each kind and
how many files are equal; the exit code is 0 if all are.

`python -m tests.slurm.trial figure_2a` does so for some targets only; `studies` is the study alone.
"""

import os
import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

from tests.slurm.one_node import cluster
from tests.support import ROOT, copy_repository

# in the repository, whose file system the nodes of a cluster share
FOLDER = ROOT / "results" / "slurm"
RESULTS = Path("results", "smoke")
STUDIES = ROOT / "tests" / "slurm" / "studies.yaml"
SNAKEMAKE = [sys.executable, "-m", "snakemake", "--configfile", "config/smoke.yaml", str(STUDIES)]
LOCAL = ["--cores", str(os.cpu_count())]
SLURM = ["--workflow-profile", "workflow/profiles/slurm"]
SLURM += ["--slurm-init-seconds-before-status-checks", "3"]
# of a run, and of a job before it is cancelled
LONGEST, RUNNING = 3600, 5


def run(name, options, targets):
    """Run the workflow in a fresh copy of the repository; return its folder, log and seconds."""
    folder = FOLDER / name
    folder.mkdir(parents=True)
    copy_repository(folder)
    log = FOLDER / f"{name}.log"
    began = time.monotonic()
    with log.open("w") as stream:
        process = subprocess.run(
            [*SNAKEMAKE, *options, "--", *targets],
            cwd=folder,
            stdout=stream,
            stderr=stream,
            timeout=LONGEST,
            check=False,
        )
    seconds = time.monotonic() - began
    text = log.read_text()
    if process.returncode:
        sys.exit(f"error: the run {name} failed:\n{text[-3000:]}\nsee {log}")
    return folder / RESULTS, text, seconds


class Cancelling(threading.Thread):
    """Cancels the first job of this run that has run for some seconds, once.

    It is not one of an array, whose other jobs would fail too if it were the first of them.
    """

    def __init__(self):
        super().__init__(daemon=True)
        self.job = None

    def run(self):
        """Watch the queue."""
        while not self.job:
            time.sleep(1)
            # %j is the identity of snakemake's run, the name of all of its jobs
            listed = ["squeue", "--noheader", "--me", "--states=RUNNING", "--format=%i %M %j"]
            queue = subprocess.run(listed, capture_output=True, text=True, check=False).stdout
            for identity, elapsed, name in map(str.split, queue.splitlines()):
                minutes, seconds = map(int, elapsed.split(":")[-2:])
                ready = 60 * minutes + seconds >= RUNNING and "_" not in identity
                if ready and self.is_ours(name):
                    subprocess.run(["scancel", identity], check=True)
                    self.job = identity
                    return

    @staticmethod
    def is_ours(name):
        """Whether a job is of the run that is watched."""
        log = FOLDER / "slurm.log"
        return log.exists() and f"SLURM run ID: {name}" in log.read_text()


def outcome(log, cancelled):
    """Count in the log of a run through Slurm what became a job of which kind."""
    arrays = [
        len(ids.split(",")) for ids in re.findall(r"array job with Snakemake IDs ([\d,]+)", log)
    ]
    single = len(re.findall(r"has been submitted with SLURM jobid", log))
    restarted = len(re.findall(r"Trying to restart job", log))
    return {
        "jobs of the workflow": max(map(int, re.findall(r"(\d+) of \d+ steps", log)), default=0),
        "jobs of Slurm": single + sum(arrays),
        "calls of sbatch": single + len(arrays),
        "of them job arrays": len(arrays),
        "cancelled while running": cancelled or "none",
        "tried again": restarted,
    }


def difference(first, second):
    """List the files of two folders that are not in both or not equal, and count the equal ones.

    Logs and benchmarks are apart, and the reports of studies, which tell the seconds of their jobs.
    """
    files = {
        path.relative_to(folder)
        for folder in (first, second)
        for path in folder.rglob("*")
        if path.is_file()
        and path.relative_to(folder).parts[0] not in {"logs", "benchmarks"}
        and not path.relative_to(folder).match("studies/*/report.*")
    }
    both = {name for name in files if (first / name).exists() and (second / name).exists()}
    equal = {name for name in both if (first / name).read_bytes() == (second / name).read_bytes()}
    return sorted(files - equal), len(equal)


def main(targets):
    """Run, compare and print."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    here, _, seconds_here = run("local", LOCAL, targets)
    with cluster() as options:
        cancelling = Cancelling()
        cancelling.start()
        there, log, seconds_there = run("slurm", [*SLURM, *options], targets)
    differing, equal = difference(here, there)
    table = {
        "seconds here": round(seconds_here),
        "seconds through Slurm": round(seconds_there),
        **outcome(log, cancelling.job),
        "files equal to the byte": equal,
        "files that differ": len(differing),
    }
    for what, value in table.items():
        print(f"{what:<26}{value:>8}")
    for name in differing:
        print(f"differs: {name}")
    if differing or not equal:
        sys.exit(f"error: the results differ; see {FOLDER}")
    if not table["tried again"]:
        sys.exit(f"error: no job was cancelled and tried again; see {FOLDER / 'slurm.log'}")
    shutil.rmtree(FOLDER)


if __name__ == "__main__":
    main(sys.argv[1:] or ["all", "studies"])
