"""Other workflows use this one as a module: elsewhere, with a prefix and other parameters."""

import subprocess
import sys

import pytest
import yaml

from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from support import ROOT

SNAKEFILE = f"""
configfile: "config/mine.yaml"


module nonsmooth:
    snakefile:
        "{ROOT / "Snakefile"}"
    config:
        config["vibration"]
    prefix:
        "vibration"


use rule * from nonsmooth as nonsmooth_*


rule report:
    default_target: True
    input:
        rules.nonsmooth_crossing_asymptotic.output,
        rules.nonsmooth_table_1.output,
    output:
        "report.txt",
    shell:
        "ls {{input}} > {{output}}"
"""
CROSSING = {"scene": {"n": 50}, "outputs": 10}
STUDY = {
    "title": "Mine",
    "base": {"model": "friction"},
    "questions": {"spread": {"ask": "asymptotic_variance"}},
}
JOBS = ("tables/table_1", "crossing/asymptotic")


@pytest.fixture(scope="module")
def foreign(tmp_path_factory):
    """Return the folder of another workflow, which has a configuration of its own."""
    folder = tmp_path_factory.mktemp("foreign")
    (folder / "workflow").mkdir()
    (folder / "workflow" / "Snakefile").write_text(SNAKEFILE)
    (folder / "config").mkdir()
    mine = {"crossing": CROSSING, "outputs": {"results": "found"}, "studies": {"mine": STUDY}}
    mine = {"vibration": mine}
    (folder / "config" / "mine.yaml").write_text(yaml.safe_dump(mine))
    return folder


def snakemake(folder, *arguments):
    """Run the other workflow; return the finished process."""
    command = [sys.executable, "-m", "snakemake", "--cores", "1", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)


@pytest.mark.slow
def test_its_results_are_made_in_the_other_folder(foreign):
    """All files have the prefix; keys of its own replace those of config.yaml, the others stay."""
    run = snakemake(foreign)
    assert run.returncode == 0, run.stderr[-2000:]
    made = {path.relative_to(foreign).as_posix() for path in foreign.rglob("*") if path.is_file()}
    mine = {path for path in made if not path.startswith((".snakemake/", "config/", "workflow/"))}
    assert mine == {
        "report.txt",
        *(f"vibration/found/tables/table_1.{kind}" for kind in ("csv", "tex", "typ")),
        "vibration/found/crossing/asymptotic.nc",
        *(f"vibration/found/logs/{job}.log" for job in JOBS),
        *(
            f"vibration/found/benchmarks/{job}.tsv"
            for job in ("tables/table_1", "crossing/asymptotic")
        ),
    }
    data = artifact.read(foreign / "vibration/found/crossing/asymptotic.nc")
    assert data["horizon"].values.tolist() == pytest.approx(list(range(2, 21, 2)))
    assert str(Scene("friction", n=50.0)) in data.attrs["summary"]


@pytest.mark.slow
def test_all_of_it_can_be_asked_for(foreign):
    """Every job of the paper is found, with the sources of this repository, and of a study."""
    run = snakemake(foreign, "--dry-run", "nonsmooth_all", "nonsmooth_study_mine")
    assert run.returncode == 0, run.stderr[-2000:]
    assert "nonsmooth_paper" in run.stdout + run.stderr
    assert "vibration/found/studies/mine/report.html" in run.stdout + run.stderr
    run = snakemake(foreign, "--config", "vibration={seed: -3}", "--dry-run")
    assert run.returncode != 0
    assert "'seed'" in run.stderr
    wrong = "vibration={studies: {mine: {questions: {W: {ask: mean}}}}}"
    run = snakemake(foreign, "--config", wrong, "--dry-run", "nonsmooth_study_mine")
    assert run.returncode != 0
    assert "studies.mine" in run.stderr
