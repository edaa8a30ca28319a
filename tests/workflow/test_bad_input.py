"""Bad input to the workflow: one clear line, a non-zero exit, nothing half-written."""

import pytest
import xarray as xr

# tests that share the smoke run share a worker
pytestmark = pytest.mark.xdist_group("smoke")

RESULTS = "results/smoke"


def lines_with(run, text):
    """Lines of the output that contain a text."""
    return [line for line in (run.stdout + run.stderr).splitlines() if text in line]


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("alhpa=1", "error: config: unknown key 'alhpa'"),
        ("seed=-3", "error: config: 'seed' = -3: must be at least 0"),
        ("crossing={treshold: 1}", "did you mean 'threshold'?"),
        ("crossing={scene: {model: obstacle}}", "has the state (y, x)"),
        ("outputs={results: config.yaml/results}", "cannot write into 'config.yaml'"),
    ],
)
def test_bad_configuration(repository, setting, message):
    """Refused before anything runs, in one line and nothing else."""
    run = repository.snakemake("--cores", "1", "--config", setting)
    assert run.returncode != 0
    assert len(lines_with(run, message)) == 1
    assert "Traceback" not in run.stdout + run.stderr
    assert not (repository.folder / "results").exists()


def test_truncated_artifact(smoke_run):
    """A rule that reads a damaged file names it and its cure, and leaves its output alone."""
    source = smoke_run.folder / RESULTS / "trajectories" / "friction.nc"
    figure = smoke_run.folder / RESULTS / "figures" / "figure_5.png"
    good = source.read_bytes()
    try:
        source.write_bytes(good[: len(good) // 2])
        run = smoke_run.snakemake("--cores", "1", "--force", "--", "figure_5")
        assert run.returncode != 0
        assert lines_with(run, "friction.nc is not a readable netCDF file")
        assert not list(figure.parent.glob(".*partial*"))
    finally:
        source.write_bytes(good)
        assert smoke_run.snakemake("--cores", "2").returncode == 0


def test_foreign_artifact(smoke_run):
    """A netCDF file of somebody else's is not taken for ours."""
    source = smoke_run.folder / RESULTS / "trajectories" / "friction.nc"
    good = source.read_bytes()
    try:
        source.unlink()
        xr.Dataset({"x": ("time", [1.0, 2.0])}).to_netcdf(source)
        run = smoke_run.snakemake("--cores", "1", "--force", "--", "figure_5")
        assert run.returncode != 0
        assert lines_with(run, "was not written by this package")
    finally:
        source.write_bytes(good)
        assert smoke_run.snakemake("--cores", "2").returncode == 0
