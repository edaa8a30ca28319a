"""The run packed as a Provenance Run RO-Crate: complete, valid, and read by `runcrate`."""

import hashlib
import json
import shutil
import subprocess
from urllib.parse import unquote
from zipfile import ZipFile

import pytest

from support import ROOT

CHECKERS = ROOT / ".venv-checkers" / "bin"
pytestmark = pytest.mark.skipif(
    not CHECKERS.exists(), reason="needs the environment that make checkers installs"
)
RUN = ("process/0.5", "workflow/0.5", "provenance/0.5")


def pack(repository):
    """Run the program on the smoke run of a copy of the repository."""
    for name in ("CITATION.cff", "LICENSE", "README.md"):
        shutil.copy(ROOT / name, repository.folder)
    return subprocess.run(
        [
            CHECKERS / "python",
            "workflow/crate.py",
            "--config",
            "config/smoke.yaml",
            "--agent",
            "A. Person",
        ],
        cwd=repository.folder,
        capture_output=True,
        text=True,
    )


@pytest.fixture(scope="module")
def packed(smoke_run):
    """Return the zip file."""
    run = pack(smoke_run)
    assert run.returncode == 0, run.stderr
    return smoke_run.folder / "results" / "smoke" / "crate.zip"


@pytest.fixture(scope="module")
def graph(packed):
    """Return the entities by their identifiers."""
    with ZipFile(packed) as file:
        content = json.loads(file.read("ro-crate-metadata.json"))
    entities = {entity["@id"]: entity for entity in content["@graph"]}
    assert len(entities) == len(content["@graph"])
    return entities


def of_type(graph, name):
    """Return the entities of a type."""
    return [entity for entity in graph.values() if name in as_list(entity["@type"])]


def as_list(value):
    """Return a list, of one element unless it is one."""
    return value if isinstance(value, list) else [value]


def refs(entity, name):
    """Return the identifiers that a property refers to."""
    return [item["@id"] for item in as_list(entity.get(name, []))]


def test_runcrate_reads_it(packed, graph):
    """It reports every action."""
    report = subprocess.run(
        [CHECKERS / "runcrate", "report", packed], capture_output=True, text=True
    )
    assert report.returncode == 0, report.stderr
    actions = report.stdout.count("action: ")
    assert actions == len(of_type(graph, "CreateAction")) > 50


def test_it_keeps_what_the_profiles_require(graph):
    """All that they say with MUST, and the references lead to entities of the crate."""
    root = graph["./"]
    assert {f"https://w3id.org/ro/wfrun/{name}" for name in RUN} <= set(refs(root, "conformsTo"))
    assert {"name", "description", "datePublished", "license"} <= root.keys()
    (main,) = refs(root, "mainEntity")
    workflow = graph[main]
    assert {"File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"} <= set(
        workflow["@type"]
    )
    language = graph[refs(workflow, "programmingLanguage")[0]]
    assert (language["@type"], language["name"]) == ("ComputerLanguage", "Snakemake")
    actions = of_type(graph, "CreateAction")
    (whole,) = (a for a in actions if refs(a, "instrument") == [main])
    runs = [a for a in actions if a is not whole]
    tools = {refs(run, "instrument")[0] for run in runs}
    assert tools <= set(refs(workflow, "hasPart"))
    assert {a["@id"] for a in actions} == set(refs(root, "mentions"))
    steps = {step["@id"]: step for step in of_type(graph, "HowToStep")}
    assert steps.keys() == set(refs(workflow, "step"))
    assert {refs(step, "workExample")[0] for step in steps.values()} == tools
    controls = of_type(graph, "ControlAction")
    assert {refs(c, "object")[0] for c in controls} == {run["@id"] for run in runs}
    assert {refs(c, "instrument")[0] for c in controls} == steps.keys()
    (engine,) = of_type(graph, "OrganizeAction")
    assert graph[refs(engine, "instrument")[0]]["name"] == "snakemake"
    assert refs(engine, "result") == [whole["@id"]]
    assert set(refs(engine, "object")) == {c["@id"] for c in controls}
    for entity in graph.values():
        if entity is not language:  # the library describes it, with addresses of its own
            for name in entity.keys() - {"conformsTo"}:
                targets = {
                    value["@id"] for value in as_list(entity[name]) if isinstance(value, dict)
                }
                assert targets <= graph.keys(), (entity["@id"], name)


def test_every_file_is_in_it_with_its_checksum(packed, graph):
    """And nothing else; all artifacts of the paper, the configuration, the lock and the licence."""
    files = {unquote(entity["@id"]): entity for entity in of_type(graph, "File")}
    with ZipFile(packed) as file:
        names = set(file.namelist()) - {"ro-crate-metadata.json"}
        assert names == files.keys()
        for name in names:
            assert files[name]["sha256"] == hashlib.sha256(file.read(name)).hexdigest(), name
    results = packed.parent
    artifacts = {
        path.relative_to(results).as_posix()
        for path in results.rglob("*.nc")
        if path.relative_to(results).parts[0] not in {"speed_against_error"}
    }
    assert {f"results/smoke/{name}" for name in artifacts} <= names
    assert {"config.yaml", "config/smoke.yaml", "environment-lock.txt", "LICENSE"} <= names
    assert {"Snakefile", "workflow/rules/common.smk", "workflow/experiment.py"} <= names
    root = results.parents[1]
    modules = {path.relative_to(root).as_posix() for path in (root / "src").rglob("*.py")}
    assert modules <= names


def test_an_artifact_leads_to_what_made_it(graph):
    """Rule, parameters, inputs, times and who ran it."""
    name = "results/smoke/variance/check.nc"
    (run,) = (a for a in of_type(graph, "CreateAction") if refs(a, "result") == [name])
    assert run["name"] == f"rule check_variance: {name}"
    assert refs(run, "instrument") == ["workflow/scripts/variance/check.py"]
    made_from = {f"results/smoke/variance/{k}.nc" for k in ("spectral", "monte_carlo")}
    assert made_from < set(refs(run, "object"))
    assert run["startTime"] <= run["endTime"]
    assert graph[refs(run, "agent")[0]]["name"] == "A. Person"
    (shard,) = (
        a
        for a in of_type(graph, "CreateAction")
        if refs(a, "result") == ["results/smoke/variance/shards/0.nc"]
    )
    assert "friction" in shard["description"]


def test_a_run_that_has_changed_is_refused(finished):
    """In one line that names the file; so is one that is not finished. The old crate stays."""
    results = finished.folder / "results" / "smoke"
    (results / "crate.zip").write_bytes(b"old")
    with open(results / "variance" / "spectral.nc", "ab") as file:
        file.write(b"x")
    run = pack(finished)
    assert run.returncode == 1
    assert run.stderr.startswith("error: results/smoke/variance/spectral.nc has changed since")
    (results / "paper.pdf").unlink()
    run = pack(finished)
    assert (run.returncode, run.stderr) == (
        1,
        "error: results/smoke/paper.pdf does not exist; run make paper first\n",
    )
    assert (results / "crate.zip").read_bytes() == b"old"
