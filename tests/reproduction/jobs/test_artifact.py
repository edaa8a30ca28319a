"""Artifacts: whole or not at all, described, reproducible to the byte, recognised as ours."""

import numpy as np
import pytest
import xarray as xr

from reproduction.errors import ArtifactError
from reproduction.jobs import artifact


def example(values=(1.0, 2.0)):
    """Return a small described dataset."""
    return artifact.dataset(
        "An example",
        "two numbers",
        {"time": ("time", [0.1, 0.2], "time")},
        {
            "q": ("time", np.array(values), "a quantity"),
            "q_error": ("time", [1e-3, 1e-3], "error of the quantity"),
        },
    )


def test_round_trip_and_metadata(tmp_path):
    """Values, units, the error as ancillary variable and the globals survive."""
    path = tmp_path / "deep" / "example.nc"
    artifact.write(example(), path, "rule example()")
    data = artifact.read(path)
    assert np.array_equal(data["q"], [1.0, 2.0])
    assert data["q"].attrs["ancillary_variables"] == "q_error"
    assert data["q"].attrs["units"] == "1"
    assert data.attrs["Conventions"].startswith("CF-1.11")
    wanted = {"title", "summary", "keywords", "license", "source", "history"}
    assert wanted <= data.attrs.keys()


def test_same_bytes_again(tmp_path):
    """No clock time and no order of insertion in the file."""
    for name in ("a.nc", "b.nc"):
        artifact.write(example(), tmp_path / name, "rule example()")
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_values_that_are_not_finite_are_refused(tmp_path, bad):
    """They are refused, and nothing is written."""
    with pytest.raises(ArtifactError, match="'q' is not finite"):
        artifact.write(example((1.0, bad)), tmp_path / "x.nc", "")
    assert list(tmp_path.iterdir()) == []


def test_undescribed_variables_are_refused(tmp_path):
    """A variable without long_name or units."""
    data = example()
    del data["q"].attrs["long_name"]
    with pytest.raises(ArtifactError, match="'q' has no long_name"):
        artifact.write(data, tmp_path / "x.nc", "")


def test_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    """The old artifact survives a write that fails half-way."""
    path = tmp_path / "x.nc"
    artifact.write(example(), path, "")
    old = path.read_bytes()
    with pytest.raises(TypeError):
        artifact.write(example(), path, object())  # netCDF cannot store this attribute
    assert path.read_bytes() == old
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


def test_unwritable_folder_is_one_line(tmp_path):
    """A file stands where the folder should be."""
    (tmp_path / "results").write_text("")
    with pytest.raises(ArtifactError, match="cannot write") as error:
        artifact.write(example(), tmp_path / "results" / "x.nc", "")
    assert "\n" not in str(error.value)


def test_missing_truncated_and_foreign_files_are_one_line(tmp_path):
    """Each names the file and the cure."""
    good, path = tmp_path / "good.nc", tmp_path / "x.nc"
    with pytest.raises(ArtifactError, match="does not exist; run snakemake"):
        artifact.read(path)
    artifact.write(example(), good, "")
    path.write_bytes(good.read_bytes()[: good.stat().st_size // 2])
    with pytest.raises(ArtifactError, match="truncated"):
        artifact.read(path)
    path.write_text("not a netCDF file")
    with pytest.raises(ArtifactError, match="delete it"):
        artifact.read(path)
    xr.Dataset({"q": 1.0}).to_netcdf(path)
    with pytest.raises(ArtifactError, match="not written by this package"):
        artifact.read(path)


def test_provenance_has_parameters_and_the_lock(tmp_path, monkeypatch):
    """Rule, parameters, version and the hash of the pinned environment."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "environment-lock.txt").write_text("x==1")
    text = artifact.provenance("r", {"seed": 4, "n": 2.0})
    assert text.startswith("rule r(n=2.0, seed=4); nonsmooth ")
    assert "lock sha256 " in text
