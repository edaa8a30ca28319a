"""The README keeps its promises, and so does the page on what the results hold."""

import re
from contextlib import redirect_stdout
from fnmatch import fnmatch
from io import StringIO

from reproduction.jobs import artifact
from support import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
RESULTS = (ROOT / "results" / "README.md").read_text(encoding="utf-8")


def test_it_is_short():
    """The README has at most 900 words."""
    assert len(README.split()) <= 900


def test_example_prints_what_is_shown():
    """The scene in ten lines, with its output."""
    code, shown = re.search(
        r"```python\n(.*?)```\s*```\n(.*?)```", README, flags=re.DOTALL
    ).groups()
    printed = StringIO()
    with redirect_stdout(printed):
        exec(compile(code, "README", "exec"), {})
    assert printed.getvalue() == shown


def test_named_files_exist():
    """What it links to is in the repository, and so is what the manual's pages link to."""
    for page in (ROOT / "README.md", ROOT / "CONTRIBUTING.md"):
        for name in re.findall(r"\]\(((?!http)[^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / name).exists(), (page.name, name)


def test_named_modules_exist():
    """The way of a number goes through files that are there."""
    page = (ROOT / "docs" / "how_a_number_is_made.md").read_text(encoding="utf-8")
    named = re.findall(r"`((?:src|workflow|paper)/[\w/]+\.\w+)`", page)
    assert len(named) > 15
    for name in named:
        assert (ROOT / name).exists(), name


def test_every_artifact_is_listed(smoke_run):
    """It is listed with its variables; their errors are beside them by a rule."""
    rows = dict(re.findall(r"^\| `([^`]+\.nc)` \| (.*) \|$", RESULTS, flags=re.MULTILINE))
    folder = smoke_run.folder / "results" / "smoke"
    for path in sorted(folder.rglob("*.nc")):
        name = path.relative_to(folder).as_posix()
        found = [text for row, text in rows.items() if fnmatch(name, re.sub("<.*?>", "*", row))]
        assert found, f"results/README.md does not list {name}"
        listed = set(re.findall(r"`(\w+)`", " ".join(found)))
        own = {str(v) for v in artifact.read(path).variables}
        own -= {f"{v}_error" for v in own}
        assert own <= listed, (name, own - listed)
