"""Files are written whole or not at all; the message names the reason and its cure."""

import errno
import os
import resource
import subprocess
import sys

import pytest

from reproduction.errors import ArtifactError
from reproduction.jobs.files import write_whole


def test_content_and_folders(tmp_path):
    """Folders are made, an older file is replaced, and nothing else stays."""
    path = tmp_path / "deep" / "x.csv"
    for content in (b"old", b"new"):
        write_whole(path, content)
    assert path.read_bytes() == b"new"
    assert [p.name for p in path.parent.iterdir()] == ["x.csv"]


@pytest.mark.parametrize(
    ("number", "message"),
    [
        (errno.ENOSPC, r"x\.csv, 3 bytes \(No space left.*\); \d+ bytes are free in /.*; free"),
        (errno.EDQUOT, "your quota there is used up; free some"),
        (errno.EROFS, "its disk can only be read; set outputs to a folder on another"),
        (errno.EIO, "the disk fails"),
        (errno.EACCES, "make its folder writable"),
    ],
)
@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_the_cure_is_that_of_the_reason(tmp_path, monkeypatch, number, message, step):
    """Whatever step fails, one line is raised, and the older file stays."""
    path = tmp_path / "x.csv"
    write_whole(path, b"old")

    def fail(*arguments):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(os, step, fail)
    with pytest.raises(ArtifactError, match=message) as error:
        write_whole(path, b"new")
    assert "\n" not in str(error.value)
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["x.csv"]


def test_a_file_in_the_place_of_the_folder(tmp_path):
    """And a folder in the place of the file."""
    (tmp_path / "results").write_text("")
    for name in ("results/x.nc", "results/deep/x.nc"):
        with pytest.raises(ArtifactError, match="remove the file that is in the place"):
            write_whole(tmp_path / name, b"")
    (tmp_path / "x.nc").mkdir()
    with pytest.raises(ArtifactError, match="remove the folder of this name"):
        write_whole(tmp_path / "x.nc", b"")


def test_a_write_that_stops_half_way(tmp_path):
    """A real limit on the size of files: nothing is half-written."""
    program = (
        "from reproduction.jobs.files import write_whole\nwrite_whole('x.nc', bytes(100_000))\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000)),
    )
    assert "cannot write x.nc (File too large); raise the limit" in run.stderr
    assert list(tmp_path.iterdir()) == []
