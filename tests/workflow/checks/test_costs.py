"""Costs are estimated before a run: close to what was measured, and refused above the limits."""

from collections import Counter

import pytest

from reproduction.configuration.files import read
from reproduction.errors import ConfigError
from support import ROOT
from workflow.checks.costs import GB, check_costs, costs

CONFIG = read(ROOT / "config.yaml")
# seconds on one core, and megabytes of the largest job, of a run at the paper's sizes, by the
# benchmark files of its jobs; two jobs at a time, so that waiting is left out
MEASURED = {
    "convergence": (22, 243),
    "crossing": (129, 369),
    "density": (67, 592),
    "gamma2": (146, 468),
    "limit_theorem": (30, 294),
    "plasticity": (27, 331),
    "rates": (126, 536),
    "sweep": (150, 354),
    "theorems": (14, 205),
    "trajectories": (6, 291),
    "variance": (20, 296),
}


def changed(**changes):
    """Return the configuration with other values in its sections."""
    return CONFIG | {name: CONFIG[name] | own for name, own in changes.items()}


def test_estimates_are_close_to_what_was_measured():
    """Within a factor of three, topic by topic, for time and for memory."""
    seconds, memory = Counter(), Counter()
    for cost in costs(CONFIG):
        topic = next(iter(cost.sizes))[0].replace("finite_p", "crossing")
        seconds[topic] += cost.seconds
        memory[topic] = max(memory[topic], cost.memory)
    for topic, (measured, megabytes) in MEASURED.items():
        assert measured / 3 < seconds[topic] < 3 * measured, topic
        assert megabytes / 3 < memory[topic] / 1e6 < 3 * megabytes, topic


def test_the_paper_has_ample_room():
    """A tenth of the limits is enough for it."""
    found = list(costs(CONFIG))
    assert sum(cost.seconds for cost in found) < 360 * CONFIG["limits"]["hours"]
    assert max(cost.memory for cost in found) < 0.2 * GB * CONFIG["limits"]["memory"]


@pytest.mark.parametrize(
    ("changes", "limit", "key"),
    [
        ({"crossing": {"paths": 10**15}}, "hours", "'crossing.paths' = 1000000000000000"),
        ({"crossing": {"step": 1e-12}}, "hours", "'crossing.step' = 1e-12"),
        ({"crossing": {"outputs": 10**12}}, "memory", "'crossing.outputs' = 1000000000000"),
        ({"convergence": {"horizon": 1e12}}, "memory", "'convergence.horizon'"),
        ({"plasticity": {"tolerance": 1e-6}}, "hours", "'plasticity.tolerance' = 1e-06"),
        ({"limit_theorem": {"paths": 10**10}}, "memory", "'limit_theorem.paths'"),
    ],
)
def test_sizes_above_the_limits(changes, limit, key):
    """The key to blame comes first; the limit is named; the rest of the line is short."""
    with pytest.raises(ConfigError) as error:
        check_costs(changed(**changes))
    message = str(error.value)
    assert message.startswith(key)
    assert f"above 'limits.{limit}' = " in message
    assert "raise the limit" in message
    assert "\n" not in message


def test_the_limit_can_be_raised():
    """A run of a hundred hours is allowed to those who ask for it."""
    long = {"crossing": {"paths": 400_000_000, "shard": 10_000_000}}
    with pytest.raises(ConfigError, match="hours on one core"):
        check_costs(changed(**long))
    check_costs(changed(**long, limits={"hours": 1000}))


def test_more_memory_than_the_machine_has(monkeypatch):
    """It is refused whatever the limit."""
    changes = {"limit_theorem": {"paths": 10**9}, "limits": {"memory": 1e6, "hours": 1e6}}
    monkeypatch.setattr("psutil.virtual_memory", lambda: type("Memory", (), {"total": 16 * GB}))
    with pytest.raises(ConfigError, match="this machine has 16 GB"):
        check_costs(changed(**changes))
