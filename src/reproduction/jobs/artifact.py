"""Artifacts: netCDF files with units, errors and provenance, written whole or not at all."""

import hashlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

import nonsmooth
from reproduction.errors import ArtifactError
from reproduction.jobs.files import whole

_MARK = "nonsmooth"  # the `source` attribute starts with it
_LOCK = Path("environment-lock.txt")  # in the folder from which the workflow runs


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

    def entries(items):
        return {
            name: (dims, values, {"long_name": long_name, "units": "1"})
            for name, (dims, values, long_name) in items.items()
        }

    attrs = {"title": title, "summary": summary}
    return xr.Dataset(entries(variables), coords=entries(coords), attrs=attrs)


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
    return f"rule {rule}({arguments}); {_MARK} {nonsmooth.__version__}; lock sha256 {digest}"


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
        If a variable is not described or not finite, or the folder cannot be written.
    """
    path = Path(path)
    dataset = dataset[sorted(map(str, dataset.data_vars))].copy()
    for name, variable in dataset.variables.items():
        if not {"long_name", "units"} <= variable.attrs.keys():
            raise ArtifactError(f"{path}: variable {name!r} has no long_name or units; add them")
        if name in dataset.data_vars and not np.all(np.isfinite(variable)):
            raise ArtifactError(
                f"{path}: variable {name!r} is not finite; the computation that led to it failed"
            )
        if f"{name}_error" in dataset:
            variable.attrs["ancillary_variables"] = f"{name}_error"
        variable.encoding = {"_FillValue": None}
        variable.attrs = dict(sorted(variable.attrs.items()))
    dataset.attrs = {
        "Conventions": "CF-1.11, ACDD-1.3",
        "history": history,
        "keywords": "random vibration, non-smooth mechanics, penalization, threshold crossing",
        "license": "MIT",
        "source": f"{_MARK} {nonsmooth.__version__}",
        "summary": dataset.attrs["summary"],
        "title": dataset.attrs["title"],
    }
    with whole(path) as partial:
        dataset.to_netcdf(partial, engine="netcdf4", format="NETCDF4")


def read(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory.

    Raises
    ------
    ArtifactError
        If the file is missing, truncated, or not an artifact of this package.
    """
    path = Path(path)
    if not path.exists():
        raise ArtifactError(f"{path} does not exist; run snakemake to make it")
    try:
        dataset = xr.load_dataset(path, engine="netcdf4", decode_times=False)
    except (OSError, ValueError, RuntimeError):
        raise ArtifactError(
            f"{path} is not a readable netCDF file (truncated?); delete it and run snakemake again"
        ) from None
    if not str(dataset.attrs.get("source", "")).startswith(_MARK):
        raise ArtifactError(
            f"{path} was not written by this package; move it away and run snakemake again"
        )
    return dataset
