"""Full disks and killed jobs: one line with the cure, nothing half-written, then the same bytes."""

import subprocess
import sys

import pytest

from workflow.failures import hints

RESULTS = "results/small"
ELSEWHERE = f"outputs={{results: {RESULTS}, paper: {RESULTS}/paper.pdf}}"
TARGET = "figure_1"


def in_a_namespace(*command, cwd="."):
    """Run a command that may mount disks, as any user can where the system allows it."""
    command = ["unshare", "--map-root-user", "--mount", *command]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=600)


def can_mount():
    """Whether this system lets us."""
    try:
        return in_a_namespace("mount", "-t", "tmpfs", "tmpfs", "/mnt").returncode == 0
    except OSError:
        return False


@pytest.mark.slow
@pytest.mark.skipif(not can_mount(), reason="needs unshare and user namespaces to mount a disk")
def test_full_disk(repository):
    """The results lie on a disk that is too small, and then on a larger one."""
    snakemake = f"{sys.executable} -m snakemake --cores 1 --config '{ELSEWHERE}' -- {TARGET}"
    small, large = repository.folder / RESULTS, repository.folder / "results" / "copy"
    script = f"""
        mkdir -p {small}
        mount -t tmpfs -o size=32k tmpfs {small}
        {snakemake}
        echo "status $?, files:" && find {small} -type f
        mount -o remount,size=10m {small}
        {snakemake} && cp -r {small} {large}
    """
    run = in_a_namespace("sh", "-c", script, cwd=repository.folder)
    (line,) = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert "No space left on device" in line
    assert f"bytes are free in {small}" in line
    assert line.endswith("free space there")
    assert run.stdout.split() == ["status", "1,", "files:", f"{small}/logs/figures/{TARGET}.log"]
    assert run.returncode == 0, run.stderr
    assert repository.snakemake("--cores", "1", "--config", ELSEWHERE, "--", TARGET).returncode == 0
    for name in (f"{TARGET}.pdf", f"{TARGET}.png"):
        assert (large / "figures" / name).read_bytes() == (small / "figures" / name).read_bytes()


@pytest.mark.slow
def test_killed_job(repository):
    """What killed it is not known, but what usually does is named; the next run completes."""
    script = repository.folder / "workflow" / "scripts" / "rheology" / "figure_1.py"
    source = script.read_text()
    script.write_text(f"import os\n{source}".replace("draw(", "os.kill(os.getpid(), 9)\n    draw("))
    run = repository.snakemake("--cores", "1", "--", TARGET)
    assert run.returncode != 0
    (line,) = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert "memory is short; close other programs or run with --cores 1" in line
    script.write_text(source)
    assert repository.snakemake("--cores", "1", "--", TARGET).returncode == 0


@pytest.mark.parametrize(
    ("text", "cure"), [("OSError: [Errno 28] No space left", "free space"), ("KeyError", None)]
)
def test_hints(tmp_path, text, cure):
    """What snakemake itself could not write; other failures have their own messages."""
    log = tmp_path / "x.log"
    log.write_text(text)
    found = hints([str(log)])
    assert [cure in line for line in found] == ([True] if cure else [])
