"""Maps of sweeps: every value in its place, for one to four parameters."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from studies.figures import maps

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


def test_one_parameter_is_a_line():
    """Value against parameter."""
    figure = maps(np.array([1.0, 2.0]), {"n": [1, 2]}, "value", {"n": [1.0, 2.0]})
    assert figure.axes[0].lines[0].get_ydata().tolist() == [1.0, 2.0]
    plt.close(figure)
