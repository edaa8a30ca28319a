"""Errors that the user can mend are one line, whatever else fails."""

import errno
from types import SimpleNamespace

import numpy as np
import pytest

from reproduction.errors import ArtifactError, CheckError
from reproduction.jobs.job import job, require_as_written


def task(log, *output):
    """Return what snakemake hands over."""
    return SimpleNamespace(log=[log], output=output)


def fails(log, error, capsys):
    """Run a job that raises; return what it prints."""
    with pytest.raises(SystemExit) as exit, job(task(log)):
        raise error
    assert exit.value.code == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    return printed.err.splitlines()


def test_the_log_has_the_traceback(tmp_path, capsys):
    """And the message is one line."""
    log = tmp_path / "logs" / "x.log"
    assert fails(log, CheckError("a is b; do c"), capsys) == ["error: a is b; do c"]
    assert log.read_text().startswith("Traceback")
    with job(task(log)):
        pass
    assert log.read_text() == "done\n"


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_full_disk_under_a_cache(tmp_path, capsys, number):
    """Where a library writes, not the job."""
    error = OSError(number, "full", "cache.nbi")
    (line,) = fails(tmp_path / "x.log", error, capsys)
    assert line.startswith("error: cannot write a cache or a temporary file ([Errno")
    assert "full: 'cache.nbi'); free space" in line


def test_memory_short(tmp_path, capsys):
    """NumPy says how much was wanted."""
    with pytest.raises(MemoryError) as error:
        np.empty(2**56)
    (line,) = fails(tmp_path / "x.log", error.value, capsys)
    assert line.startswith("error: not enough memory (Unable to allocate 512. PiB")
    assert "--cores 1" in line


def test_a_log_that_cannot_be_written(tmp_path, capsys):
    """It hides neither the message nor the result."""
    (tmp_path / "logs").write_text("")
    log = tmp_path / "logs" / "x.log"
    first, second = fails(log, CheckError("a is b; do c"), capsys)
    assert first.startswith(f"warning: cannot write {log}")
    assert second == "error: a is b; do c"
    with job(task(log)):
        pass
    assert capsys.readouterr().err.startswith("warning: cannot write")


def test_other_errors_keep_their_traceback(tmp_path):
    """They are mistakes of the program."""
    with pytest.raises(KeyError), job(task(tmp_path / "x.log")):
        raise KeyError("x")
    assert "KeyError" in (tmp_path / "x.log").read_text()


def test_the_log_has_the_checksums_of_the_output(tmp_path, monkeypatch):
    """So that a change is found; the log is missing, cut or of another file: refused too."""
    monkeypatch.chdir(tmp_path)
    output, log = tmp_path / "x.pdf", tmp_path / "x.log"
    with job(task(log, output)):
        output.write_bytes(b"figure")
    require_as_written(output, log)
    output.write_bytes(b"figurf")
    with pytest.raises(ArtifactError, match=r"x\.pdf is damaged or changed.*delete"):
        require_as_written(output, log)
    for content in (b"", b"done\n", b"\xff"):
        log.write_bytes(content)
        with pytest.raises(ArtifactError, match=r"x\.pdf"):
            require_as_written(output, log)
    log.unlink()
    with pytest.raises(ArtifactError, match="cannot compare"):
        require_as_written(output, log)
