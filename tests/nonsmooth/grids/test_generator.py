"""The generator on a tensor grid against its action by hand."""

import numpy as np
import sympy

import nonsmooth as ns
from nonsmooth.grids import generator
from nonsmooth.grids.mesh.axes import axes as axes_of
from nonsmooth.scenes.symbols import eta, x, y


def test_the_generator_is_exact_on_polynomials():
    """A_n f of a quadratic f at the nodes, computed symbolically; linear drift between kinks."""
    scene = ns.Scene("elasto_plastic", n=10, potential="x**2/2")
    axes = axes_of(scene, {y: 3.0, x: 1.5}, {y: 1, x: 1})
    matrix = generator.assemble(scene, axes)
    f = x**2 + x * y + y**2
    drift = scene.numerical_drift()
    exact = sum(drift[s] * sympy.diff(f, s) for s in (y, x)) + sympy.diff(f, y, 2) / 2
    found = matrix @ generator.evaluate(f, axes)
    wanted = generator.evaluate(exact, axes)
    # the weak second derivative has zero slope at the ends: compare within
    inside = generator.evaluate(sympy.Abs(y), axes) < 2.9
    scale = np.abs(wanted).max()
    edges = np.isin(generator.evaluate(y, axes), axes[y].edges)
    assert np.max(np.abs(found - wanted)[inside & ~edges]) < 1e-10 * scale
    assert np.max(np.abs(matrix @ np.ones(matrix.shape[0]))) < 1e-9


def test_interpolation_at_points_is_exact_on_polynomials():
    """Within elements that differ in degree; 0 outside the grid."""
    scene = ns.Scene("elasto_plastic", "langevin", n=10, potential="x**2/2")
    symbols = eta, y, x
    axes = axes_of(scene, {eta: 3.0, y: 3.0, x: 1.5}, {eta: 1, y: 1, x: 1})
    f = x**2 + x * y**2 + eta * y - eta
    draw = np.random.default_rng(1).uniform
    points = {symbol: draw(-1.4, 1.4, size=1000) for symbol in symbols}
    points[x][::10] = 1.6
    found = generator.at_points(generator.evaluate(f, axes), axes, points)
    exact = sympy.lambdify(symbols, f)(*points.values())
    assert np.max(np.abs(found - np.where(points[x] < 1.5, exact, 0.0))) < 1e-12
