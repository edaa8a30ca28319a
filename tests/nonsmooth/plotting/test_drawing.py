"""Every public result is drawn by one line, and what is drawn are its values and its band."""

import subprocess
import sys

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

import nonsmooth as ns
from nonsmooth.errors import SceneError
from public_results import RESULTS, as_dataset
from references import FRICTION, OBSTACLE

mpl.use("agg")


@pytest.fixture(autouse=True)
def _no_figures_left():
    yield
    plt.close("all")


@pytest.mark.parametrize("name", RESULTS)
def test_every_public_result_is_drawn(name):
    """All panels have titles on their axes; also of what a file has given back."""
    panels = ns.plot(RESULTS[name]())
    for panel in panels.values():
        panel.figure.draw_without_rendering()
        assert panel.has_data()
        assert panel.get_ylabel()
    assert ns.plot(as_dataset(RESULTS[name]())).keys() == panels.keys()


def test_a_curve_has_the_band_of_its_error():
    """The line is the value; the band, that of crossings between `lower` and `upper`."""
    found = RESULTS["crossing_probability"]()
    (panel,) = ns.plot(found).values()
    assert np.array_equal(panel.lines[0].get_ydata(), found["probability"])
    corners = panel.collections[0].get_paths()[0].vertices[:, 1]
    assert set(found["lower"].values) | set(found["upper"].values) <= set(corners)
    times = RESULTS["variance"]()
    corners = ns.plot(times)["v"].collections[0].get_paths()[0].vertices[:, 1]
    assert set((times["v"] + times["v_error"]).values) <= set(corners)


def test_results_are_compared_in_one_panel():
    """Several by name, with a legend; estimates over numbers."""
    exact = RESULTS["crossing_probability"]()
    panels = ns.plot({"one": exact, "another": exact})
    (panel,) = panels.values()
    assert [text.get_text() for text in panel.get_legend().get_texts()] == ["one", "another"]
    values = {n: ns.asymptotic_variance(FRICTION.with_n(n)) for n in (1, 10)}
    drawn = ns.plot(values)["value"].lines[0]
    assert np.array_equal(drawn.get_xdata(), [1, 10])
    assert np.array_equal(drawn.get_ydata(), [one.value for one in values.values()])
    times = {str(b): ns.failure_time(FRICTION, b, method="asymptotic") for b in (0.5, 0.6)}
    (panel,) = ns.plot(times).values()
    ends = {end for bar in panel.collections[0].get_segments() for end in bar[:, 1]}
    limits = {float(one[limit].squeeze()) for one in times.values() for limit in ("lower", "upper")}
    assert sorted(ends) == pytest.approx(sorted(limits), rel=1e-12)


def test_brownian_crossings_keep_their_coordinates():
    """Arrays of xarray give such arrays, with the same values as plain ones."""
    T = xr.DataArray(np.linspace(0, 2, 5), dims="T", coords={"T": np.linspace(0, 2, 5)})
    b = xr.DataArray([0.5, 1.0], dims="b", coords={"b": [0.5, 1.0]})
    for function in (
        ns.brownian_crossing,
        ns.brownian_survival,
        ns.brownian_first_passage_density,
    ):
        found = function(b, T)
        assert found.dims == ("b", "T")
        assert np.array_equal(found, function(b.values[:, None], T.values))
        assert np.array_equal(function(1.0, T, -0.5), function(1.0, T.values, -0.5))
    (panel,) = ns.plot(ns.brownian_crossing(b, T)).values()
    assert [text.get_text() for text in panel.get_legend().get_texts()] == ["b = 0.5", "b = 1"]


def test_what_is_no_result_is_refused():
    """In one line."""
    for wrong in (3.0, "friction", {}, {"a": 1}, FRICTION, [1, 2]):
        with pytest.raises(SceneError, match="give what a function of nonsmooth returns"):
            ns.plot(wrong)
    found = ns.crossing_probability(FRICTION, 0.5, [1.0, 2.0], method="asymptotic")
    with pytest.raises(SceneError, match="give what a function of nonsmooth returns"):
        ns.plot(found.astype(object))
    with pytest.raises(SceneError, match="lower has other dimensions"):
        ns.plot(found.assign(lower=found.lower.expand_dims(more=2)))
    with pytest.raises(SceneError, match="isel"):
        ns.plot(xr.DataArray(np.zeros((2, 3, 4)), dims=("x", "y", "z")))


def test_one_point_of_a_curve_is_a_number():
    """Also where the dimension is kept."""
    found = ns.crossing_probability(FRICTION, 0.5, [1.0, 2.0], method="asymptotic")
    (panel,) = ns.plot(found.probability.isel(horizon=[0])).values()
    assert len(panel.lines) > 0


def test_nothing_else_imports_matplotlib():
    """Computing works without it."""
    code = (
        "import sys, nonsmooth as ns; ns.plot; ns.spectral_gap(ns.Scene('friction'))\n"
        "assert 'matplotlib' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_densities_have_a_panel_for_each_variable_and_a_map():
    """Two curves over x and y, and the map of both."""
    points = {"x": np.linspace(-1, 1, 31), "y": np.linspace(-2, 2, 31)}
    panels = ns.plot(ns.invariant_density(OBSTACLE, points=points))
    assert set(panels) == {"density_x", "density_y", "density_y_x"}
    assert panels["density_y_x"].get_xlabel() == "displacement x"
