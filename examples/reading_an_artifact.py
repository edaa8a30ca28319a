"""
Writing a result and reading it
===============================

Results are xarray datasets: they go into netCDF files and come back. The files in ``results`` that
the workflow writes are of the same kind; ``xarray.open_dataset("results/crossing/p=10.nc")`` is
read, printed and drawn like the one here.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import xarray as xr

import nonsmooth as ns

found = ns.crossing_probability(ns.Scene("friction"), 0.6, [0.5, 1, 2, 4, 8], p=10, tol=1e-4)
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder, "crossing.nc")
    found.to_netcdf(path)
    data = xr.load_dataset(path)

print(data)
print(data["probability"].attrs["long_name"], "by the method", data.attrs["method"])
ns.plot(data)
plt.show()

# %%
# A table of it, for other software:

print(data.to_dataframe()[["probability", "probability_error"]].to_csv())
