"""Fixtures: copies of the repository in which the workflow can run and be disturbed."""

import runpy
import shutil

import pytest

from support import ROOT, Repository, copy_repository


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Keep what looks at the finished workflow in one process, so that it runs once.

    It comes first and what is quick comes last, so that several processes end together.
    """
    for item in items:
        if "smoke_run" in item.fixturenames:
            item.add_marker(pytest.mark.xdist_group("smoke"))
    items.sort(key=_turn)


def _turn(item):
    return "smoke_run" not in item.fixturenames, item.get_closest_marker("slow") is None


@pytest.fixture
def repository(tmp_path):
    """Return an untouched copy of the repository."""
    return copy_repository(tmp_path)


@pytest.fixture(scope="session")
def smoke_run(tmp_path_factory):
    """Return a repository in which the whole workflow has run at reduced sizes."""
    repository = copy_repository(tmp_path_factory.mktemp("smoke"))
    run = repository.snakemake("--cores", "2", "--", "all", "speed_against_error")
    assert run.returncode == 0, run.stderr[-4000:]
    return repository


@pytest.fixture
def finished(smoke_run, tmp_path):
    """Return a copy of the finished smoke run, to be disturbed."""
    folder = tmp_path / "copy"
    shutil.copytree(smoke_run.folder, folder, symlinks=True)
    return Repository(folder)


@pytest.fixture
def script():
    """Return a function that loads a script of the topic speed_against_error."""
    folder = ROOT / "workflow" / "scripts" / "speed_against_error"
    return lambda name: runpy.run_path(str(folder / f"{name}.py"))
