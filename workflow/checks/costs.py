"""What a run takes, estimated from the sizes in the configuration before anything runs.

The rates were measured on one core of a Zen 5 by the benchmark files of a run at the paper's sizes,
which the estimates meet within a factor of three. They are there to refuse what would never end.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from math import ceil, isfinite

import psutil

from reproduction.configuration.schema import shown
from reproduction.errors import ConfigError, dotted
from reproduction.plasticity import yielding_oscillator
from reproduction.time_scales import contact_time
from workflow.checks.scenes import scene_of

GB = 1e9
# imports, compiled kernels and their arrays: benchmarks/tables and benchmarks/crossing
JOB_SECONDS, JOB_BYTES = 2.5, 0.3 * GB
# of a step of a path, by the number of variables: benchmarks/README.md, "Measured"
STEP_SECONDS = {1: 0.7e-9, 2: 2.3e-9, 3: 2.3e-9, 4: 2.6e-9}
# the same in double precision, of a pair of paths: benchmarks/rates
PAIR_SECONDS = 40e-9
# of a node and a step of the paper's scheme with its error: benchmarks/convergence
NODE_SECONDS, NODE_BYTES, MARCH_BYTES = 8e-8, 200, 250
# of the Poisson equation at a tolerance, by the number of variables: benchmarks/gamma2; with a
# thousandth of the tolerance the time grew some 30 times
POISSON = {1: (1e-10, 0.5), 2: (1e-6, 3.0), 3: (2e-4, 10.0), 4: (3e-3, 40.0)}
# of a point of the drift condition: benchmarks/theorems
POINT_SECONDS, POINT_BYTES = 1.5e-6, 400
# paths and step of importance sampling, the fits and the halved step included
RARE_PATHS, RARE_STEP = 40_000, 0.05
# of a solved crossing probability, by the number of variables: benchmarks/rates
CROSSING_SECONDS, CROSSING_BYTES = {1: 1.0, 2: 8.0}, 0.4 * GB
# paths of a block, whose sums are kept for every time and statistic
BLOCK, SUMS = 1000, 25 * 8


@dataclass(frozen=True)
class Cost:
    """What jobs of one kind take.

    Parameters
    ----------
    sizes : dict of tuple to float
        How large each key of the configuration makes them: its value, or for a step 1/value.
    seconds : float
        On one core, all of these jobs together.
    memory : float
        Bytes of one of them.
    """

    sizes: dict
    seconds: float
    memory: float = JOB_BYTES


def check_costs(config: dict) -> None:
    """Refuse sizes that take more than the limits, or more memory than this machine has.

    Parameters
    ----------
    config : dict
        Valid, all its scenes possible.

    Raises
    ------
    ConfigError
        With the key to blame, the estimate, the limit, and how to raise it.
    """
    found, limits = list(costs(config)), config["limits"]
    largest = max(found, key=lambda cost: cost.memory)
    if largest.memory > limits["memory"] * GB:
        _refuse(config, largest, f"{largest.memory / GB:.2g} GB of memory", "memory")
    machine = psutil.virtual_memory().total
    if largest.memory > machine:
        raise ConfigError(
            f"{_blamed(config, largest)}: a job would take about {largest.memory / GB:.2g} GB, but "
            f"this machine has {machine / GB:.2g} GB of memory; reduce it",
            key=_largest(largest),
        )
    hours = sum(cost.seconds for cost in found) / 3600
    if hours > limits["hours"]:
        longest = max(found, key=lambda cost: cost.seconds)
        _refuse(config, longest, f"{hours:.2g} hours on one core", "hours")


def _refuse(config, cost, amount, limit):
    raise ConfigError(
        f"{_blamed(config, cost)}: the run would take about {amount}, above "
        f"'limits.{limit}' = {config['limits'][limit]}; reduce it or raise the limit",
        key=_largest(cost),
        others=[("limits", limit)],
    )


def _largest(cost):
    return max(cost.sizes, key=cost.sizes.get)


def _blamed(config, cost):
    """Spell the sizes, the largest one first."""
    parts = []
    for key in sorted(cost.sizes, key=cost.sizes.get, reverse=True):
        value = config
        for part in key:
            value = value[part]
        parts.append(f"{dotted(key)} = {shown(value)}")
    return parts[0] + (f" (with {', '.join(parts[1:4])})" if parts[1:] else "")


def costs(config: dict) -> Iterator[Cost]:
    """Estimate what the jobs of every rule take that computes.

    Parameters
    ----------
    config : dict

    Yields
    ------
    Cost
    """
    yield from _trajectories(config["trajectories"])
    yield from _variance(config["variance"])
    yield from _crossing(config["crossing"], config["finite_p"])
    yield from _convergence(config["convergence"])
    yield from _gamma2(config["gamma2"], config["sweep"]["scenes"])
    yield from _sweep(config["sweep"])
    yield from _rare(config["rare_crossings"], config["sweep"]["scenes"])
    yield from _theorems(config["theorems"])
    yield from _densities(config["density"], config["sweep"]["scenes"])
    yield from _limit_theorem(config["limit_theorem"], config["sweep"])
    yield from _plasticity(config["plasticity"])
    yield from _rates(config["rates"])
    rounds = {("speed_against_error", "rounds"): config["speed_against_error"]["rounds"]}
    for cost in _speed(config["speed_against_error"]):
        yield replace(cost, sizes=cost.sizes | rounds)
    paths = config["hard_cases"]["paths"]
    yield Cost({("hard_cases", "paths"): paths}, 60 * paths / 20_000, JOB_BYTES + 32 * paths)


def _sizes(section, values, **keys):
    """Collect sizes; of a list the largest counts, of a step its inverse."""
    found = {}
    for name, path in keys.items():
        value = values
        for part in path:
            value = value[part]
        value = max(value) if isinstance(value, list) else value
        found[(*section, *path)] = 1 / value if name == "step" else value
    return found


def _simulated(dimension, paths, time, step):
    """Seconds of paths in blocks, which are all computed whole."""
    return STEP_SECONDS[dimension] * ceil(paths / BLOCK) * BLOCK * (time / step + 1)


def _sampled(paths, outputs):
    """Bytes of sums over blocks of paths, at every output."""
    return JOB_BYTES + ceil(paths / BLOCK) * outputs * SUMS


def _trajectories(topic):
    steps = topic["horizon"] / topic["step"]
    sizes = _sizes(
        ("trajectories",), topic, step=["step"], horizon=["horizon"], outputs=["outputs"]
    )
    seconds = 3 * (JOB_SECONDS + len(topic["n"]) * STEP_SECONDS[2] * BLOCK * steps)
    seconds += 1e-6 * topic["outputs"] * len(topic["n"])
    yield Cost(sizes, seconds, JOB_BYTES + 100 * topic["outputs"] * len(topic["n"]))


def _marched(section, topic, horizon, many=1):
    """Cost of the paper's scheme."""
    scheme = topic["finite_difference"]
    sizes = _sizes(
        section,
        topic,
        nodes=["finite_difference", "nodes"],
        step=["finite_difference", "time_step"],
        horizon=["horizon"],
    )
    steps = horizon / scheme["time_step"]
    seconds = many * (JOB_SECONDS + NODE_SECONDS * scheme["nodes"] * steps)
    return Cost(sizes, seconds, JOB_BYTES + NODE_BYTES * scheme["nodes"] + MARCH_BYTES * steps)


def _shards(paths, shard):
    return ceil(paths / shard)


def _variance(topic):
    yield _marched(("variance",), topic, topic["horizon"])
    run = topic["monte_carlo"]
    sizes = _sizes(
        ("variance",),
        topic,
        paths=["monte_carlo", "paths"],
        step=["monte_carlo", "step"],
        horizon=["horizon"],
        times=["times"],
    )
    seconds = JOB_SECONDS * (_shards(run["paths"], run["shard"]) + 2)
    seconds += _simulated(1, run["paths"] + 3 * run["halving_paths"], topic["horizon"], run["step"])
    seconds += 1e-4 * topic["times"]
    yield Cost(sizes, seconds, _sampled(min(run["paths"], run["shard"]), topic["times"]))


def _crossing(topic, finite_p):
    sizes = _sizes(
        ("crossing",),
        topic,
        paths=["paths"],
        step=["step"],
        p=["p"],
        horizon=["horizon"],
        outputs=["outputs"],
    )
    halving, top = topic["halving"], max(topic["p"])
    seconds = 0.0
    for p in topic["p"]:
        fewer = min(topic["paths"], halving["paths"] * top / p)
        seconds += JOB_SECONDS * (_shards(topic["paths"], topic["shard"]) + 2)
        seconds += _simulated(1, topic["paths"] + 3 * fewer, p * topic["horizon"], topic["step"])
    yield Cost(sizes, seconds, _sampled(min(topic["paths"], topic["shard"]), topic["outputs"]))
    sizes = _sizes(
        ("crossing",),
        topic,
        paths=["halving", "gamma2_paths"],
        time=["halving", "gamma2_time"],
        step=["step"],
    )
    time = halving["gamma2_time"]
    seconds = JOB_SECONDS + _simulated(1, 3 * halving["gamma2_paths"], time, topic["step"])
    yield Cost(sizes, seconds)
    exact = len(topic["p"]) * (JOB_SECONDS + 5e-3 * topic["outputs"])
    values = {("crossing", "outputs"): topic["outputs"]}
    yield Cost(values, exact, JOB_BYTES + 8_000 * topic["outputs"])
    formulas = len(finite_p["p"]) * len(finite_p["horizons"])
    sizes = {("finite_p", "p"): len(finite_p["p"]), ("finite_p", "horizons"): formulas}
    yield Cost(sizes, JOB_SECONDS + 0.4 * formulas)


def _convergence(topic):
    many = sum(map(isfinite, topic["n"]))
    yield _marched(("convergence",), topic, topic["horizon"], many)


def _poisson(dimension, tolerance):
    usual, seconds = POISSON[dimension]
    return seconds * max(1.0, usual / tolerance) ** 0.5


def _solver_bytes(seconds):
    """Bytes of a solver; the largest grids of a minute take half a gigabyte."""
    return JOB_BYTES + 0.3 * GB * max(1.0, seconds / 40)


def _solved(section, scenes, tolerance):
    """Cost of the Poisson equation; the scene that takes longest is to blame."""
    seconds = {
        (*section, scene.dimension - 1): _poisson(scene.dimension, tolerance[scene.dimension - 1])
        for scene in scenes
    }
    total = sum(
        JOB_SECONDS + _poisson(scene.dimension, tolerance[scene.dimension - 1]) for scene in scenes
    )
    return Cost(seconds, total, _solver_bytes(max(seconds.values())))


def _gamma2(topic, known):
    scenes = [scene_of(known[name]["scene"]) for name in topic["scenes"]]
    yield _solved(("gamma2", "tolerance"), scenes, topic["tolerance"])
    own = topic["potentials"]
    scenes = [scene_of(parameters) for parameters in own["scenes"]]
    yield _solved(("gamma2", "potentials", "tolerance"), scenes, own["tolerance"])
    sizes = _sizes(
        ("gamma2", "potentials"),
        own,
        paths=["paths"],
        halving=["halving_paths"],
        step=["step"],
        times=["times"],
    )
    paths = own["paths"] + 4 * own["halving_paths"]
    seconds = sum(
        _simulated(scene.dimension, paths, own["times"][-1], own["step"]) for scene in scenes
    )
    yield Cost(sizes, seconds, JOB_BYTES + 64 * max(own["paths"], own["halving_paths"]))


def _sweep(topic):
    own = topic["variance"]
    scenes = [scene_of(topic["scenes"][name]["scene"]) for name in topic["simulated"]]
    steps = {name: topic["scenes"][name]["long_step"] for name in topic["simulated"]}
    shortest = min(steps, key=steps.get)
    sizes = _sizes(
        ("sweep",),
        topic,
        paths=["paths"],
        halving=["halving_paths"],
        step=["step"],
        p=["p"],
        horizon=["horizon"],
        outputs=["outputs"],
    )
    seconds = 0.0
    sizes["sweep", "scenes", shortest, "long_step"] = 1 / steps[shortest]
    for (name, scene), p in product(zip(steps, scenes, strict=True), topic["p"]):
        step = topic["step"] if p <= topic["measured"] else steps[name]
        halved = min(p, topic["measured"]) * topic["horizon"]
        seconds += JOB_SECONDS + 1e-4 * topic["outputs"]
        seconds += _simulated(scene.dimension, topic["paths"], p * topic["horizon"], step)
        seconds += _simulated(scene.dimension, 3 * topic["halving_paths"], halved, step)
    yield Cost(sizes, seconds, _sampled(topic["paths"], topic["outputs"]))
    sizes = _sizes(
        ("sweep",),
        topic,
        paths=["variance", "paths"],
        halving=["variance", "halving_paths"],
        times=["variance", "times"],
        step=["scenes", shortest, "long_step"],
    )
    paths = own["paths"] + 3 * own["halving_paths"]
    seconds = sum(
        JOB_SECONDS + _simulated(scene.dimension, paths, own["times"][-1], step)
        for scene, step in zip(scenes, steps.values(), strict=True)
    )
    yield Cost(sizes, seconds, JOB_BYTES + 64 * max(own["paths"], own["halving_paths"]))


def _rare(topic, known):
    thresholds = {name: len(topic["thresholds"][name]) for name in topic["scenes"]}
    most = max(thresholds, key=thresholds.get)
    sizes = _sizes(("rare_crossings",), topic, p=["p"], horizon=["horizon"])
    sizes["rare_crossings", "thresholds", most] = thresholds[most]
    seconds = JOB_SECONDS
    for name, count in thresholds.items():
        dimension = scene_of(known[name]["scene"]).dimension
        time = topic["p"] * topic["horizon"]
        each = 0.5 + _simulated(dimension, RARE_PATHS, time, RARE_STEP)
        seconds += JOB_SECONDS + count * each
    yield Cost(sizes, seconds)


def _theorems(topic):
    forcings = 2 + len(topic["langevin"])
    cases = sum(map(len, topic["potentials"].values())) * forcings
    cases *= len(topic["damping"]) * len(topic["n"])
    sizes = {
        ("theorems", "points"): topic["points"],
        ("theorems", "damping"): len(topic["damping"]),
        ("theorems", "n"): len(topic["n"]),
    }
    seconds = JOB_SECONDS + POINT_SECONDS * cases * topic["points"]
    yield Cost(sizes, seconds, JOB_BYTES + POINT_BYTES * topic["points"])
    step = topic["ergodicity"]["step"]
    seconds = len(topic["ergodicity"]["scenes"]) * 0.2 / step
    yield Cost({("theorems", "ergodicity", "step"): 1 / step}, JOB_SECONDS + seconds)


def _densities(topic, known):
    scenes = [scene_of(known[name]["scene"]) for name in topic["scenes"]]
    sizes = _sizes(("density",), topic, paths=["paths"], time=["time"], step=["step"])
    seconds = sum(
        JOB_SECONDS + _simulated(scene.dimension, topic["paths"], topic["time"], topic["step"])
        for scene in scenes
    )
    yield Cost(sizes, seconds, JOB_BYTES + 100 * topic["paths"])
    yield _solved(("density", "tolerances"), scenes, topic["tolerances"])


def _limit_theorem(topic, sweep):
    sizes = _sizes(("limit_theorem",), topic, paths=["paths"], p=["p"], step=["step"])
    short = max((p for p in topic["p"] if p <= sweep["measured"]), default=0.0)
    seconds = 0.0
    for name in topic["scenes"]:
        entry = sweep["scenes"][name]
        sizes["sweep", "scenes", name, "long_step"] = 1 / entry["long_step"]
        dimension = scene_of(entry["scene"]).dimension
        seconds += JOB_SECONDS + _simulated(dimension, topic["paths"], short, topic["step"])
        rest = max(topic["p"]) - short
        seconds += _simulated(dimension, topic["paths"], rest, entry["long_step"])
    yield Cost(sizes, seconds, JOB_BYTES + 64 * topic["paths"] * len(topic["p"]))


def _plasticity(topic):
    dimension = yielding_oscillator(topic["ground"], topic["oscillator"]).dimension
    sizes = _sizes(
        ("plasticity",),
        topic,
        paths=["paths"],
        duration=["duration"],
        step=["step"],
        outputs=["outputs"],
    )
    each = _simulated(dimension, 2 * topic["paths"], topic["duration"], topic["step"])
    seconds = len(topic["limits"]) * (JOB_SECONDS + each)
    yield Cost(sizes, seconds, _sampled(topic["paths"], topic["outputs"]))
    tolerance = topic["tolerance"]
    # by Monte Carlo
    sizes = {("plasticity", "tolerance"): 1 / tolerance}
    yield Cost(sizes, JOB_SECONDS + 9 * (0.02 / tolerance) ** 2)


def _rates(topic):
    weak, seconds, finest = topic["weak"], 0.0, topic["longest_step"]
    for entry in topic["scenes"].values():
        for n in entry["n"]:
            scene = scene_of(entry["scene"] | {"n": n})
            step = min(topic["longest_step"], topic["resolution"] * contact_time(scene))
            finest = min(finest, step)
            seconds += PAIR_SECONDS * 1.5 * topic["paths"] * (topic["horizon"] / step + 1)
            seconds += 3 * _simulated(scene.dimension, weak["paths"], weak["horizon"], weak["step"])
    sizes = _sizes(
        ("rates",),
        topic,
        paths=["paths"],
        horizon=["horizon"],
        many=["weak", "paths"],
        time=["weak", "horizon"],
    )
    sizes |= {
        ("rates", "weak", "step"): 1 / weak["step"],
        ("rates", "longest_step"): 1 / topic["longest_step"],
        ("rates", "resolution"): 1 / topic["resolution"],
    }
    yield Cost(sizes, JOB_SECONDS + seconds, JOB_BYTES + 64 * max(topic["paths"], weak["paths"]))
    points, seconds = topic["crossing"]["points"], 0.0
    for name in topic["crossing"]["scenes"]:
        dimension = scene_of(topic["scenes"][name]["scene"] | {"n": 1.0}).dimension
        seconds += JOB_SECONDS + points * CROSSING_SECONDS[dimension]
    yield Cost({("rates", "crossing", "points"): points}, seconds, JOB_BYTES + CROSSING_BYTES)


def _speed(topic):
    """Cost of the work-precision diagrams, with some ten methods beside each other."""
    own, section = topic["monte_carlo"], ("speed_against_error", "monte_carlo")
    sizes = _sizes(section, own, paths=["paths"], horizon=["horizon"])
    sizes[*section, "steps"] = 1 / min(own["steps"])
    steps = own["horizon"] * sum(1 / step for step in own["steps"])
    seconds = 10 * topic["rounds"] * sum(own["paths"]) * steps * STEP_SECONDS[1]
    peers = own["horizon"] * sum(1 / step for step in own["peer_steps"]) * sum(own["peer_paths"])
    yield Cost(sizes, seconds)
    sizes = {(*section, "peer_paths"): max(own["peer_paths"])}
    sizes[*section, "peer_steps"] = 1 / min(own["peer_steps"])
    yield Cost(sizes, 3e-7 * topic["rounds"] * peers)

    own, section = topic["crossing"], ("speed_against_error", "crossing")
    sizes = _sizes(section, own, paths=["paths"], p=["p"], horizon=["horizon"])
    sizes[*section, "steps"] = 1 / min(own["steps"])
    steps = own["horizon"] * sum(own["p"]) * sum(1 / step for step in own["steps"])
    yield Cost(sizes, topic["rounds"] * sum(own["paths"]) * steps * STEP_SECONDS[1])
    sizes = _sizes(section, own, degrees=["degrees"], contours=["contours"])
    pairs = zip(own["degrees"], own["contours"], strict=True)
    seconds = topic["rounds"] * len(own["p"]) * sum(1e-5 * d**2 * c for d, c in pairs)
    yield Cost(sizes, seconds, JOB_BYTES + 8e4 * max(own["degrees"]) ** 2)

    own, section = topic["gamma2"], ("speed_against_error", "gamma2")
    sizes = _sizes(section, own, paths=["paths"], times=["times"], step=["step"])
    steps = own["times"][-1] / own["step"]
    seconds = 9 * own["rounds"] * sum(own["paths"]) * steps * STEP_SECONDS[4]
    yield Cost(sizes, seconds, JOB_BYTES + 64 * max(own["paths"]))
    degree = max(own["degrees"])
    values = {(*section, "degrees"): degree}
    yield Cost(values, own["rounds"] * 1e-5 * degree**3, JOB_BYTES + 8e4 * degree**2)
    solved = [
        ((*section, "tolerances", k), 3 * _poisson(k + 2, tolerance))
        for k, tolerances in enumerate(own["tolerances"])
        for tolerance in tolerances
    ]
    times = [one for _, one in solved]
    yield Cost(dict(solved), own["rounds"] * sum(times), _solver_bytes(max(times)))

    own, section = topic["pathwise"], ("speed_against_error", "pathwise")
    steps = 2 ** own["reference"]
    sizes = {(*section, "reference"): steps, (*section, "paths"): own["paths"]}
    seconds = topic["rounds"] * len(own["models"]) * len(own["n"]) * 2e-6 * steps * own["paths"]
    yield Cost(sizes, seconds, JOB_BYTES + 24 * steps * own["paths"])
    yield from _speed_pde(topic["pde"], topic["rounds"])
    yield from _speed_cost(topic["cost"], topic["rounds"])


def _speed_pde(own, rounds):
    section, scheme = ("speed_against_error", "pde"), own["paper_scheme"]
    many = rounds * len(own["n"])
    sizes = _sizes(section, own, nodes=["paper_scheme", "nodes"], horizon=["horizon"])
    sizes[*section, "paper_scheme", "time_steps"] = 1 / min(scheme["time_steps"])
    steps = own["horizon"] / min(scheme["time_steps"])
    seconds = many * NODE_SECONDS * sum(scheme["nodes"]) * 2 * steps
    memory = JOB_BYTES + NODE_BYTES * max(scheme["nodes"]) + MARCH_BYTES * steps
    yield Cost(sizes, seconds, memory)
    for name, unit in (("fitted_grid", "cells"), ("libraries", "elements")):
        grid = own[name]
        sizes = _sizes(section, own, cells=[name, unit], steps=[name, "steps"])
        nodes = max(grid["cells"] + grid[unit])
        seconds = many * NODE_SECONDS * 4 * sum(grid["steps"]) * nodes
        yield Cost(sizes, seconds, JOB_BYTES + 2 * NODE_BYTES * nodes)
    cells, degrees = own["libraries"]["cells"], own["spectral_elements"]["degrees"]
    yield Cost({(*section, "libraries", "cells"): max(cells)}, many * 1e-5 * max(cells) ** 3)
    memory = JOB_BYTES + 8e4 * max(degrees) ** 2
    values = {(*section, "spectral_elements", "degrees"): max(degrees)}
    yield Cost(values, many * 1e-5 * max(degrees) ** 3, memory)


def _speed_cost(own, rounds):
    section = ("speed_against_error", "cost")
    sizes = _sizes(section, own, paths=["paths"], horizon=["horizons"], least=["least"])
    sizes |= _sizes(section, own, p=["p"], step=["step"])
    steps = own["horizons"][0] * (sum(own["paths"]) + own["paths"][-1])
    steps += own["least"] * (sum(own["horizons"]) + 2 * sum(own["p"]))
    steps /= own["step"]
    # Euler's step is 1/n
    steps += own["least"] * own["horizons"][0] * sum(own["n"])
    sizes[*section, "n"] = max(own["n"])
    yield Cost(sizes, 2 * rounds * STEP_SECONDS[4] * steps)
    scheme = own["paper_scheme"]
    sizes = _sizes(section, own, nodes=["paper_scheme", "nodes"], horizon=["horizons"])
    sizes |= _sizes(section, own, step=["paper_scheme", "time_step"])
    marched = sum(own["horizons"]) / scheme["time_step"]
    memory = JOB_BYTES + NODE_BYTES * scheme["nodes"] + MARCH_BYTES * marched
    yield Cost(sizes, rounds * NODE_SECONDS * scheme["nodes"] * marched, memory)
    hardest = _poisson(4, own["tolerance"])
    values = {(*section, "tolerance"): 1 / own["tolerance"]}
    yield Cost(values, rounds * hardest, _solver_bytes(hardest))
