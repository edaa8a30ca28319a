"""Elements of densities: symmetric, with edges on kinks, as wide as some lags within a layer."""

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.grids.mesh.axes import axes
from nonsmooth.grids.mesh.edges import kinks
from nonsmooth.grids.mesh.layers import layered_edges, misses_layer, resolves_layer
from nonsmooth.scenes.symbols import eta, x, y

YIELDING = ns.Scene("elasto_plastic", n=100, potential="x**2/2")
STICKING = ns.Scene("friction", "langevin", n=100)
ENDS = {YIELDING: {y: 4.4, x: 1.045}, STICKING: {eta: 4.4, y: 1.5}}


@pytest.mark.parametrize("level", [0, 3])
@pytest.mark.parametrize("scene", ENDS)
def test_edges_are_symmetric_and_lie_on_kinks(scene, level):
    """They end at the box, contain 0 and every kink of a transported variable, and increase."""
    for symbol, end in ENDS[scene].items():
        edges = layered_edges(scene, symbol, end, level)
        assert np.all(np.diff(edges) > 0)
        assert edges == pytest.approx(-edges[::-1])
        assert edges[-1] == end
        assert 0.0 in edges
        if symbol != scene.noise.driven:
            assert np.min(np.abs(edges - kinks(scene)[symbol])) < 1e-12


@pytest.mark.parametrize("scene", ENDS)
def test_elements_in_a_layer_are_some_lags_wide(scene):
    """The lag behind white noise relaxes at a rate r and has the deviation sigma / sqrt(2 r)."""
    rate = 100 + (scene.damping if scene == STICKING else 0)
    lag = 1 / math.sqrt(2 * rate)
    for level in range(4):
        for symbol, unit in zip(ENDS[scene], (lag, lag / rate), strict=True):
            edges = layered_edges(scene, symbol, ENDS[scene][symbol], level)
            middle = np.abs(edges[1:] + edges[:-1]) / 2
            inside = {y: middle < 0.01, x: middle > 1}.get(symbol, middle < 9)
            inside = inside if symbol != scene.noise.driven else middle < 9
            assert np.max(np.diff(edges)[inside]) <= 6 * unit / (1 + level / 4) * (1 + 1e-9)


def test_few_scenes_have_layers_that_can_be_resolved():
    """Not with more variables, nor if the held variable is driven, nor where lags are tiny."""
    assert resolves_layer(YIELDING, 4.4)
    assert resolves_layer(STICKING, 4.4)
    assert not resolves_layer(YIELDING.with_n(1e4), 4.4)
    for other in (
        ns.Scene("friction", n=100, potential="x**2/2"),
        ns.Scene("obstacle", n=100),
        ns.Scene("elasto_plastic", "langevin", n=100),  # of eta and y alone
        ns.Scene("elasto_plastic", "langevin", n=100, potential="x**2/2"),
    ):
        assert not resolves_layer(other, 4.4)


def _misses(scene):
    """Whether the elements of three variables that are used for densities miss the layer."""
    ends = {eta: 3.8, y: 2.2, x: 1 + 2.2 / scene.n} if scene.mechanics.argument == x else {}
    ends = ends or {eta: 3.8, y: 4.2, x: 12.0}
    made = axes(scene, ends, dict.fromkeys(ends, 1), of_density=True)
    return misses_layer(scene, ends, made[scene.mechanics.argument].edges)


@pytest.mark.parametrize("model", ["elasto_plastic", "friction"])
def test_many_variables_miss_the_layers_of_stiff_forces(model):
    """A lag over the stiffness is a width that few elements have; soft forces need no thin one."""
    scene = ns.Scene(model, "langevin", n=2, potential="x**2/2")
    assert not _misses(scene)
    assert _misses(scene.with_n(100))
    # the elements' widths are proportional to 1/n, those of layers to a higher power of it
    missed = [_misses(scene.with_n(n)) for n in (1, 2, 5, 10, 20, 50, 100, 1000)]
    assert missed == sorted(missed)


def test_walls_have_no_layer():
    """An elastic wall throws the oscillator back: nothing follows anything."""
    assert not _misses(ns.Scene("obstacle", "langevin", n=100, potential="x**2/2"))
