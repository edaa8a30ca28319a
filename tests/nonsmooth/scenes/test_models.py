"""A model is known by its penalty alone: other knots and slopes than the paper's work as well.

The forces on the oscillator balance: gamma^2 of the sum of all forces but the noise is sigma^2,
whatever the penalty. This holds for paths and for the equation, without any discretisation.
"""

from dataclasses import replace

import pytest
import sympy

import nonsmooth as ns
from nonsmooth.errors import SceneError
from nonsmooth.paths.schemes.strang import STRANG
from nonsmooth.scenes.models.elasto_plastic import ELASTO_PLASTIC
from nonsmooth.scenes.models.friction import FRICTION
from nonsmooth.scenes.models.obstacle import OBSTACLE
from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.penalties import Penalty, n

TWO_SLOPES = Penalty("d", "d", sympy.Float(0.2), sympy.Float(5.0), sympy.Float(0.3))
NARROW_WALLS = Penalty("d", "d", sympy.Float(0.5), sympy.Integer(0), n)
CLIPPED = "max(min(y, 0.2), -0.2)"

OTHERS = {
    "friction": (
        replace(FRICTION, name="two slopes", penalty=TWO_SLOPES),
        "0",
        f"y + 5*{CLIPPED} + 0.3*(y - {CLIPPED})",
    ),
    "plastic": (
        replace(ELASTO_PLASTIC, name="early yield", penalty=NARROW_WALLS),
        "x**2/2",
        "x + y",
    ),
    "spring": (replace(OBSTACLE, name="narrow", penalty=NARROW_WALLS), "0", "contact_force"),
}


@pytest.mark.parametrize("kind", OTHERS)
def test_forces_balance_for_other_penalties(kind):
    """gamma^2 = 1 by the deterministic method and, within its error, by Monte Carlo."""
    model, potential, forces = OTHERS[kind]
    scene = ns.Scene(model, n=50, potential=potential, observable=forces)
    assert STRANG.handles(scene)
    solved = ns.asymptotic_variance(scene, tol=1e-4, method="deterministic")
    assert solved.value == pytest.approx(1.0, rel=2e-4)
    assert abs(solved.value - 1.0) <= solved.error + 1e-10
    sampled = ns.asymptotic_variance(scene, tol=0.03, method="monte_carlo")
    assert abs(sampled.value - 1.0) <= 1.5 * sampled.error


def test_a_penalty_without_n_is_its_own_limit():
    """Friction that does not depend on n has the same gamma^2 at n = inf."""
    model, _, forces = OTHERS["friction"]
    for observable in (forces, "y"):
        soft, limit = (
            ns.asymptotic_variance(ns.Scene(model, n=k, observable=observable), tol=1e-9)
            for k in (50, float("inf"))
        )
        assert limit.value == pytest.approx(soft.value, rel=1e-12)


def test_what_is_asked_of_the_papers_models():
    """Where the penalty acts, and where the walls are at n = inf."""
    asked = {
        name: (m.is_friction, m.is_dry_friction, m.is_plastic, m.in_potential, m.wall)
        for name, m in MODELS.items()
    }
    assert asked == {
        "elasto_plastic": (False, False, True, False, 1.0),
        "friction": (True, True, False, False, float("inf")),
        "obstacle": (False, False, False, True, 1.0),
    }
    assert replace(OBSTACLE, name="narrow", penalty=NARROW_WALLS).wall == 0.5


def test_walls_confine_the_start():
    """At n = inf a start beyond the model's own wall is refused."""
    narrow = replace(OBSTACLE, name="narrow", penalty=NARROW_WALLS)
    ns.Scene(narrow, n=float("inf"), start={"x": 0.4})
    with pytest.raises(SceneError, match=r"confined to \[-0.5, 0.5\]"):
        ns.Scene(narrow, n=float("inf"), start={"x": 0.6})


def test_the_limit_of_another_penalty_is_not_simulated():
    """The exact flows at n = inf are those of the paper's penalties."""
    scene = ns.Scene(OTHERS["spring"][0], n=float("inf"), observable="x")
    with pytest.raises(SceneError, match="finite n"):
        ns.simulate(scene, 1.0, step=0.1, paths=8)
