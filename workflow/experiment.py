"""What the rules derive from the configuration."""

from math import ceil, isfinite


def label(number: float) -> str:
    """Spell a number of the configuration as it stands in file names."""
    return f"{float(number):.17g}"


def swept(config: dict) -> dict[str, dict]:
    """Return the scenes that the sweep simulates, by their names."""
    return {name: config["sweep"]["scenes"][name] for name in config["sweep"]["simulated"]}


def rare(config: dict) -> dict[str, dict]:
    """Return the parameters and the far thresholds of the scenes of figure 13, by their names."""
    topic, scenes = config["rare_crossings"], config["sweep"]["scenes"]
    return {
        name: {"scene": scenes[name]["scene"], "thresholds": topic["thresholds"][name]}
        for name in topic["scenes"]
    }


def ergodic_scenes(config: dict) -> dict[str, dict]:
    """Return the parameters of the scenes of table 7b by their names, in the table's order."""
    scenes = config["sweep"]["scenes"]
    return {name: scenes[name]["scene"] for name in config["theorems"]["ergodicity"]["scenes"]}


def of_growing_n(config: dict) -> dict[str, dict]:
    """Return the parameters of the scenes of table 12 by their names, at their smallest n."""
    rates = config["rates"]
    smallest = rates["crossing"]["smallest"]
    return {
        name: rates["scenes"][name]["scene"] | {"n": smallest[name]}
        for name in rates["crossing"]["scenes"]
    }


def shards(topic: dict) -> list[int]:
    """List the shards of a Monte Carlo section of the configuration."""
    return list(range(ceil(topic["paths"] / topic["shard"])))


def part(topic: dict, shard: str) -> tuple[int, int]:
    """Return the first path of a shard and the number of its paths."""
    first = int(shard) * topic["shard"]
    return first, min(topic["shard"], topic["paths"] - first)


def halving_paths(topic: dict, p: str) -> int:
    """Choose the paths on which the step is halved: the same cost at every p, at most all paths."""
    return min(topic["paths"], round(topic["halving"]["paths"] * max(topic["p"]) / float(p)))


def step_at(config: dict, topic: str, scene: str, p: float) -> float:
    """Choose the time step of a scene of the sweep at one p, which is longer in long runs."""
    sweep = config["sweep"]
    long = p > sweep["measured"]
    return sweep["scenes"][scene]["long_step"] if long else config[topic]["step"]


def finite(numbers: list[float]) -> list[float]:
    """Leave out infinity: the paper's scheme needs a finite n."""
    return [number for number in numbers if isfinite(number)]
