"""Bad input to the workflow: one clear line, a non-zero exit, nothing half-written."""

import pytest
import xarray as xr

RESULTS = "results/smoke"


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


@pytest.mark.parametrize("damage", ["truncated", "foreign"])
def test_damaged_artifact(finished, damage):
    """A rule that reads a damaged file names it and its cure, and leaves nothing half-written."""
    source = finished.folder / RESULTS / "trajectories" / "friction.nc"
    good = source.read_bytes()
    source.unlink()
    if damage == "truncated":
        source.write_bytes(good[: len(good) // 2])
        message = "friction.nc is not a readable netCDF file"
    else:
        xr.Dataset({"x": ("time", [1.0, 2.0])}).to_netcdf(source)
        message = "friction.nc was not written by this package"
    run = finished.snakemake("--cores", "1", "--force", "--", "figure_5")
    assert run.returncode != 0
    assert len(lines_with(run, f"error: {RESULTS}/trajectories/{message}")) == 1
    log = (finished.folder / RESULTS / "logs" / "figures" / "figure_5.log").read_text()
    assert log.startswith("Traceback")
    assert message in log
    assert not list((finished.folder / RESULTS).rglob(".*partial*"))
