"""Artifacts: whole or not at all, described, reproducible to the byte, never read damaged."""

import hashlib

import netCDF4
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
    paths = [tmp_path / results / "topic" / "a.nc" for results in ("results", "elsewhere")]
    for path in paths:
        artifact.write(example(), path, "rule example()")
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_other_programs_read_it(tmp_path):
    """NetCDF libraries ignore the checksum, which is that of the bytes before the last line."""
    path = tmp_path / "x.nc"
    artifact.write(example(), path, "")
    with netCDF4.Dataset(path) as file:
        assert np.array_equal(file["q"][:], [1.0, 2.0])
    with xr.open_dataset(path) as data:
        assert data.attrs["id"] == f"{tmp_path.name}/x"
    content, last = path.read_bytes()[:-83], path.read_bytes()[-83:]
    assert last == b"\nnonsmooth sha256 %s\n" % hashlib.sha256(content).hexdigest().encode()


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_values_that_are_not_finite_are_refused(tmp_path, bad):
    """They are refused, and nothing is written."""
    with pytest.raises(ArtifactError, match="'q' is not finite"):
        artifact.write(example((1.0, bad)), tmp_path / "x.nc", "")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda data: data.assign(q_error=-data["q_error"] - 1), "'q_error' is negative"),
        (lambda data: data.assign(q=data["q"] * 1j), "'q' is neither numbers nor texts"),
    ],
)
def test_nonsense_is_not_written(tmp_path, change, message):
    """Errors are not negative, and values real."""
    data = example()
    changed = change(data)
    for name in data.variables:
        changed[name].attrs = data[name].attrs
    with pytest.raises(ArtifactError, match=message):
        artifact.write(changed, tmp_path / "x.nc", "")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("content", [b"no netCDF", b"\x89HDF\r\n\x1a\n" + bytes(200)])
def test_what_others_have_signed_is_refused(tmp_path, content):
    """A valid checksum makes no artifact of it."""
    digest = hashlib.sha256(content).hexdigest().encode()
    (tmp_path / "x.nc").write_bytes(content + b"\nnonsmooth sha256 %s\n" % digest)
    with pytest.raises(ArtifactError, match="is no netCDF file"):
        artifact.read(tmp_path / "x.nc")


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_values_may_be_infinite_where_that_is_explained(tmp_path, bad):
    """By an attribute, which is kept; NaN is nothing."""
    data = example((1.0, bad))
    data["q"].attrs["infinite"] = "where nothing is known"
    if np.isnan(bad):
        with pytest.raises(ArtifactError, match="'q' is not finite"):
            artifact.write(data, tmp_path / "x.nc", "")
        return
    artifact.write(data, tmp_path / "x.nc", "")
    found = artifact.read(tmp_path / "x.nc")["q"]
    assert found.values.tolist() == [1.0, np.inf]
    assert found.attrs["infinite"] == "where nothing is known"


def test_coordinates_may_be_infinite_but_not_undefined(tmp_path):
    """N = inf is the limit; NaN is nothing."""
    for value in (np.inf, np.nan):
        data = example().assign_coords(time=("time", [0.1, value], example()["time"].attrs))
        if np.isnan(value):
            with pytest.raises(ArtifactError, match="'time' is not finite"):
                artifact.write(data, tmp_path / "x.nc", "")
        else:
            artifact.write(data, tmp_path / "x.nc", "")
            assert artifact.read(tmp_path / "x.nc")["time"][-1] == value


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


def test_no_space_for_temporary_files(tmp_path, monkeypatch):
    """NetCDF says no more than HDF error."""

    def fail(*arguments, **options):
        raise RuntimeError("NetCDF: HDF error")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", fail)
    with pytest.raises(ArtifactError, match=r"in /.* \(NetCDF: HDF error\); free space there, or"):
        artifact.write(example(), tmp_path / "x.nc", "")
    assert list(tmp_path.iterdir()) == []


def test_errors_have_the_dimensions_of_their_variables(tmp_path):
    """A shorter error is refused."""
    data = example()
    data["q_error"] = data["q_error"].isel(time=0, drop=True)
    with pytest.raises(ArtifactError, match="'q' and its error have different dimensions"):
        artifact.write(data, tmp_path / "x.nc", "")


def put_nan(path):
    """Write NaN with another program."""
    with netCDF4.Dataset(path, "r+") as file:
        file["q"][0] = np.nan


def without(path):
    """Write the file again without a variable."""
    data = xr.load_dataset(path)
    data.drop_vars("q_error").to_netcdf(path)


def shortened(path):
    """Write the file again with one time less."""
    xr.load_dataset(path).isel(time=slice(1)).to_netcdf(path)


def cut(path):
    """Keep the first half of the file."""
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def lengthened(path):
    """Append a byte."""
    path.write_bytes(path.read_bytes() + b"x")


def emptied(path):
    """Keep nothing."""
    path.write_bytes(b"")


def text(path):
    """Put something else in its place."""
    path.write_text("not a netCDF file")


def folder(path):
    """Put a folder in its place."""
    path.unlink()
    path.mkdir()


@pytest.mark.parametrize(
    "damage", [put_nan, without, shortened, cut, lengthened, emptied, text, folder]
)
def test_what_is_not_as_it_was_written_is_refused(tmp_path, damage):
    """In one line that names the file and the cure."""
    path = tmp_path / "x.nc"
    artifact.write(example(), path, "")
    damage(path)
    with pytest.raises(ArtifactError, match="delete it and run snakemake again") as error:
        artifact.read(path)
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)


def test_flipped_bits_are_found(tmp_path):
    """In the head, among the data, and in every byte of the checksum."""
    path = tmp_path / "x.nc"
    artifact.write(example(), path, "")
    good = path.read_bytes()
    for place in (*range(0, len(good), 29), *range(len(good) - 83, len(good))):
        bad = bytearray(good)
        bad[place] ^= 1 << place % 8
        path.write_bytes(bad)
        with pytest.raises(ArtifactError, match="delete it and run snakemake again"):
            artifact.read(path)


def test_an_artifact_in_the_place_of_another_is_refused(tmp_path):
    """Its folder and its name are in the file; the results folder is not."""
    for name in ("p=1/0.nc", "p=10/0.nc"):
        artifact.write(example(), tmp_path / name, "")
    (tmp_path / "p=1").rename(tmp_path / "p=1 kept")
    (tmp_path / "p=10").rename(tmp_path / "p=1")
    with pytest.raises(ArtifactError, match=r"it is p=10/0\.nc under another name; delete it"):
        artifact.read(tmp_path / "p=1" / "0.nc")


def test_missing_file_is_one_line(tmp_path):
    """It says how to make it."""
    with pytest.raises(ArtifactError, match="does not exist; run snakemake"):
        artifact.read(tmp_path / "x.nc")


def test_provenance_has_parameters_and_the_lock(tmp_path, monkeypatch):
    """Rule, parameters, version and the hash of the pinned environment."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "environment-lock.txt").write_text("x==1")
    text = artifact.provenance("r", {"seed": 4, "n": 2.0})
    assert text.startswith("rule r(n=2.0, seed=4); nonsmooth ")
    assert "lock sha256 " in text
