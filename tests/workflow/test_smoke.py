"""The whole workflow at reduced sizes: every rule, every figure and table, the same bytes."""

import hashlib
import json
import math
import re
import subprocess
import sys

import pandas as pd
import pytest
import typst

import nonsmooth as ns
from references import FRICTION
from reproduction.jobs import artifact
from support import ROOT

RESULTS = "results/smoke"
FIGURES = [f"figure_{name}" for name in ("1", "2a", "2b", *"3456789", "10", "12", "13")]
TABLES = [
    *(f"table_{name}" for name in (*"12345679", "7b", "10", "11", "12")),
    *(f"table_{name}" for name in ("potentials", "errata", "time_step")),
]
TABLES.append("speed_pde")


def test_every_figure_and_table_is_there(smoke_run):
    """They are there in all their formats, and so is the paper."""
    results = smoke_run.folder / RESULTS
    for name in FIGURES:
        assert (results / "figures" / f"{name}.pdf").read_bytes().startswith(b"%PDF")
        assert (results / "figures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    for name in TABLES:
        assert len(pd.read_csv(results / "tables" / f"{name}.csv")) >= 1
        tex = (results / "tables" / f"{name}.tex").read_text()
        assert tex.startswith(r"\begin{tabular}")
        assert r"\toprule" in tex
        assert r"\bottomrule" in tex
    assert (results / "paper.pdf").read_bytes().startswith(b"%PDF")
    assert (results / "figures" / "speed_pde.png").exists()
    assert not list(results.rglob(".*partial*"))


def test_every_artifact_is_described(smoke_run):
    """Units, long names, errors as ancillary variables, provenance; no clock time."""
    paths = sorted((smoke_run.folder / RESULTS).rglob("*.nc"))
    assert len(paths) > 20
    read = {path: artifact.read(path) for path in paths}
    assert len({data.attrs["id"] for data in read.values()}) == len(paths)
    for path, data in read.items():
        assert "lock sha256" in data.attrs["history"]
        assert not re.search(r"20\d\d-\d\d-\d\d", str(data.attrs))
        for name, variable in data.variables.items():
            assert {"units", "long_name"} <= variable.attrs.keys(), (path, name)


def test_every_artifact_has_a_log_and_a_benchmark(smoke_run):
    """Under its own name; the log has the checksum."""
    results = smoke_run.folder / RESULTS
    for path in results.rglob("*.nc"):
        name = path.relative_to(results)
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        log = (results / "logs" / name).with_suffix(".log").read_text()
        assert log == f"{digest}  {RESULTS}/{name}\ndone\n"
        assert (results / "benchmarks" / name).with_suffix(".tsv").exists()


def test_no_number_of_the_paper_is_typed():
    """The template holds no decimal number outside of lengths, sizes and section markup."""
    template = (ROOT / "paper" / "paper.typ").read_text()
    body = template[template.index("#align(center)") :]
    stripped = re.sub(r"\d+(\.\d+)?(pt|cm|em|%)", "", body)
    assert not re.search(r"\d+\.\d+", stripped)


def test_the_numbers_of_the_text_come_from_artifacts(smoke_run):
    """gamma^2 in the text is the spectral artifact's."""
    results = smoke_run.folder / RESULTS
    values = json.loads((results / "paper" / "values.json").read_text())
    gamma2 = float(artifact.read(results / "variance" / "spectral.nc")["gamma2"])
    assert float(values["variance"]["gamma2"]) == pytest.approx(gamma2, abs=1e-15)


def test_table_4_has_the_printed_values_beside_ours(smoke_run):
    """Our values round or truncate to the printed ones."""
    table = pd.read_csv(smoke_run.folder / RESULTS / "tables" / "table_4.csv").set_index("n")
    assert table.loc[2.0, "printed"] == 0.174466
    known = table["printed"].notna()
    assert (abs(table["printed"] - table["v_over_time"])[known] < 1.2e-6).all()
    off = abs(table["finite_difference"] - table["v_over_time"])[known]
    assert (off <= table["finite_difference_error"][known]).all()


def test_table_6_has_its_scene_within_its_errors(smoke_run):
    """One scene, dry friction, whose gamma^2 is the closed form's."""
    table = pd.read_csv(smoke_run.folder / RESULTS / "tables" / "table_6.csv").set_index("scene")
    assert len(table) == 1
    exact = ns.asymptotic_variance(FRICTION).value
    row = table.loc["friction_white"]
    allowed = 5 * math.hypot(row.gamma2_standard_error, row.bias_standard_error) + abs(row.bias)
    assert abs(row.gamma2 - exact) < allowed
    # a larger or a smaller probability than the limit's, but one
    assert table["W_10"].between(0, 1).all()
    assert (table["W_star_error"] < 0.1).all()


@pytest.mark.slow
def test_the_code_in_the_paper_runs(smoke_run):
    """It gives the last probability of the corrected formula, by another gamma^2 and kappa."""
    results = smoke_run.folder / RESULTS
    code = json.loads((results / "paper" / "values.json").read_text())["plasticity"]["code"]
    lines = code.replace("tol=0.05", "tol=0.1").splitlines()
    space = {}
    exec("\n".join([*lines[:-1], f"found = {lines[-1]}"]), space)
    check = artifact.read(results / "plasticity" / "check.nc")
    expected = check["corrected"].sel(limit=space["limit"], duration=space["duration"])
    # a relative error of gamma^2 of 0.1 changes W_star by at most 0.05, as |d W / d log b| < 1
    constants = artifact.read(results / "plasticity" / "variance.nc")
    lengths = float(constants["kappa_error"]) + space["kappa"].error
    assert abs(space["found"] - float(expected)) < 0.05 + 0.025 + lengths / space["limit"]
    assert 0 < space["found"] < 1


def test_tables_are_valid_typst(smoke_run, tmp_path):
    """Each compiles on its own."""
    for name in TABLES:
        source = smoke_run.folder / RESULTS / "tables" / f"{name}.typ"
        assert typst.compile(source.read_bytes()).startswith(b"%PDF")


@pytest.mark.slow
def test_one_core_gives_the_same_bytes_as_two(smoke_run):
    """Monte Carlo, solvers, a table and figures, recomputed elsewhere with one core."""
    elsewhere = "results/one_core"
    run = smoke_run.snakemake(
        "--cores",
        "1",
        "--config",
        f"outputs={{results: {elsewhere}, paper: {elsewhere}/paper.pdf}}",
        "--",
        "figure_2a",
        "figure_5",
        "table_1",
        f"{elsewhere}/crossing/p=10.nc",
        f"{elsewhere}/limit_theorem/samples/friction_white.nc",
        f"{elsewhere}/plasticity/limit=4.nc",
        f"{elsewhere}/convergence/finite_difference/n=2.nc",
    )
    assert run.returncode == 0, run.stderr[-3000:]
    first, second = smoke_run.folder / RESULTS, smoke_run.folder / elsewhere
    compared = 0
    for path in sorted(second.rglob("*")):
        if path.suffix in {".nc", ".png", ".pdf", ".csv", ".tex", ".typ"}:
            twin = first / path.relative_to(second)
            assert twin.read_bytes() == path.read_bytes(), path.name
            compared += 1
    assert compared >= 21


@pytest.mark.slow
def test_typesetting_again_gives_the_same_bytes(smoke_run):
    """The paper and what it quotes hold no clock time."""
    paths = [smoke_run.folder / RESULTS / name for name in ("paper.pdf", "paper/values.json")]
    before = [path.read_bytes() for path in paths]
    run = smoke_run.snakemake("--cores", "2", "--forcerun", "values", "--", "paper")
    assert run.returncode == 0
    assert "Typeset the paper" in run.stdout + run.stderr
    assert [path.read_bytes() for path in paths] == before


def test_second_run_has_nothing_to_do(smoke_run):
    """It says so."""
    run = smoke_run.snakemake("--cores", "2")
    assert run.returncode == 0
    assert "Nothing to be done" in run.stdout + run.stderr


@pytest.mark.slow
def test_progress_is_visible(repository):
    """What runs, and how far it is; the default profile says with how many cores."""
    run = repository.snakemake("--", "figure_1")
    assert run.returncode == 0
    output = run.stdout + run.stderr
    assert "Draw figure 1, the rheological models" in output
    assert "1 of 1 steps (100%) done" in output


def test_lint():
    """`snakemake --lint` has nothing to say."""
    run = subprocess.run(
        [sys.executable, "-m", "snakemake", "--lint"], cwd=ROOT, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stdout + run.stderr
