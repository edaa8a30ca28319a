"""The README keeps its promises."""

import re
import subprocess
import sys

from conftest import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_rule_graph_is_the_workflows():
    """The drawn edges are those snakemake reports."""
    run = subprocess.run(
        [sys.executable, "-m", "snakemake", "--rulegraph", "mermaid-js"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    names = dict(re.findall(r"(id\d+)\[(.*?)\]", run.stdout))
    edges = {(names[a], names[b]) for a, b in re.findall(r"(id\d+) --> (id\d+)", run.stdout)}
    drawn = set(re.findall(r"^  (\w+) --> (\w+)$", README, flags=re.MULTILINE))
    assert drawn == edges


def test_example_runs():
    """The Python example, with few paths."""
    code = re.search(r"```python\n(.*?)```", README, flags=re.DOTALL)[1]
    exec(
        compile(
            code.replace("p=10, tol=0.01", "p=1, tol=0.05"),
            "README",
            "exec",
        ),
        {},
    )


def test_named_scripts_exist():
    """The table names files of the repository."""
    for script in re.findall(r"`(\w+/[\w*]+\.py)`", README):
        assert list((ROOT / "workflow" / "scripts").glob(script)), script
