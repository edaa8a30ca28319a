"""Figures of answers: curves with their error bands, densities, maps over a sweep."""

from collections.abc import Callable, Mapping, Sequence
from itertools import product
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from nonsmooth.plotting.style import BLACK, BLUE, GREEN, ORANGE, SKY
from studies.questions import Question
from studies.units import in_figures, pretty, readable

COLORS = [BLUE, ORANGE, GREEN, SKY, BLACK]
WIDTH, HEIGHT = 4.6, 2.5
_LIMITS = ("lower", "upper")


def labelled(variable: xr.DataArray) -> str:
    """Spell what is drawn with its unit."""
    unit = in_figures(variable.attrs["units"])
    return f"{variable.attrs['long_name']}, {unit}" if unit else variable.attrs["long_name"]


def of_answer(data: xr.Dataset, asked: Question) -> list[Figure]:
    """Draw all curves of an answer; a number has none.

    Parameters
    ----------
    data : xarray.Dataset
    asked : Question

    Returns
    -------
    list of matplotlib.figure.Figure
    """
    names = [name for name in asked.values if name in data.data_vars]
    densities = [name for name in names if name.startswith("density_")]
    if densities:
        return [_densities(data, [n for n in densities if data[n].ndim == 1])] + [
            _joint(data[name]) for name in densities if data[name].ndim == 2
        ]
    curves = [name for name in names if data[name].ndim > 0 and name not in _LIMITS]
    return [_curves(data, name) for name in curves]


def limits(data: xr.Dataset, name: str) -> list[xr.DataArray]:
    """Return the limits between which a variable is, infinite if it has none."""
    return [
        data.get(limit, xr.full_like(data[name], end))
        for limit, end in zip(_LIMITS, (-np.inf, np.inf), strict=True)
    ]


def _curves(data, name):
    """Draw values over time with the band in which the truth is, one for each threshold or so."""
    figure, axis = plt.subplots(figsize=(WIDTH, HEIGHT), constrained_layout=True)
    *first, last = data[name].dims
    over, several = data[last], first[0] if first else "curve"
    curves = data if first else data.expand_dims(several)
    bottom, top = _ends(data, name)
    axis.set(xlabel=labelled(over), ylim=(bottom, top))
    for k in range(curves.sizes[several]):
        curve, color = curves.isel({several: k}), COLORS[k % len(COLORS)]
        low, high = (np.clip(end, bottom, top) for end in _band(curve, name))
        axis.fill_between(over, low, high, color=color, alpha=0.3, linewidth=0)
        label = level(curve, several) if first else None
        axis.plot(over, curve[name], color=color, marker="o", markersize=3, label=label)
    axis.set_xlim(0, None)
    axis.set_title(readable(data[name].attrs["long_name"]), fontsize=8)
    axis.set_ylabel(
        f"{name.replace('_', ' ')}, {in_figures(data[name].attrs['units'])}".rstrip(", ")
    )
    if first:
        axis.legend(title=several, fontsize=8)
    return figure


def _band(data, name):
    """Return the limits between which a variable is."""
    if set(_LIMITS) <= set(data.data_vars):
        return [data[limit].values for limit in _LIMITS]
    return [data[name].values + sign * data[f"{name}_error"].values for sign in (-1, 1)]


def _ends(data, name):
    """Return the ends of the axis of a variable, with 0 and all that is finite between them."""
    shown = np.concatenate([np.ravel(part) for part in (data[name].values, *_band(data, name))])
    low, high = (end(shown[np.isfinite(shown)], initial=0.0) for end in (np.min, np.max))
    spare = 0.1 * (high - low) or 1e-9
    top = high + spare if high > 0 or low == 0 else 0.0
    return (low - spare if low < 0 else 0.0), min(top, 1.02) if name == "probability" else top


def levels(data: xr.Dataset, name: str) -> list[str]:
    """Spell what tells the curves of a variable apart; nothing if there is one curve alone."""
    if data[name].ndim == 1:
        return []
    several = data[name].dims[0]
    return [level(data.isel({several: k}), several, pretty) for k in range(data.sizes[several])]


def level(
    curve: xr.Dataset | xr.DataArray, several: str, spell: Callable[[str], str] = in_figures
) -> str:
    """Spell the place of a curve on a dimension: its coordinate, or a threshold's two ends."""
    if several in curve.coords:
        return f"{float(curve[several]):.6g} {spell(curve[several].attrs['units'])}".rstrip()
    ends = (f"{float(curve[f'{several}_{end}']):.6g}" for end in ("lower", "upper"))
    return f"{', '.join(ends)} {spell(curve[f'{several}_lower'].attrs['units'])}".rstrip()


def _densities(data, names):
    figure, axes = plt.subplots(
        1, len(names), figsize=(max(WIDTH, 2.3 * len(names)), HEIGHT), constrained_layout=True,
        squeeze=False,
    )  # fmt: skip
    for axis, name in zip(axes[0], names, strict=True):
        over = data[data[name].dims[0]]
        value, error = data[name].values, data[f"{name}_error"].values
        axis.fill_between(
            over, np.maximum(value - error, 0), value + error, color=BLUE, alpha=0.3, linewidth=0
        )
        axis.plot(over, value, color=BLUE)
        seen = np.flatnonzero(value > 1e-3 * value.max())
        axis.set_xlim(float(over[seen[0]]), float(over[seen[-1]]))
        axis.set_ylim(0, None)
        unit = in_figures(over.attrs["units"])
        axis.set_xlabel(_symbol(over.name) + (f", {unit}" if unit else ""))
        own = in_figures(data[name].attrs["units"])
        axis.set_ylabel("density" + (f", {own}" if own else ""))
    return figure


def _joint(variable):
    figure, axis = plt.subplots(figsize=(WIDTH, 2.8), constrained_layout=True)
    first, second = (variable[dim] for dim in variable.dims)
    image = axis.pcolormesh(
        second, first, variable.values, cmap="viridis", shading="nearest", rasterized=True
    )
    for over, limit in ((second, axis.set_xlim), (first, axis.set_ylim)):
        other = tuple(k for k, dim in enumerate(variable.dims) if dim != over.name)
        seen = np.flatnonzero(variable.values.max(axis=other) > 1e-3 * variable.values.max())
        limit(float(over[seen[0]]), float(over[seen[-1]]))
    names = [
        f"{_symbol(v.name)}, {in_figures(v.attrs['units'])}".rstrip(", ") for v in (second, first)
    ]
    axis.set(xlabel=names[0], ylabel=names[1])
    axis.grid(False)
    bar = figure.colorbar(image, ax=axis)
    bar.set_label(f"joint density, {in_figures(variable.attrs['units'])}".rstrip(", "))
    return figure


def _symbol(name):
    texts = {"y": "velocity $y$", "x": "displacement $x$"}
    return texts.get(str(name), rf"$\{name}$")


def maps(
    values: np.ndarray, axes: Mapping[str, Sequence[Any]], label: str, numbers: Mapping[str, list]
) -> Figure:
    """Draw a number over a sweep: a map for each value of the third parameter and so on.

    Parameters
    ----------
    values : ndarray
        In the order of the sweep, the last parameter fastest.
    axes : mapping
        From parameters to values, as the study has them.
    label : str
        Of the number.
    numbers : mapping
        From parameters to values as numbers, for the axes.

    Returns
    -------
    matplotlib.figure.Figure
    """
    names = sorted(axes, key=lambda name: -len(axes[name]))[:2]
    values = np.where(np.isfinite(values), values, np.nan)  # stays blank
    cube = xr.DataArray(values.reshape([len(axes[name]) for name in axes]), dims=list(axes))
    if len(names) == 1:
        return _line(cube, names[0], numbers, label)
    rest = [name for name in axes if name not in names]
    across, up = names
    panels = cube.transpose(*rest, up, across).values.reshape(-1, len(axes[up]), len(axes[across]))
    points = list(product(*(axes[name] for name in rest)))
    count = len(points)
    columns = min(count, 4)
    rows = -(-count // columns)
    figure, grid = plt.subplots(
        rows, columns, figsize=(2.2 * columns + 1.0, 2.0 * rows + 0.3), squeeze=False,
        sharex=True, sharey=True, constrained_layout=True,
    )  # fmt: skip
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    logarithmic = low > 0 and high > 30 * low
    norm = plt.matplotlib.colors.LogNorm(low, high) if logarithmic else None
    limits = {} if logarithmic else {"vmin": low, "vmax": high}
    image = None
    for k, axis in enumerate(grid.flat):
        if k >= count:
            axis.set_visible(False)
            continue
        image = axis.pcolormesh(
            range(len(axes[across])), range(len(axes[up])), panels[k],
            norm=norm, cmap="viridis", shading="nearest", rasterized=True, **limits,
        )  # fmt: skip
        axis.grid(False)
        told = ", ".join(f"{name} = {value}" for name, value in zip(rest, points[k], strict=True))
        axis.set_title(told, fontsize=8)
    _ticks(grid, axes, names)
    figure.colorbar(image, ax=grid, label=label)
    return figure


def _ticks(grid, axes, names):
    """Write the values of the sweep beside the cells, not more than six on an axis."""
    for axis in grid.flat:
        for name, set_ticks in ((names[0], axis.set_xticks), (names[1], axis.set_yticks)):
            positions = np.unique(np.linspace(0, len(axes[name]) - 1, 6).round().astype(int))
            texts = [str(axes[name][k]) for k in positions]
            set_ticks(positions, texts, fontsize=7)
    for column in grid.T:
        lowest = [axis for axis in column if axis.get_visible()][-1]
        lowest.set_xlabel(names[0].replace("_", " "))
        lowest.tick_params(labelbottom=True)
    for row in grid:
        row[0].set_ylabel(names[1].replace("_", " "))


def _line(cube, name, numbers, label):
    """Draw a sweep of one parameter as a line."""
    figure, axis = plt.subplots(figsize=(WIDTH, HEIGHT), constrained_layout=True)
    axis.plot(numbers[name], cube.values, color=BLUE, marker="o", markersize=3)
    if min(numbers[name]) > 0 and max(numbers[name]) > 30 * min(numbers[name]):
        axis.set_xscale("log")
        axis.xaxis.set_major_locator(LogLocator(numticks=6))
    axis.set(xlabel=name.replace("_", " "), ylabel=label)
    return figure
