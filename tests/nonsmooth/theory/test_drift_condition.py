"""The search finds no violation of the drift condition, and finds those that are there."""

from dataclasses import replace

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.scenes.symbols import eta, x, y, zeta
from nonsmooth.theory import lyapunov
from nonsmooth.theory.drift_condition import grid, margins, variables

QUARTIC = ns.Langevin("eta**4/4 + eta**2/2")
WELLS = "x**2/2 + 4*exp(-x**2)"


@pytest.mark.parametrize("model", ["elasto_plastic", "friction", "obstacle"])
@pytest.mark.parametrize("noise", ["white", "langevin", QUARTIC, "hamiltonian"])
@pytest.mark.parametrize(("damping", "n"), [(0.1, 2), (1.0, 100), (10.0, 1e4)])
def test_every_scene_has_room(model, noise, damping, n):
    """(HV2), the boxed bound, the lower bound and the claims hold, Claim 10 as mended."""
    m = margins(ns.Scene(model, noise, n=n, damping=damping, potential=WELLS), points=3000)
    for name in ("drift", "boxed", "lower", "mechanical", "forcing"):
        assert getattr(m, name) >= -m.rounding, name
    assert m.drift > 0
    assert m.coefficient > 0
    assert m.supremum_error < 1e-10 * m.constant
    if noise == "hamiltonian":
        assert m.forcing_printed < -0.1
    else:
        assert m.forcing_printed == m.forcing


def test_velocity_alone():
    """Dry friction with U = 0, where the supremum is known: at y = 0."""
    scene = ns.Scene("friction", n=100)
    assert variables(scene) == (y,)
    m, c = margins(scene), lyapunov.constants(scene)
    assert m.supremum == pytest.approx(c.delta / 2 + c.epsilon * c.C_V, rel=1e-14)


def test_supremum_is_found_off_the_grid():
    """Refinement finds it in two wells between the points of a coarse grid."""
    scene = ns.Scene("elasto_plastic", n=2, potential=WELLS)
    coarse, fine = (margins(scene, points=points).supremum for points in (300, 100_000))
    # the fine grid alone, without refinement
    z = grid(scene, (y, x), 100_000, 1e6)
    unrefined = float(np.max(lyapunov.evaluate(scene, z)[0]))
    assert coarse >= unrefined
    assert fine == pytest.approx(coarse, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "noise", "name"),
    [
        # without enough damping of y^2 the drift grows with y
        ({"delta": 0.5}, "white", "boxed"),
        ({"C_V": 0.5}, "white", "lower"),
        # faster than the potential pulls back
        ({"epsilon": 5.0}, "white", "mechanical"),
        ({"epsilon": 3.0}, "langevin", "forcing"),
        ({"epsilon": 1.0}, "hamiltonian", "forcing"),
        # the forcing eta (delta y + x) is not absorbed
        ({"noise_weight": 0.1}, "langevin", "boxed"),
        ({"noise_weight": 0.1}, "hamiltonian", "boxed"),
    ],
)
def test_wrong_constants_are_found_out(monkeypatch, change, noise, name):
    """The search is one that can fail."""
    scene = ns.Scene("elasto_plastic", noise, n=2, potential="x**2/2")
    lyapunov.functions.cache_clear()
    wrong = replace(lyapunov.constants(scene), **change)
    monkeypatch.setattr(lyapunov, "constants", lambda scene: wrong)
    m = margins(scene, points=3000)
    lyapunov.functions.cache_clear()
    assert getattr(m, name) < -1e-3


def test_grid():
    """The grid is symmetric and holds 0, the kinks and the reach."""
    scene = ns.Scene("friction", "hamiltonian", n=50, potential="x**2/2")
    names = (zeta, eta, y, x)
    z = grid(scene, names, 5000, 1e4)
    assert variables(scene) == names
    for s in names:
        assert {-1e4, 0.0, 1e4} <= set(z[s])
        assert set(z[s]) == set(-z[s])
    assert {-0.02, 0.02} <= set(z[y])
    assert 2000 < len(z[y]) < 10_000
