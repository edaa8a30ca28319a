"""A killed run leaves its folder locked; the next one unlocks it unless another run is alive."""

import subprocess
import sys
import time

import psutil
import pytest

from workflow.unlock import alive, main, unlock

SNAKEMAKE = [sys.executable, "-m", "snakemake", "--cores", "1", "--", "figure_1"]


@pytest.fixture
def locked(repository):
    """Return a repository and a run in it that holds its locks."""
    run = subprocess.Popen(
        SNAKEMAKE, cwd=repository.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    deadline = time.monotonic() + 100
    while not list(repository.folder.glob(".snakemake/locks/*.output.lock")):
        assert run.poll() is None, "the run ended before it was seen"
        assert time.monotonic() < deadline
        time.sleep(0.02)
    run.suspend = psutil.Process(run.pid).suspend
    yield repository, run
    if run.poll() is None:
        run.kill()
        run.wait()


def again(repository):
    """Run the same once more."""
    return subprocess.run(
        SNAKEMAKE, cwd=repository.folder, capture_output=True, text=True, timeout=600
    )


@pytest.mark.slow
def test_a_killed_run_is_taken_up(locked):
    """Its locks refuse the next run; they are removed, and it completes."""
    repository, run = locked
    run.kill()
    run.wait()
    refused = again(repository)
    assert refused.returncode != 0
    assert "--unlock" in refused.stdout + refused.stderr
    assert len(unlock(repository.folder)) == 2
    assert again(repository).returncode == 0
    assert (repository.folder / "results/figures/figure_1.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.slow
def test_a_run_that_is_alive_keeps_its_locks(locked):
    """It is found by its folder, even if it does nothing; another folder's runs do not matter."""
    repository, run = locked
    run.suspend()
    assert [process.pid for process in alive(repository.folder)] == [run.pid]
    assert not list(alive(repository.folder / "workflow"))
    assert unlock(repository.folder) == []
    assert again(repository).returncode != 0
    psutil.Process(run.pid).resume()
    assert run.wait(timeout=100) == 0


@pytest.mark.parametrize("damage", ["a file", "a folder", "bytes"])
def test_damaged_records_cost_a_line(tmp_path, monkeypatch, damage):
    """No traceback, and nothing is unlocked that may be in use."""
    state = tmp_path / ".snakemake"
    if damage == "a file":
        state.write_text("")
    elif damage == "a folder":
        (state / "unlocking").mkdir(parents=True)
    else:
        (state / "locks").mkdir(parents=True)
        (state / "locks/0.output.lock").write_text("results/a\n")
        (state / "unlocking").write_bytes(b"\xff\xfe")
        assert unlock(tmp_path) == []
        return
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit, match=r"^error: .snakemake[^\n]*; delete it"):
        main()


def test_a_run_on_another_machine_keeps_its_locks(tmp_path):
    """Its processes cannot be seen."""
    assert unlock(tmp_path) == []
    (tmp_path / ".snakemake/locks").mkdir()
    lock = tmp_path / ".snakemake/locks/0.output.lock"
    lock.write_text("results/a\n")
    (tmp_path / ".snakemake/unlocking").write_text("far.away")
    assert unlock(tmp_path) == []
    (tmp_path / ".snakemake/unlocking").unlink()
    assert unlock(tmp_path) == [lock]
