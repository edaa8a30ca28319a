"""Configuration files are read strictly: what is broken costs one line with file and line."""

import subprocess
import sys

import pytest
import yaml

from benchmarks.trials.mutations import BROKEN_TEXTS
from reproduction.configuration.command_line import require_readable
from reproduction.configuration.files import LARGEST_FILE, read
from reproduction.errors import ConfigError
from support import ROOT


@pytest.mark.parametrize("name", ["config.yaml", "config/smoke.yaml"])
def test_what_is_read_is_what_yaml_reads(name):
    """Reading strictly changes no value."""
    assert read(ROOT / name) == yaml.safe_load((ROOT / name).read_text())


@pytest.mark.parametrize(("kind", "text"), BROKEN_TEXTS.items())
def test_broken_texts(kind, text, tmp_path):
    """The message begins with the file; nothing in the file is run."""
    path = tmp_path / "mine.yaml"
    path.write_bytes(text)
    with pytest.raises(ConfigError) as error:
        read(path)
    assert str(error.value).startswith(f"{path}: ")
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < len(str(path)) + 200
    assert [file.name for file in tmp_path.iterdir()] == ["mine.yaml"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"seed: 1\n\nseed: 2\n", "line 3: the key 'seed' stands already in line 1"),
        (b"a:\n  b: 1\n  b: 2\n", "line 3: the key 'b' stands already in line 2"),
        (b"a: [1\nb: 2\n", "line 2, column 2: expected"),
        (b"a:\n\tb: 1\n", "line 2, column 1: a tab; indent with blanks"),
        (b"a: 1\n# \xe9\n", "line 2 is not UTF-8"),
        (b"a: 1\nb: !!python/name:os.system\n", "line 2: the tag"),
    ],
)
def test_lines(text, message, tmp_path):
    """They are those of the file."""
    path = tmp_path / "mine.yaml"
    path.write_bytes(text)
    with pytest.raises(ConfigError, match=message.replace("(", r"\(")):
        read(path)


def test_a_mark_of_the_byte_order_is_allowed(tmp_path):
    """Some editors write it."""
    path = tmp_path / "mine.yaml"
    path.write_bytes(b"\xef\xbb\xbfseed: 1\n")
    assert read(path) == {"seed": 1}


def test_what_is_no_modest_file(tmp_path):
    """A folder, a missing file, a device without end, a file that is too large."""
    large = tmp_path / "large.yaml"
    large.write_text("# " + "x" * LARGEST_FILE)
    for path in (tmp_path, tmp_path / "missing.yaml", "/dev/zero", large):
        with pytest.raises(ConfigError, match=r"a file that exists|bytes"):
            read(path)


def test_files_of_the_command_line(tmp_path, capsys):
    """Each is read, however the option is written; other options do not matter."""
    good, bad = tmp_path / "good.yaml", tmp_path / "bad.yaml"
    good.write_text("seed: 1\n")
    bad.write_text("seed: [1\n")
    require_readable(["--cores", "1", "--config", "seed=2", "--configfile", str(good), "--", "all"])
    require_readable([])
    for arguments in (
        ["--configfile", str(bad)],
        [f"--configfile={bad}", "all"],
        ["--configfiles", str(good), str(bad), "--dry-run"],
    ):
        with pytest.raises(SystemExit, match=r"error: .*bad\.yaml: line 2"):
            require_readable(arguments)


def test_importing_the_reader_is_quick():
    """It loads neither sympy nor numpy, because snakemake loads it each time."""
    program = "import reproduction.configuration.command_line, sys; print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert not {"sympy", "numpy", "scipy"} & set(run.stdout.split())
