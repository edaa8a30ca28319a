"""Artifacts: netCDF files with units, errors and provenance, written whole or not at all.

The last line of an artifact is the checksum of all bytes before it, after the end of what netCDF
libraries read. `read` verifies it first: a damaged file can crash or hang these libraries.
"""

import hashlib
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

import nonsmooth
from nonsmooth import results
from reproduction.errors import ArtifactError
from reproduction.jobs.files import write_whole

_CHECKSUM = b"\nnonsmooth sha256 "  # begins the last line
_LOCK = Path(__file__).parents[3] / "environment-lock.txt"


def dataset(title: str, summary: str, coords: Mapping, variables: Mapping) -> xr.Dataset:
    """Assemble a dataset whose variables describe themselves.

    Parameters
    ----------
    title, summary : str
        ACDD globals.
    coords, variables : mapping
        From names to (dimensions, values, long name).

    Returns
    -------
    xarray.Dataset
        All units "1": the paper's models are dimensionless.
    """
    return results.dataset(coords, variables, title=title, summary=summary)


def provenance(rule: str, parameters: Mapping) -> str:
    """Describe how an artifact is made, without the time of day.

    Parameters
    ----------
    rule : str
    parameters : mapping
        Everything that the result depends on, with the seed.

    Returns
    -------
    str
        With the hash of the pinned environment.
    """
    arguments = ", ".join(f"{key}={value!r}" for key, value in sorted(parameters.items()))
    digest = hashlib.sha256(_LOCK.read_bytes()).hexdigest()[:16]
    return f"rule {rule}({arguments}); nonsmooth {nonsmooth.__version__}; lock sha256 {digest}"


def write(dataset: xr.Dataset, path: str | Path, history: str) -> None:
    """Write a dataset whole or not at all.

    Parameters
    ----------
    dataset : xarray.Dataset
        With the attributes ``title`` and ``summary``; every variable with a ``long_name`` and
        ``units``. A variable ``q_error`` becomes the ancillary variable of ``q``.
    path : str or Path
    history : str
        See `provenance`.

    Raises
    ------
    ArtifactError
        If a variable is not described, or not finite although no attribute `infinite` of it says
        what that means, or if the file cannot be written.
    """
    dataset = dataset[sorted(map(str, dataset.data_vars))].copy()
    flaw = _flaw(dataset)
    if flaw:
        raise ArtifactError(f"{path}: {flaw}; mend the computation that leads to it")
    for name, variable in dataset.variables.items():
        if f"{name}_error" in dataset:
            variable.attrs["ancillary_variables"] = f"{name}_error"
        variable.encoding = {"_FillValue": None}
        variable.attrs = dict(sorted(variable.attrs.items()))
    dataset.attrs = {
        "Conventions": "CF-1.11, ACDD-1.3",
        "history": history,
        "id": _identity(path),
        "keywords": "random vibration, non-smooth mechanics, penalization, threshold crossing",
        "license": "MIT",
        "source": f"nonsmooth {nonsmooth.__version__}",
        "summary": dataset.attrs["summary"],
        "title": dataset.attrs["title"],
    }
    content = _encoded(dataset)
    write_whole(path, content + _CHECKSUM + _digest(content))


def read(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory.

    Raises
    ------
    ArtifactError
        If the file cannot be read, is not as it was written, or is that of another artifact.
    """
    again = "delete it and run snakemake again"
    try:
        content, _, digest = Path(path).read_bytes().rpartition(_CHECKSUM)
    except FileNotFoundError:
        raise ArtifactError(f"{path} does not exist; run snakemake to make it") from None
    except OSError as error:
        raise ArtifactError(f"cannot read {path} ({error.strerror or error}); {again}") from None
    if not content:
        raise ArtifactError(f"{path} is truncated, changed, or no artifact: no checksum; {again}")
    if digest != _digest(content):
        raise ArtifactError(f"{path} is damaged: its checksum does not fit; {again}")
    try:
        dataset = xr.load_dataset(content, engine="netcdf4", decode_times=False)
    except (OSError, ValueError) as error:
        raise ArtifactError(f"{path} is no netCDF file ({error}); {again}") from None
    flaw = _flaw(dataset)
    if "id" not in dataset.attrs:
        flaw = "it has no id, so that it is no artifact"
    elif dataset.attrs["id"] != _identity(path):
        flaw = f"it is {dataset.attrs['id']}.nc under another name"
    if flaw:
        raise ArtifactError(f"{path}: {flaw}; {again}")
    return dataset


def _encoded(dataset):
    folder = "TMPDIR"
    try:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "artifact.nc"
            dataset.to_netcdf(file, engine="netcdf4", format="NETCDF4")
            return file.read_bytes()
    except (OSError, RuntimeError) as error:
        # no library says why, but a new file in a new folder lacks nothing but space
        raise ArtifactError(
            f"cannot write temporary files in {folder} ({error}); free space there, or set "
            "TMPDIR to a folder on another disk"
        ) from None


def _digest(content):
    return hashlib.sha256(content).hexdigest().encode() + b"\n"


def _identity(path):
    """Name an artifact by its folder and itself: unique, and the same in every results folder."""
    path = Path(path).absolute()
    return f"{path.parent.name}/{path.stem}"


def _is_text(variable):
    return variable.dtype.kind == "O" and all(isinstance(v, str) for v in variable.values.flat)


def _flaw(dataset):
    """Say what an artifact must not have, or nothing."""
    for name, variable in dataset.variables.items():
        infinite = name in dataset.coords or "infinite" in variable.attrs
        bad = np.isnan if infinite else lambda values: ~np.isfinite(values)
        if not {"long_name", "units"} <= variable.attrs.keys():
            return f"variable {name!r} has no long_name or units"
        if variable.dtype.kind not in "biufSUT" and not _is_text(variable):
            return f"variable {name!r} is neither numbers nor texts"
        is_error = str(name).endswith("_error") and variable.dtype.kind == "f"
        if is_error and np.any(variable.values < 0):
            return f"variable {name!r} is negative"
        if variable.dtype.kind == "f" and np.any(bad(variable.values)):
            return f"variable {name!r} is not finite"
        error = dataset.variables.get(f"{name}_error")
        if error is not None and error.dims != variable.dims:
            return f"variable {name!r} and its error have different dimensions"
    return None
