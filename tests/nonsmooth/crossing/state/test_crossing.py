"""What state_crossing_probability takes, chooses and refuses."""

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.errors import SceneError, ToleranceError
from references import COLORED_FRICTION, FRICTION, OBSTACLE


def test_method_follows_from_the_scene():
    """One variable is solved; paths are counted if asked for, and for all other scenes."""
    assert ns.state_crossing_probability(FRICTION, "y", 1, [1]).attrs["method"] == "deterministic"
    run = ns.state_crossing_probability(FRICTION, "y", 1, [1], paths=1000)
    assert run.attrs["method"] == "monte_carlo"
    run = ns.state_crossing_probability(COLORED_FRICTION, "x", 1, [1], paths=1000)
    assert run.attrs["method"] == "monte_carlo"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("q", 1, [1]), "a variable|variable is 'q'"),
        (("eta", 1, [1]), "variable is 'eta'"),
        (("y", -1, [1]), "threshold > 0"),
        (("y", 1, [2, 1]), "increase"),
    ],
)
def test_bad_arguments(arguments, told):
    """Each is refused in one line that names it."""
    with pytest.raises(SceneError, match=told):
        ns.state_crossing_probability(FRICTION, *arguments)


def test_several_thresholds():
    """A dimension before the horizons; each is what it is alone, by solving and on the same paths.

    Of a rigid obstacle, one beyond the walls keeps the walls for all.
    """
    levels = [(-0.5, np.inf), (-0.7, 0.8)]
    for options in ({}, {"step": 0.1, "paths": 2000}):
        run = ns.state_crossing_probability(FRICTION, "y", levels, [1, 2], **options)
        assert run["probability"].dims == ("threshold", "horizon")
        assert run["threshold_upper"].values.tolist() == [np.inf, 0.8]
        for k, one in enumerate(levels):
            alone = ns.state_crossing_probability(FRICTION, "y", one, [1, 2], **options)
            assert alone.equals(run.isel(threshold=k, drop=True))
    rigid = OBSTACLE.with_n(np.inf)
    run = ns.state_crossing_probability(rigid, "x", [0.5, 2], [5], step=0.02, paths=2000)
    assert run["threshold"].values.tolist() == [0.5, 2]
    assert run["probability"][0] > 0.5
    assert run["probability"][1] == 0
    with pytest.raises(SceneError, match="rigid wall"):
        ns.state_crossing_probability(rigid, "x", [1, 2], [5])
    with pytest.raises(SceneError, match="outside of threshold"):
        ns.state_crossing_probability(ns.Scene("friction", start={"y": 1}), "y", [2, 0.5], [5])


def test_start_outside():
    """A variable that starts outside has crossed already: the question is refused."""
    with pytest.raises(SceneError, match="starts at 2, outside"):
        ns.state_crossing_probability(ns.Scene("friction", start={"y": 2}), "y", 1, [1])


def test_method_without_the_parameter():
    """The deterministic method has no paths."""
    with pytest.raises(SceneError, match="has no parameter 'paths'"):
        ns.state_crossing_probability(FRICTION, "y", 1, [1], method="deterministic", paths=10)


def test_rigid_wall_beyond_the_other_level():
    """Paths touch a rigid wall and do not pass it: no step would see that."""
    with pytest.raises(SceneError, match="rigid wall"):
        ns.state_crossing_probability(OBSTACLE.with_n(np.inf), "x", (-2, 1), [1])


def test_first_contact_does_not_depend_on_the_wall():
    """Up to the first contact a rigid and a soft wall are the same, path by path."""
    runs = [
        ns.state_crossing_probability(OBSTACLE.with_n(n), "x", 1, [2, 4], paths=2000, step=0.02)
        for n in (1.0, np.inf)
    ]
    assert np.array_equal(*(run["probability"] for run in runs))


def test_tolerance_out_of_reach():
    """It is refused with the best value and its error."""
    with pytest.raises(ToleranceError, match="W = ") as refused:
        ns.state_crossing_probability(FRICTION, "y", 1, [1], tol=1e-16)
    best = refused.value.result
    assert best["probability_error"][0] < 1e-9
