"""Bad input to the workflow: one clear line, a non-zero exit, nothing half-written."""

import shutil

import netCDF4
import numpy as np
import pytest
import xarray as xr
import yaml

from reproduction.errors import ArtifactError
from reproduction.jobs import artifact

RESULTS = "results/smoke"


def slow(*values):
    """Mark what runs the workflow once more."""
    return pytest.param(*values, marks=pytest.mark.slow)


def lines_with(run, text):
    """Lines of the output that contain a text."""
    return [line for line in (run.stdout + run.stderr).splitlines() if text in line]


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("alhpa=1", "error: --config: unknown key 'alhpa'"),
        ("seed=-3", "error: --config: 'seed' = -3: must be at least 0"),
        ("crossing={treshold: 1}", "did you mean 'threshold'?"),
        ("crossing={scene: {model: obstacle}}", "has the state (y, x)"),
        ("outputs={results: config.yaml/results}", "is no folder"),
    ],
)
def test_bad_configuration(repository, setting, message):
    """It is refused before anything runs, in one line and nothing else."""
    run = repository.snakemake("--cores", "1", "--config", setting)
    assert run.returncode != 0
    assert len(lines_with(run, message)) == 1
    assert "Traceback" not in run.stdout + run.stderr
    assert not (repository.folder / "results").exists()


def test_a_configuration_does_not_run_code(repository):
    """A command hidden in a formula is refused and not run, also in a dry run."""
    text = "exp(\"__import__('os').system('touch hacked')\")"
    path = repository.folder / "stranger.yaml"
    path.write_text(yaml.safe_dump({"crossing": {"scene": {"observable": text}}}))
    run = repository.snakemake("--cores", "1", "--dry-run", "--configfile", str(path))
    assert run.returncode != 0
    assert len(lines_with(run, "cannot read the formula")) == 1
    assert not list(repository.folder.rglob("hacked"))


def truncated(path):
    """Keep half of the file."""
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def flipped(path):
    """Change one bit of the data."""
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def with_nan(path):
    """Let another program write NaN."""
    with netCDF4.Dataset(path, "r+") as file:
        file["x"][0, 0] = np.nan


def foreign(path):
    """Let another program write other variables and dimensions, with the attributes of ours."""
    data = xr.load_dataset(path)
    path.unlink()
    data.drop_vars("y").isel(t=slice(10)).to_netcdf(path)


def of_another_model(path):
    """Put another artifact in its place."""
    path.write_bytes(path.with_name("obstacle.nc").read_bytes())


@pytest.mark.parametrize("damage", [truncated, with_nan, foreign])
def test_artifacts_of_other_programs(smoke_run, tmp_path, damage):
    """What a rule reads with is told whatever happened to a file."""
    source = tmp_path / "trajectories" / "friction.nc"
    shutil.copytree(smoke_run.folder / RESULTS / source.parent.name, source.parent)
    assert artifact.read(source).sizes
    damage(source)
    message = r"is truncated, changed, or no artifact.*delete it and run snakemake again"
    with pytest.raises(ArtifactError, match=message):
        artifact.read(source)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (flipped, " is damaged"),
        slow(of_another_model, ": it is trajectories/obstacle.nc under another name"),
    ],
)
def test_damaged_artifact(finished, damage, message):
    """A rule that reads a damaged file names it and its cure, and leaves nothing half-written."""
    source = finished.folder / RESULTS / "trajectories" / "friction.nc"
    damage(source)
    run = finished.snakemake("--cores", "1", "--force", "--", "figure_5")
    assert run.returncode != 0
    message = f"error: {RESULTS}/trajectories/friction.nc{message}"
    (line,) = lines_with(run, message)
    assert "delete it and run snakemake again" in line
    log = (finished.folder / RESULTS / "logs" / "figures" / "figure_5.log").read_text()
    assert log.startswith("Traceback")
    assert not (finished.folder / RESULTS / "figures" / "figure_5.pdf").exists()
    assert not list((finished.folder / RESULTS).rglob(".*partial*"))


@pytest.mark.parametrize(
    "name", [slow("tables/table_5.typ"), slow("figures/figure_1.pdf"), "paper/values.json"]
)
def test_the_paper_quotes_nothing_damaged(finished, name):
    """One digit or byte of what it includes is another."""
    path = finished.folder / RESULTS / name
    content = bytearray(path.read_bytes())
    place = max(k for k, byte in enumerate(content) if byte in b"12345678")
    content[place] += 1
    path.write_bytes(content)
    run = finished.snakemake("--cores", "1", "--force", "--rerun-triggers", "input", "--", "paper")
    assert run.returncode != 0
    (line,) = lines_with(run, f"error: {RESULTS}/{name} is damaged or changed")
    assert f"delete {RESULTS}/{name} and run snakemake again" in line
