"""Maps of sweeps: every value in its place, for one to four parameters."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

from studies.figures import level, levels, maps, of_answer
from studies.questions import QUESTIONS

AXES = {"a": [1, 2], "b": [1, 2, 3], "c": [1, 2, 3, 4], "d": ["1 mm", "2 mm"]}


@pytest.mark.parametrize("count", [2, 3, 4])
def test_every_value_is_in_its_place(count):
    """The last parameter is the fastest; the two with most values are the axes of the maps."""
    axes = dict(list(AXES.items())[:count])
    shape = [len(values) for values in axes.values()]
    values = np.arange(np.prod(shape), dtype=float) + 100
    numbers = {name: list(range(len(values))) for name, values in axes.items()}
    figure = maps(values, axes, "value", numbers)
    meshes = [axis.collections[0] for axis in figure.axes if axis.get_label() != "<colorbar>"
              and axis.get_visible()]  # fmt: skip
    across, up = sorted(axes, key=lambda name: -len(axes[name]))[:2]
    rest = [name for name in axes if name not in (across, up)]
    order = [list(axes).index(name) for name in (*rest, up, across)]
    expected = values.reshape(shape).transpose(order).reshape(-1, len(axes[up]), len(axes[across]))
    assert len(meshes) == len(expected)
    for mesh, panel in zip(meshes, expected, strict=True):
        assert np.ravel(mesh.get_array()).tolist() == panel.ravel().tolist()
    plt.close(figure)


def test_every_column_has_its_values_below():
    """Also where the last row has fewer maps."""
    axes = {"a": list(range(5)), "b": list(range(6)), "c": list(range(7))}
    numbers = {name: list(range(len(values))) for name, values in axes.items()}
    figure = maps(np.arange(210.0), axes, "value", numbers)
    figure.draw_without_rendering()
    seen = [axis for axis in figure.axes if axis.get_visible() and axis.get_xlabel()]
    assert len(seen) == 4
    for axis in seen:
        assert any(text.get_visible() and text.get_text() for text in axis.get_xticklabels())
    plt.close(figure)


def test_one_parameter_is_a_line():
    """Value against parameter."""
    figure = maps(np.array([1.0, 2.0]), {"n": [1, 2]}, "value", {"n": [1.0, 2.0]})
    assert figure.axes[0].lines[0].get_ydata().tolist() == [1.0, 2.0]
    plt.close(figure)


def test_unknown_values_leave_their_cells_blank():
    """An infinite one does not spoil the colors of the others."""
    numbers = {"a": [1, 2], "b": [1, 2, 3]}
    values = np.array([1.0, 2.0, np.inf, 3.0, 4.0, 5.0])
    figure = maps(values, {"a": [1, 2], "b": [1, 2, 3]}, "value", numbers)
    mesh = figure.axes[0].collections[0]
    assert np.ma.masked_invalid(mesh.get_array()).mask.sum() == 1
    assert (mesh.norm.vmin, mesh.norm.vmax) == (1.0, 5.0)
    plt.close(figure)


def test_a_band_without_an_end_fills_the_figure():
    """From the lower limit to the top, also where there is no value."""
    values = {
        "reliability_index": [np.inf, 2.0],
        "reliability_index_error": [np.inf, 0.5],
        "lower": [3.0, 1.6],
        "upper": [np.inf, 2.7],
    }
    described = {"units": "1", "long_name": "index"}
    data = xr.Dataset(
        {name: ("horizon", part, described) for name, part in values.items()},
        {"horizon": ("horizon", [1.0, 2.0], {"units": "s", "long_name": "time"})},
    )
    (figure,) = of_answer(data, QUESTIONS["reliability_index"])
    (axis,) = figure.axes
    corners = axis.collections[0].get_paths()[0].vertices
    assert {tuple(corner) for corner in corners} >= {(1.0, 3.0), (1.0, axis.get_ylim()[1])}
    assert axis.get_ylim()[0] == 0
    plt.close(figure)


def test_a_pair_of_levels_is_spelt_with_its_unit():
    """Of two thresholds of two ends each."""
    described = {"units": "mm", "long_name": "end"}
    data = xr.Dataset(
        {"probability": (("threshold", "horizon"), [[0.1], [0.2]])},
        {"threshold_lower": ("threshold", [-1.0, -2.0], described)}
        | {"threshold_upper": ("threshold", [3.0, np.inf], described)},
    )
    assert levels(data, "probability") == ["-1, 3 mm", "-2, inf mm"]
    assert level(data["probability"].isel(threshold=-1), "threshold") == "-2, inf mm"
