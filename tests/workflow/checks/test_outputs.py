"""Outputs go where outputs belong: a place where something would be lost is refused."""

from pathlib import Path

import pytest

from benchmarks.trials.mutations import OUTPUTS
from reproduction.errors import ConfigError
from workflow.checks import outputs
from workflow.checks.outputs import check_outputs

USUAL = {"results": "results", "paper": "paper/paper.pdf"}


@pytest.fixture
def root(tmp_path, monkeypatch):
    """Return a folder like the repository, but without git, as of a tarball."""
    root = tmp_path / "repository"
    for name in ("src", "workflow", "tests", "docs", "config", "results", "paper", ".venv"):
        (root / name).mkdir(parents=True)
    for name in ("README.md", "config.yaml", "paper/paper.typ", "docs/speed_pde.pdf"):
        (root / name).write_text("a source\n")
    monkeypatch.setattr(outputs, "ROOT", root)
    outputs.tracked.cache_clear()
    yield root
    outputs.tracked.cache_clear()


def refused(changes):
    """Return the message about outputs that differ from the usual ones."""
    with pytest.raises(ConfigError) as error:
        check_outputs(USUAL | changes)
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 400
    return str(error.value)


@pytest.mark.parametrize(
    ("key", "value"), [(key, value) for key, values in OUTPUTS.items() for value in values]
)
def test_bad_outputs_without_git(root, key, value):
    """They are refused where there is no git to ask, in a line that names the key."""
    assert f"'outputs.{key}'" in refused({key: value})


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("results", "../another/.git"),
        ("paper", "../another/.git/paper.pdf"),
        ("results", "/mnt"),
        ("results", "/lib32/x"),
        ("paper", "*.pdf"),
    ],
)
def test_outputs_in_what_is_not_ours(root, key, value):
    """In the records of another repository, in what many share, in what a shell would expand."""
    assert f"'outputs.{key}'" in refused({key: value})


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"results": "results/smoke", "paper": "results/smoke/paper.pdf"},
        {"results": "results/für uns und andere", "paper": "results/ä b.pdf"},
        {"results": "../elsewhere"},
        {"results": "out", "paper": "paper.pdf"},
    ],
)
def test_good_outputs(root, changes):
    """The usual ones, others inside and outside, blanks and umlauts."""
    check_outputs(USUAL | changes)


def test_folders_elsewhere(root, tmp_path):
    """By their full names, and through a link, but not through one that leads to sources."""
    check_outputs({"results": str(tmp_path / "out"), "paper": str(tmp_path / "out/paper.pdf")})
    (root / "large").symlink_to(tmp_path)
    (root / "linked").symlink_to(root / "src")
    (root / "loop").symlink_to(root / "loop")
    check_outputs(USUAL | {"results": "large/out"})
    assert "lies in 'src'" in refused({"results": "linked/out"})
    assert "lies in 'src'" in refused({"results": str(root / "src")})
    assert "link" in refused({"results": "loop"})


def test_home_is_no_folder_for_results(root):
    """What holds everything would hold the results, too."""
    assert "choose a folder below it" in refused({"results": str(Path.home())})


def test_a_file_that_this_workflow_did_not_typeset_is_kept(root):
    """Somebody's own PDF; but an earlier paper, or an interrupted one, is overwritten."""
    (root / "mine.pdf").write_bytes(b"%PDF-1.7 by hand")
    assert "was not typeset by this workflow" in refused({"paper": "mine.pdf"})
    (root / "mine.pdf").write_bytes(b"%PDF-1.7 /Creator (Typst 0.14)")
    check_outputs(USUAL | {"paper": "mine.pdf"})
    (root / "mine.pdf").write_bytes(b"")
    check_outputs(USUAL | {"paper": "mine.pdf"})


def test_what_git_tracks_is_kept(monkeypatch):
    """Whatever it is called."""
    outputs.tracked.cache_clear()
    if not outputs.tracked():
        pytest.skip("no git here")
    monkeypatch.setattr(outputs, "tracked", lambda: [outputs.ROOT / "new/thesis.pdf"])
    assert "which git tracks" in refused({"paper": "new/thesis.pdf"})
    assert "which git tracks" in refused({"results": "new"})
    check_outputs(USUAL)
