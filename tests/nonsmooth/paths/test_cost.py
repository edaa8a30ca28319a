"""What nobody can wait for, or keep, is refused before it starts."""

import pytest

import nonsmooth as ns
from nonsmooth.crossing import counting
from nonsmooth.errors import ToleranceError
from nonsmooth.paths import cost, tuning
from nonsmooth.paths.cost import require_memory, require_time
from nonsmooth.paths.sampling import Sampling

SCENE = ns.Scene("friction")


def test_the_limit_is_the_documented_one():
    """A run just below `longest_run` is allowed, one twice as long is not."""
    steps = (
        3600 * tuning.COST.longest_run / (tuning.COST.block_step + tuning.COST.path_step["float32"])
    )
    require_time(0.99 * steps, Sampling(0.1, 1, 0, threads=1))
    with pytest.raises(ns.NonsmoothError, match=f"limit of {tuning.COST.longest_run:g}"):
        require_time(2 * steps, Sampling(0.1, 1, 0, threads=1))


def test_hours_are_allowed():
    """1e9 paths of 1e4 steps, a few hours on two cores, are nobody's mistake."""
    require_time(1e4, Sampling(0.1, 10**9, 0, threads=2))


def test_double_precision_takes_longer():
    """The same steps are allowed in single precision, and refused in double."""
    paths = 10**6
    steps = 3600 * tuning.COST.longest_run / (2 * paths * tuning.COST.path_step["float32"])
    require_time(steps, Sampling(0.1, paths, 0, threads=1))
    with pytest.raises(ns.NonsmoothError, match="hours"):
        require_time(steps, Sampling(0.1, paths, 0, threads=1, precision="float64"))


@pytest.mark.parametrize(
    ("arguments", "steps"),
    [
        ({"step": 1e-3, "paths": 1000}, 1e3 * 1000 * 4 / 1000),  # paths, and halving of each
        ({"step": 1e-3, "paths": 1000, "p": 1e3}, 1e6 * 1000 * 4 / 1000),
    ],
)
def test_crossings_count_their_steps(monkeypatch, arguments, steps):
    """Steps are p T / step; paths and their halvings are estimated before they start."""
    asked = []

    def record(count, sampling):
        asked.append(count * sampling.paths / 1000)
        if len(asked) == 2:
            raise ToleranceError("enough")

    monkeypatch.setattr(cost, "require_time", record)
    monkeypatch.setattr(counting, "march", lambda s, panel, lanes, steps, lower, upper: lanes)
    with pytest.raises(ToleranceError, match="enough"):
        ns.crossing_probability(SCENE, 0.1, [1.0], method="monte_carlo", threads=1, **arguments)
    assert sum(asked) == pytest.approx(steps)


@pytest.mark.parametrize(
    "arguments",
    [
        {"horizon": 10, "step": 1e-12},
        {"horizon": 10, "step": 1e-12, "paths": 1, "keep": "paths"},
        {"horizon": 1e15},
        {"horizon": 1e15, "step": 0.1, "paths": 10},
        {"horizon": 1e300, "step": 0.1, "paths": 10},
        {"horizon": 1, "step": 0.01, "paths": 10**15},
        {"horizon": 1, "tol": 1e-9},
    ],
)
def test_endless_simulations_are_refused(arguments):
    """Each is refused with its cost and a cure, in one line, before it starts."""
    with pytest.raises(ns.NonsmoothError, match=r"choose|use tol|give a number") as refused:
        ns.simulate(SCENE, **arguments)
    assert "\n" not in str(refused.value)


def test_paths_that_no_memory_holds_are_refused():
    """1e9 paths at 200 times would be terabytes."""
    with pytest.raises(ns.NonsmoothError, match="GB of memory"):
        ns.simulate(SCENE, 1, step=0.01, paths=10**9, keep="paths")
    require_memory(1e6)
