"""Studies: from a file to a report, nothing computed twice, and one line about a bad one."""

import base64
import re

import pytest
import yaml

from reproduction.jobs import artifact
from support import ROOT

RESULTS = "results/smoke/studies/mine"
STUDY = {
    "title": "A < B & C",
    "base": {"model": "friction", "mass": "10 kg", "damping": "3 N s/m", "n": 10}
    | {"ground_spectral_density": "0.1 m^2/s^3"},
    "units": {"length": "mm"},
    "scenes": {"weak": {"slip_force": "5 N"}, "strong": {"slip_force": "9 N"}},
    "questions": {
        "spread": {"ask": "asymptotic_variance"},
        "slip": {"ask": "invariant_density"},
        "rim": {"ask": "crossing_probability", "threshold": ["1 m", "2 m"], "horizons": ["5 s"]},
    },
}
SWEEP = {
    "title": "A sweep",
    "base": {"model": "friction"},
    "sweep": {"damping": [0.5, 1], "n": [5, 10, 20]},
    "batch": 4,
    "questions": {"spread": {"ask": "asymptotic_variance"}},
}


def write(repository, study):
    """Write a configuration with a study; return the arguments that ask for it."""
    path = repository.folder / "mine.yaml"
    path.write_text(yaml.safe_dump({"studies": {"mine": study}}))
    return "--configfile", "config/smoke.yaml", "mine.yaml", "--cores", "2"


def rendered(repository, study):
    """Make the report; return its HTML."""
    run = repository.snakemake(*write(repository, study), "--", "studies")
    assert run.returncode == 0, run.stdout[-2000:] + run.stderr[-4000:]
    folder = repository.folder / RESULTS
    assert (folder / "report.pdf").read_bytes().startswith(b"%PDF")
    return (folder / "report.html").read_text(encoding="utf-8")


def jobs(repository, study):
    """Rules that would run for a study, from the output of a dry run."""
    run = repository.snakemake(*write(repository, study), "--dry-run", "--", "studies")
    assert run.returncode == 0, run.stderr
    rows = re.findall(r"^(study_\w+) +(\d+)$", run.stdout + run.stderr, re.MULTILINE)
    return {name: int(count) for name, count in rows}


@pytest.mark.slow
def test_a_study_becomes_a_report(repository):
    """It needs no other file, holds its netCDF files, and a changed scene is computed alone."""
    html = rendered(repository, STUDY)
    assert "A &lt; B &amp; C" in html
    # addresses are names of namespaces alone, and anchors
    assert not re.search(r"(src|href)=\"(?!#|data:)", html)
    assert not re.search(r"@import|url\((?!#)", html)
    held = re.findall(
        r'download="(\w+)-(\w+).nc" href="data:application/x-netcdf;base64,([^"]*)"', html
    )
    assert len(held) == 6
    for scene, question, content in held:
        path = repository.folder / RESULTS / scene / f"{question}.nc"
        assert base64.b64decode(content) == path.read_bytes()
    spread = artifact.read(repository.folder / RESULTS / "weak" / "spread.nc")
    assert spread["gamma2"].attrs["units"] == "mm2 s-1"
    assert f"{float(spread['gamma2']):.4g}"[:4] in html

    strong = {"slip_force": "8 N"}
    changed = STUDY | {"scenes": STUDY["scenes"] | {"strong": strong}}
    assert jobs(repository, changed) == {"study_answer": 3, "study_report": 1}
    # an answer depends on the modules of its question alone, and nothing is computed twice
    for module, wanted in (
        ("reliability/hazard", {}),
        ("crossing/tuning", {"study_answer": 2, "study_report": 1}),
    ):
        with open(repository.folder / f"src/nonsmooth/{module}.py", "a") as file:
            file.write("# changed\n")
        assert jobs(repository, STUDY) == wanted
    (repository.folder / "src/nonsmooth/crossing/tuning.py").write_bytes(
        (ROOT / "src/nonsmooth/crossing/tuning.py").read_bytes()
    )
    asked = STUDY["questions"] | {"bias": {"ask": "mean"}}
    assert jobs(repository, STUDY | {"questions": asked}) == {"study_answer": 2, "study_report": 1}


@pytest.mark.slow
def test_a_sweep_computes_new_scenes_alone(repository):
    """Its scenes share jobs; what is kept is not computed again, to the byte."""
    html = rendered(repository, SWEEP)
    assert "in 2 jobs" in html
    store = repository.folder / RESULTS / "store"
    before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in store.iterdir()}
    assert len(before) == 6
    rendered(repository, SWEEP | {"sweep": SWEEP["sweep"] | {"n": [5, 10, 20, 40]}})
    assert len(list(store.iterdir())) == 8
    assert all((path.read_bytes(), path.stat().st_mtime_ns) == was for path, was in before.items())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"titel": "x"}, "error: studies.mine: unknown key 'titel'; did you mean 'title'?"),
        pytest.param(
            {"scenes": {"weak": {"slip_force": "5 mm"}}},
            "error: studies.mine: 'scenes.weak.slip_force': 'slip_force': '5 mm' is no quantity",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_bad_study(repository, change, message):
    """It is refused before anything runs, in one line and nothing else; other targets run."""
    arguments = write(repository, STUDY | change)
    run = repository.snakemake(*arguments, "--dry-run", "--", "studies")
    assert run.returncode != 0
    assert sum(message in line for line in run.stderr.splitlines()) == 1
    assert "Traceback" not in run.stdout + run.stderr
    assert repository.snakemake(*arguments, "--dry-run", "--", "table_2").returncode == 0


def test_a_bad_file_of_a_study(repository):
    """The line names it."""
    (repository.folder / "studies" / "broken.yaml").write_text("title: [\n")
    run = repository.snakemake("--dry-run", "--", "study_broken")
    assert run.returncode != 0
    assert sum("error: studies/broken.yaml: line" in line for line in run.stderr.splitlines()) == 1
    assert "Traceback" not in run.stdout + run.stderr
