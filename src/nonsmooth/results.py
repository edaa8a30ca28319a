"""Results over several points: xarray datasets that describe themselves and fit into netCDF files.

Every variable and coordinate has `units` ("1": the models are dimensionless) and a `long_name`.
What is known about a variable q, as its error q_error, is listed in its `ancillary_variables`, as
the CF conventions ask for.
"""

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import xarray as xr

_ABOUT = ("error", "bias", "bias_error")  # q_error, q_bias and q_bias_error tell about q


def dataset(
    coords: Mapping[str, tuple],
    variables: Mapping[str, tuple],
    about: Mapping[str, Iterable[str]] | None = None,
    **attributes: Any,
) -> xr.Dataset:
    """Assemble a dataset.

    Parameters
    ----------
    coords, variables : mapping
        From names to (dimensions, values, long name).
    about : mapping, optional
        From the names of variables to all others that tell about them, besides those with names
        such as q_error.
    **attributes
        Of the whole: texts and numbers, which netCDF files can hold.

    Returns
    -------
    xarray.Dataset
    """

    def described(items):
        return {
            name: (dims, values, {"long_name": long_name, "units": "1"})
            for name, (dims, values, long_name) in items.items()
        }

    found = xr.Dataset(described(variables), coords=described(coords), attrs=attributes)
    for name in variables:
        named = {f"{name}_{what}" for what in _ABOUT}.union((about or {}).get(name, ())) - {name}
        if known := [other for other in variables if other in named]:
            found[name].attrs["ancillary_variables"] = " ".join(known)
    return found


def between_limits(
    coords: Mapping[str, tuple],
    dims: tuple[Hashable, ...],
    name: str,
    title: str,
    parts: Iterable[Any],
    **attributes: Any,
) -> xr.Dataset:
    """Assemble a dataset of one quantity with its error and the limits between which it is.

    Parameters
    ----------
    coords
        As for `dataset`.
    dims : tuple of hashable
        Dimensions of all four parts.
    name, title : str
        Name and long name of the quantity.
    parts : iterable of array_like
        The quantity, its error, its lower and its upper limit.
    **attributes
        As for `dataset`.

    Returns
    -------
    xarray.Dataset
    """
    titles = {
        name: title,
        f"{name}_error": f"error of the {title}",
        "lower": f"lower limit of the {title}",
        "upper": f"upper limit of the {title}",
    }
    variables = {
        key: (dims, part, told) for (key, told), part in zip(titles.items(), parts, strict=True)
    }
    return dataset(coords, variables, about={name: ("lower", "upper")}, **attributes)


def described_by(data: xr.Dataset, name: str) -> list[str]:
    """List the variables that tell about one of a dataset."""
    listed = data[name].attrs.get("ancillary_variables", "").split()
    named = [f"{name}_{what}" for what in _ABOUT]
    return [str(other) for other in data.data_vars if other in listed + named]


def main_variables(data: xr.Dataset) -> list[str]:
    """List the variables of a dataset that tell about no other."""
    about = {other for name in data.data_vars for other in described_by(data, str(name))}
    return [str(name) for name in data.data_vars if name not in about]
