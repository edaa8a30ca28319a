"""The artifacts keep to the conventions that they name, CF-1.11."""

import json
import subprocess

import pytest

from support import ROOT

CHECKER = ROOT / ".venv-checkers" / "bin" / "compliance-checker"


@pytest.mark.skipif(not CHECKER.exists(), reason="needs .venv-checkers: make checkers")
def test_cf(smoke_run, tmp_path):
    """The checker finds neither errors nor warnings in any of them."""
    paths = sorted(map(str, smoke_run.folder.rglob("*.nc")))
    report = tmp_path / "report.json"
    options = ["--test", "cf:1.11", "--criteria", "strict", "--format", "json_new"]
    command = [CHECKER, *options, "--output", report, *paths]
    run = subprocess.run(command, capture_output=True, text=True)
    assert report.exists(), run.stdout + run.stderr
    checked = json.loads(report.read_text())
    assert sorted(checked) == paths
    found = {
        (path, message)
        for path, suites in checked.items()
        for priority in ("high_priorities", "medium_priorities", "low_priorities")
        for check in suites["cf:1.11"][priority]
        for message in check["msgs"]
    }
    assert not found
    assert run.returncode == 0, run.stdout + run.stderr
