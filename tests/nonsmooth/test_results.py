"""Results describe themselves and pass through files."""

import pytest
import xarray as xr

import nonsmooth as ns
from nonsmooth.results import dataset, described_by, main_variables
from public_results import RESULTS, as_dataset


@pytest.mark.parametrize("name", RESULTS)
def test_every_variable_has_units_and_a_name(name):
    """Coordinates, too; an error tells about a variable, and something is told about."""
    data = as_dataset(RESULTS[name]())
    for variable in data.variables:
        if variable in data.data_vars or "brownian" not in name:  # whose T is the user's own
            assert data[variable].attrs["units"] == "1", variable
            assert data[variable].attrs["long_name"], variable
    assert main_variables(data)
    assert not [one for one in main_variables(data) if one.endswith(("_error", "_bias"))]


@pytest.mark.parametrize("engine", ["netcdf4", "scipy"])
@pytest.mark.parametrize("name", RESULTS)
def test_every_result_passes_through_a_file(name, engine, tmp_path):
    """Values, names and attributes come back, also from the format that scipy writes."""
    result = RESULTS[name]()
    data = as_dataset(result)
    data.to_netcdf(tmp_path / "result.nc", engine=engine)
    with xr.open_dataset(tmp_path / "result.nc", engine=engine) as back:
        xr.testing.assert_identical(back.load(), data)
    if isinstance(result, ns.Estimate):
        assert ns.Estimate.from_dataset(back) == result


def test_what_tells_about_a_variable():
    """By its name, or because it is said so; the density of y and x is not about that of y."""
    point = ((), 1.0, "a number")
    names = ["q", "q_error", "q_bias", "q_r", "low"]
    data = dataset({}, dict.fromkeys(names, point), about={"q": ["low", "q"]}, method="none")
    assert described_by(data, "q") == ["q_error", "q_bias", "low"]
    assert main_variables(data) == ["q", "q_r"]
    assert data.attrs == {"method": "none"}
