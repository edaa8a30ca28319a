"""`plot` draws the results of all public functions by one convention, that of `results.dataset`."""

from collections.abc import Mapping
from numbers import Real
from typing import Any

import numpy as np
import xarray as xr

from nonsmooth.errors import NonsmoothError, SceneError, quoted
from nonsmooth.estimate import Estimate
from nonsmooth.plotting.style import BLACK, BLUE, GREEN, ORANGE, SKY, STYLE, TEXT_WIDTH
from nonsmooth.results import described_by, main_variables

CURVES = [(BLUE, "-"), (ORANGE, "--"), (GREEN, "-."), (BLACK, (0, (1, 1.5))), (SKY, (0, (5, 1)))]
MOST_CURVES = 12  # over one dimension for the values of another; more are drawn as a map
PANEL_HEIGHT = 2.3  # inches


def plot(result: Any) -> dict[str, Any]:
    """Draw results, in the style of the paper.

    Parameters
    ----------
    result : xarray.Dataset or xarray.DataArray or Estimate or dict
        What a function of `nonsmooth` returns. Or several of these, all of the same kind, by the
        names that the legend gives them; the names of estimates may be numbers.

    Returns
    -------
    dict
        From the names of the variables to the panels, which are matplotlib Axes. There is a panel
        for each variable: curves over one dimension with the band of their errors, or between
        `lower` and `upper`; numbers with their error bars, that of estimates in the panel
        ``"value"``; paths; maps over two dimensions, of several results by contours.

    Raises
    ------
    SceneError
        If it is no such result.
    NonsmoothError
        If matplotlib is not installed.
    """
    try:
        import matplotlib as mpl
        import matplotlib.pyplot as plt
    except ImportError:
        raise NonsmoothError(
            "pictures need matplotlib; install it by pip install matplotlib"
        ) from None
    several = isinstance(result, Mapping) and not isinstance(result, xr.Dataset)
    results = dict(result) if several else {"": result}
    with mpl.rc_context(STYLE):
        found = {label: _dataset(one) for label, one in results.items()}
        names = [name for data in found.values() for name in main_variables(data)]
        names = list(dict.fromkeys(names))
        if not names:
            raise _no_result(result)
        panels = _panels(plt, names)
        for name, panel in panels.items():
            having = {label: data for label, data in found.items() if name in data}
            if all(data[name].size == 1 for data in having.values()):
                _draw_numbers(panel, having, name)
                continue
            for k, (label, data) in enumerate(having.items()):
                _draw(panel, data, name, k, str(label), len(having) > 1)
            if panel.get_legend_handles_labels()[1]:
                panel.legend()
    return panels


def _no_result(value):
    return SceneError(
        f"what is to be drawn is {quoted(value)}; give what a function of nonsmooth returns, or a "
        "dict of names and such results"
    )


def _dataset(result):
    if isinstance(result, Estimate):
        return result.to_dataset()
    if isinstance(result, xr.DataArray):
        result = result.to_dataset(name=result.name or "values")
    if not isinstance(result, xr.Dataset):
        raise _no_result(result)
    if not all(variable.dtype.kind in "iuf" for variable in result.data_vars.values()):
        raise _no_result(result)
    for name in main_variables(result):
        for about in described_by(result, name):
            if not set(result[about].dims) <= set(result[name].dims):
                raise SceneError(
                    f"{about} has other dimensions than {name}, which it is about; give what a "
                    "function of nonsmooth returns, unchanged"
                )
    return result


def _panels(plt, names):
    """Make a panel for each name, in up to three columns."""
    columns = min(len(names), 2 if len(names) == 4 else 3)
    rows = -(-len(names) // columns)
    width = TEXT_WIDTH * (0.6 if columns == 1 else 1)
    figure, axes = plt.subplots(rows, columns, figsize=(width, rows * PANEL_HEIGHT), squeeze=False)
    for unused in axes.flat[len(names) :]:
        figure.delaxes(unused)
    return dict(zip(names, axes.flat, strict=False))


def _draw(panel, data, name, k, label, several):
    """Draw a variable of the k-th result into its panel."""
    values = data[name]
    single = [dim for dim in values.dims if values.sizes[dim] == 1]
    values = values.squeeze(single if len(single) < values.ndim else single[:-1])
    axes = [dim for dim in values.dims if dim in data.coords]
    if values.ndim > 2 or not axes:
        raise SceneError(
            f"{name} has the dimensions ({', '.join(map(str, values.dims))}); choose a part with "
            "one or two that have coordinates, by its method isel"
        )
    if values.ndim == 1:
        _draw_curve(panel, data, values, CURVES[k % len(CURVES)], label)
        return
    over = axes[0] if len(axes) == 1 else axes[int(np.argmax(values.shape))]
    (other,) = set(values.dims) - {over}
    numbers = [c for c in data.coords if data[c].dims == (other,)]
    if not numbers:
        _draw_paths(panel, values.transpose(over, other), CURVES[k % len(CURVES)], label)
    elif data.sizes[other] <= MOST_CURVES:
        for j in range(data.sizes[other]):
            part = data.isel({other: j})
            parts = [f"{c} = {float(part[c]):g}" for c in numbers if c == other or len(axes) == 1]
            text = ", ".join(filter(None, [label, *parts]))
            look = CURVES[(k + j) % len(CURVES)]
            _draw_curve(panel, part, part[name].squeeze(), look, text)
    else:
        _draw_map(panel, data, values, CURVES[k % len(CURVES)][0] if several else None, label)


def _draw_curve(panel, data, values, look, label):
    colour, dashes = look
    (over,) = values.dims
    points = data[over].values
    if limits := _limits(data, values):
        panel.fill_between(points, *limits, color=colour, alpha=0.25, linewidth=0)
    marker = "o" if len(points) == 1 else None
    panel.plot(points, values, color=colour, linestyle=dashes, marker=marker, label=label or None)
    panel.set(xlabel=_title(data[over]), ylabel=_title(values))


def _limits(data, values):
    """Return the ends of the band about a curve, None if no error is known."""
    about = described_by(data, values.name)
    if {"lower", "upper"} <= set(about):
        return data["lower"].squeeze(), data["upper"].squeeze()
    if f"{values.name}_error" in about:
        error = data[f"{values.name}_error"].squeeze()
        return values - error, values + error
    return None


def _draw_paths(panel, values, look, label):
    colour, dashes = look
    (over, _), many = values.dims, values.shape[1]
    lines = panel.plot(
        values[over],
        values,
        color=colour,
        linestyle=dashes,
        linewidth=0.8,
        alpha=max(0.15, min(1.0, 5 / many)),
    )
    lines[0].set_label(label or None)
    panel.set(xlabel=_title(values[over]), ylabel=_title(values))


def _draw_map(panel, data, values, colour, label):
    """Fill the levels of a map, or draw them in a colour."""
    down, across = values.dims
    grid = data[across].values, data[down].values, values.values
    if colour is None:
        filled = panel.contourf(*grid, 12, cmap="viridis")
        bar = panel.figure.colorbar(filled, ax=panel, label=_title(values))
        bar.outline.set_visible(False)
    else:
        panel.contour(*grid, 8, colors=colour, linewidths=0.8)
        panel.plot([], [], color=colour, label=label)
        panel.set_title(_title(values), fontsize=8)
    panel.grid(False)
    panel.set(xlabel=_title(data[across]), ylabel=_title(data[down]))


def _draw_numbers(panel, found, name):
    """Draw one number of each result with its error, over their names."""
    numbers = all(isinstance(label, Real) for label in found)
    places = list(found) if numbers else range(len(found))
    values = [data[name] for data in found.values()]
    limits = [_limits(data, data[name]) or (data[name],) * 2 for data in found.values()]
    bars = np.abs([np.ravel(ends) for ends in limits] - np.reshape(values, (-1, 1)))
    panel.errorbar(
        places,
        np.ravel(values),
        bars.T,
        color=BLUE,
        marker="o",
        markersize=3,
        linestyle="none",
        capsize=2,
    )
    panel.set_ylabel(_title(values[0]))
    if not numbers:
        methods = [data.attrs.get("method", "") for data in found.values()]
        if len(set(methods)) == 1 < len(methods):
            methods = [""] * len(methods)
        texts = [f"{label}\n{by}".strip() for label, by in zip(found, methods, strict=True)]
        panel.set_xticks(places, texts)
        panel.set_xlim(-0.5, len(found) - 0.5)


def _title(variable):
    """Return the long name of a variable with its units, unless it has none."""
    title = variable.attrs.get("long_name", variable.name)
    units = variable.attrs.get("units", "1")
    return title if units == "1" else f"{title} [{units}]"
