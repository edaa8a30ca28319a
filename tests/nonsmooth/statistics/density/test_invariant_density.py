"""Invariant densities: closed forms against grids, averages over bins against simulations."""

import math

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.grids import tensor_grid
from nonsmooth.paths.ensembles import paths_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.statistics.density.bins import bin_averages
from nonsmooth.statistics.density.closed_form import closed_form
from nonsmooth.statistics.density.invariant_density import invariant_density
from nonsmooth.statistics.density.on_grids import densities_on
from nonsmooth.statistics.density.sampled import sampled_densities
from references import FALSE_ALARM, FRICTION, OBSTACLE, PLASTIC


def test_gibbs_density_is_the_grids():
    """Both agree within the difference of two grids and 1e-3 of the maximum."""
    grid = tensor_grid.fitted(OBSTACLE, tensor_grid.depth_for(1e-3), 1)
    points = {"y": np.linspace(-3, 3, 61), "x": np.linspace(-1.2, 1.2, 61)}
    coarse, fine = (densities_on(OBSTACLE, grid.all_raised(by), points, 1e-6) for by in (2, 3))
    for name, exact in closed_form(OBSTACLE).items():
        value, error = exact(points[name])
        difference = np.max(np.abs(fine[name,] - coarse[name,]))
        assert difference < 1e-3 * value.max()
        assert np.max(np.abs(fine[name,] - value)) < difference + 1e-4 * value.max()
        assert np.max(error) < 1e-8 * value.max()


@pytest.mark.parametrize("scene", [OBSTACLE, FRICTION])
def test_closed_forms_have_mass_one_and_are_even(scene):
    """Averages over bins that hold all but 1e-12 of the mass sum to 1 and are even."""
    edges = {name: np.linspace(-8, 8, 161) for name in scene.state}
    edges |= {"x": np.linspace(-3, 3, 61)} if "x" in scene.state else {}
    for name, (value, error) in bin_averages(scene, edges, 1e-8).items():
        assert value @ np.diff(edges[name]) == pytest.approx(1, abs=1e-8)
        assert value == pytest.approx(value[::-1], abs=1e-10)
        assert np.all(error < 1e-8 * value.max())


@pytest.mark.parametrize("scene", [OBSTACLE, FRICTION])
def test_closed_forms_are_the_public_densities(scene):
    """`invariant_density` returns the closed form with its error, where there is one."""
    found = invariant_density(scene)
    for name in scene.state:
        assert float(found[f"density_{name}_error"]) < 1e-8
        assert np.allclose(
            found[f"density_{name}"], closed_form(scene)[name](found[name].values)[0]
        )


def test_averages_agree_with_a_simulation():
    """Chi-square test of both variables of the elasto-plastic model; false alarms 1e-5 each."""
    paths = 4000
    y, x, _ = paths_at(PLASTIC, [20], Sampling(0.01, paths, 3, threads=1))[-1]
    edges = {"y": np.linspace(-1.6, 1.6, 17), "x": np.linspace(-1.05, 1.05, 15)}
    solved = bin_averages(PLASTIC, edges, 3e-3)
    for name, sample in (("y", y), ("x", x)):
        share = solved[name][0] * np.diff(edges[name])
        expected = paths * np.append(share, 1 - share.sum())
        inside = np.histogram(sample, edges[name])[0]
        counts = np.append(inside, paths - inside.sum())
        use = expected > 5
        statistic = np.sum((counts - expected)[use] ** 2 / expected[use])
        assert statistic < stats.chi2.isf(FALSE_ALARM, np.sum(use))


def test_averages_of_three_variables_agree_with_a_simulation():
    """Also beside the kink, where the density of a displacement that yields is steep.

    Paths in a bin are binomial; all 26 deviate by less than 5 standard errors but with the
    probability 1.5e-5. The step of 0.02 has a bias of less than a standard error.
    """
    scene, paths = ns.Scene("elasto_plastic", "langevin", n=100, potential="x**2/2"), 20_000
    edges = np.concatenate([-np.linspace(1.1, 0, 14), np.linspace(0, 1.1, 14)[1:]])
    value, error = bin_averages(scene, {"x": edges}, 5e-2)["x"]
    assert np.max(error) <= 2e-2 * np.max(value)  # with one element towards the kink 0.13
    state = paths_at(scene, [20], Sampling(0.02, paths, 3))[-1]
    sample = state[scene.state.index("x")]
    width, counts = np.diff(edges), np.histogram(sample, edges)[0]
    share = value * width
    spread = np.sqrt(share * (1 - share) / paths)
    assert np.all(np.abs(counts / paths - share) <= 5 * spread + error * width + 1 / paths)


def test_error_holds_a_finer_solution():
    """The error at a loose tolerance covers the difference to a tight one."""
    edges = {"y": np.linspace(-2, 2, 21)}
    loose, error = bin_averages(PLASTIC, edges, 1e-2)["y"]
    tight, _ = bin_averages(PLASTIC, edges, 1e-5)["y"]
    assert np.max(np.abs(loose - tight)) < np.max(error)


def test_the_nonsmooth_limit_is_refused():
    """At n = inf part of the mass is on the walls, so that there is no density."""
    with pytest.raises(SceneError, match="finite n"):
        bin_averages(PLASTIC.with_n(math.inf), {"y": [-1, 1]}, 1e-2)


def test_closed_forms_of_the_nonsmooth_limit():
    """A displacement is normal but held between walls, and a velocity is exp(-2 |y| - y^2)."""
    x, y = np.linspace(-1.2, 1.2, 49), np.linspace(-3, 3, 41)
    held = ns.Scene("obstacle", ns.White(1.0), math.inf, 0.5, potential="x**2/2", observable="x")
    found = ns.invariant_density(held, points={"y": y, "x": x})
    for name, exact in (("x", stats.truncnorm(-1, 1).pdf(x)), ("y", stats.norm.pdf(y))):
        error = float(found[f"density_{name}_error"])
        assert np.all(np.abs(found[f"density_{name}"] - exact) <= error)
        assert error < 1e-12
    sliding = ns.invariant_density(ns.Scene("friction", n=math.inf), points={"y": y})
    total = math.e * math.sqrt(math.pi) * math.erfc(1.0)
    exact = np.exp(-2 * np.abs(y) - y**2) / total
    gap = np.abs(sliding["density_y"] - exact)
    assert np.all(gap <= float(sliding["density_y_error"]) + 4 * np.finfo(float).eps * exact)
    assert set(ns.invariant_density(held).x.values[[0, -1]]) == {-1.0, 1.0}


@pytest.mark.parametrize(
    ("n", "damping", "sigma", "bins"), [(265.0, 2.0, 1.5, 161), (1.0, 1.0, 1.0, 61)]
)
def test_loose_averages_are_within_their_errors_in_every_bin(n, damping, sigma, bins):
    """Also where two grids agree by chance, in tails, and beyond the box; and none is negative."""
    scene = ns.Scene("friction", ns.Langevin("eta**2/2", sigma), n=n, damping=damping)
    edges = {"y": np.linspace(-4, 4, bins + 1)}
    (loose, loose_error), (tight, tight_error) = (
        bin_averages(scene, edges, tol)["y"] for tol in (1e-1, 1e-3)
    )
    assert np.all(np.abs(loose - tight) <= loose_error + tight_error)
    assert np.all(loose >= 0)
    assert np.max(loose_error) <= 0.1 * np.max(loose) * (1 + 1e-3)


@pytest.mark.slow
def test_loose_averages_of_what_friction_holds_are_within_their_errors():
    """With three variables no element is as narrow as the layer; two grids are close by chance."""
    scene = ns.Scene("friction", "langevin", n=10, potential="x**2/2")
    edges = {"y": 0.1 * np.arange(-5, 9)}
    loose, error = bin_averages(scene, edges, 1e-1)["y"]
    middle = (edges["y"][1:] + edges["y"][:-1]) / 2
    points = {"eta": np.array([-1.0, 1.0]), "y": middle, "x": np.array([-10.0, 10.0])}
    paths = sampled_densities(scene, 2e-2, points)["y",]
    assert np.all(np.abs(loose - paths.value) <= error + paths.error)


@pytest.mark.slow
@pytest.mark.parametrize(("n", "finest"), [(10, 1e-2), (100, 5e-2)])
def test_loose_tolerances_are_within_their_errors(n, finest):
    """Also at rest at the wall, the only point at which grids converge slowly."""
    points = {"y": [0.0, 1.0], "x": [-1.0, 0.0, 1.0]}
    scene = ns.Scene("elasto_plastic", potential="x**2/2", n=n)
    fine = ns.invariant_density(scene, finest, points, "deterministic")
    for tol in (tol for tol in (1e6, 1.0, 0.5, 0.3, 0.1) if tol > finest):
        loose = ns.invariant_density(scene, tol, points, "deterministic")
        for name in ("density_y", "density_x", "density_y_x"):
            allowed = loose[f"{name}_error"] + fine[f"{name}_error"]
            assert bool((abs(loose[name] - fine[name]) <= allowed).all())


@pytest.mark.slow
def test_a_thin_layer_is_resolved_in_deeper_boxes_too():
    """What is met to a per cent is not refused to a tenth of it, and agrees."""
    scene = ns.Scene("elasto_plastic", ns.White(0.87), n=900, damping=1.3, potential="x**2/2")
    points = {"x": [0.0, 0.5], "y": [0.0, 0.5]}
    loose, tight = (
        ns.invariant_density(scene, tol, points, method="deterministic") for tol in (1e-2, 1e-3)
    )
    for name in ("density_x", "density_y", "density_y_x"):
        stated = loose[f"{name}_error"] + tight[f"{name}_error"]
        assert np.all(abs(loose[name] - tight[name]) <= stated)
