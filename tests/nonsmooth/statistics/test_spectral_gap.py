"""The spectral gap against linear systems and the decay of correlations."""

from dataclasses import replace

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.grids import tensor_grid
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.paths.ensembles import paths_at
from nonsmooth.paths.sampling import Sampling
from nonsmooth.statistics.spectral_gap import gap_on
from references import LAMBDA_LIMIT


def linear(damping, stiffness):
    """Make a linear scene, an obstacle too soft to be felt."""
    potential = f"{stiffness}*x**2/2"
    return ns.Scene("obstacle", n=1e-14, damping=damping, potential=potential, observable="x")


@pytest.mark.parametrize(
    ("damping", "stiffness"), [(1.0, 1.0), (3.0, 1.0), (0.6, 2.0), (2.0, 1.0), (2.000001, 1.0)]
)
def test_linear_oscillator(damping, stiffness):
    """The slowest eigenvalue is that of the drift, exact for polynomials; rounding, if double."""
    exact = -np.linalg.eigvals([[-damping, -stiffness], [1.0, 0.0]]).real.max()
    tol = 1e-5 if damping == pytest.approx(2.0) else 1e-9
    found = ns.spectral_gap(linear(damping, stiffness), tol)
    assert abs(found.value - exact) <= found.error <= tol * found.value


def test_friction_waits_for_the_noise():
    """The gap is the forcing's own rate theta where friction forgets faster."""
    found = ns.spectral_gap(ns.Scene("friction", ns.OrnsteinUhlenbeck(0.3), n=3), tol=1e-4)
    assert abs(found.value - 0.3) <= found.error


def test_it_does_not_depend_on_the_observable():
    """With an odd drift modes are odd or even, whether g is or not."""
    scene = ns.Scene("obstacle", n=10, potential="x**2/2", observable="x")
    skewed = replace(scene, observable="x + x**2")
    assert ns.spectral_gap(skewed).value == ns.spectral_gap(scene).value


def test_dry_friction_in_the_limit():
    """The gap at n = inf is the first eigenvalue."""
    found = ns.spectral_gap(ns.Scene("friction", n=np.inf))
    assert found.value == pytest.approx(LAMBDA_LIMIT, abs=1e-5)


@pytest.mark.slow
def test_correlations_decay_at_the_gap():
    """The mean of the state forgets where it started at least as fast as the gap says."""
    scene = ns.Scene(
        "elasto_plastic", n=20, potential="x**2/2", observable="y", start={"y": 1.5, "x": 0.5}
    )
    gap = ns.spectral_gap(scene, tol=1e-4).value
    times = np.array([2.0, 3.0, 4.0, 5.0])
    sample = paths_at(scene, times, Sampling(0.01, 200_000, 1))[1:, :2]  # y and x
    size = np.abs(sample.mean(axis=2)).sum(axis=1)
    noise = 5 * np.sqrt(2 / 200_000)
    # the slowest mode bounds the decay: |E z_t| <= c e^(-gap t), c from the first time; the
    # factor e allows for a phase of the complex pair that is small at the first time
    assert np.all(size <= np.e * (size[0] + noise) * np.exp(-gap * (times - times[0])) + noise)


@pytest.mark.slow
@pytest.mark.parametrize("tol", [1e-5, 1e-12])
def test_finer_tolerances_keep_what_coarser_ones_know(tol):
    """In a stiff scene a smaller tolerance is met, or refused with a value that is right."""
    scene = ns.Scene("obstacle", n=1e4, damping=0.2, potential="x**2/2", observable="x")
    coarse = ns.spectral_gap(scene, 1e-3)
    try:
        fine = ns.spectral_gap(scene, tol)
    except ToleranceError as refused:
        fine = refused.result
    assert abs(fine.value - coarse.value) <= fine.error + coarse.error
    assert fine.error <= coarse.error


@pytest.mark.slow
@pytest.mark.parametrize(
    ("damping", "stiffness", "exact"), [(1.0, 1.0, 0.5), (1.6, 0.64, 0.8), (4.0, 1.0, 2 - 3**0.5)]
)
def test_linear_oscillator_with_colored_noise(damping, stiffness, exact):
    """With three variables the slowest of the noise's rate, 1, and the oscillator's.

    The second has a double rate, which has no condition number.
    """
    scene = replace(linear(damping, stiffness), noise=ns.OrnsteinUhlenbeck())
    found = ns.spectral_gap(scene, 1e-3)
    assert abs(found.value - exact) <= found.error <= 1e-3 * found.value


@pytest.mark.slow
def test_either_parity_may_be_tried_first():
    """The one that is not slower is only seen, and leaves the slowest rate as it is."""
    scene = ns.Scene("elasto_plastic", "langevin", n=1.3, potential="x**2/2")
    grid = tensor_grid.fitted(scene, 8.0, 1)
    odd, even = (gap_on(scene, grid, 1e-5, first) for first in (ODD, EVEN))
    assert odd.parity == even.parity
    assert odd.rate == pytest.approx(even.rate, rel=2e-5)


def test_noise_alone_is_refused():
    """The solvers need the velocity."""
    with pytest.raises(SceneError, match="noise alone"):
        ns.spectral_gap(ns.Scene("friction", "langevin", observable="eta"))


@pytest.mark.slow
def test_yielding_with_colored_noise():
    """A gap of three variables that no other method knows, at two tolerances."""
    scene = ns.Scene("elasto_plastic", "langevin", n=10, potential="x**2/2")
    loose, tight = (ns.spectral_gap(scene, tol) for tol in (1e-2, 1e-3))
    assert abs(loose.value - tight.value) <= loose.error + tight.error
    assert tight.error <= 1e-3 * tight.value


@pytest.mark.slow
@pytest.mark.parametrize(("model", "n"), [("elasto_plastic", 1e6), ("obstacle", 1e10)])
def test_the_nonsmooth_limit(model, n):
    """A large n is 1/n, or n^(-1/2) with elastic walls, from it."""
    g = "y" if model == "elasto_plastic" else "x"
    scene = ns.Scene(model, n=n, potential="x**2/2", observable=g)
    limit, stiff = ns.spectral_gap(scene.with_n(np.inf), 1e-5), ns.spectral_gap(scene, 1e-5)
    rest = n ** (-0.5 if model == "obstacle" else -1.0)
    assert abs(limit.value - stiff.value) <= limit.error + stiff.error + 2 * rest


@pytest.mark.slow
def test_modes_of_the_other_parity_need_not_settle():
    """On a larger box those of even functions do not, which decay twice as fast as the slowest."""
    noise = ns.Langevin(potential="1.46464*eta**2/2", sigma=0.73412)
    scene = ns.Scene("obstacle", noise, 19.924, 0.83708, potential="x**2/2", observable="x")
    loose, tight = ns.spectral_gap(scene, 3e-2), ns.spectral_gap(scene, 1e-3)
    assert abs(loose.value - tight.value) <= loose.error + tight.error
