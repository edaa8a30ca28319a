"""Checks of the configuration, and what the rules derive from it."""

import os
import warnings
from math import ceil, isfinite, isnan
from pathlib import Path

import yaml

from nonsmooth.errors import AssumptionWarning, SceneError
from nonsmooth.scenes.noises import Langevin
from nonsmooth.scenes.scene import Scene, by_formulas
from reproduction.errors import ConfigError
from reproduction.jobs.configuration import validate
from reproduction.plasticity import yielding_oscillator

SCHEMA = Path(__file__).parent / "schemas" / "config.schema.yaml"


def check(config: dict) -> None:
    """Refuse a configuration that cannot be run, before anything runs.

    Raises
    ------
    NonsmoothError
        With one line on an unknown or out-of-range key, an impossible scene, or a folder that
        cannot be written.
    """
    validate(config, yaml.safe_load(SCHEMA.read_text(encoding="utf-8")))
    for key, number in _numbers(config):
        if isnan(number):
            raise ConfigError(f"config: {key!r} is not a number; give it one")
    _check_dry_friction(config)
    _check_times(config["variance"])
    _check_some_finite("convergence.n", config["convergence"]["n"])
    _check_increasing(config)
    _check_formulas(config)
    _check_names(config)
    _check_finite_p(config["finite_p"], config["crossing"])
    _check_folders(config["outputs"])


def _numbers(value, path=""):
    """Yield every number of the configuration with its dotted key."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, inner in items:
            yield from _numbers(inner, f"{path}.{key}" if path else str(key))
    elif isinstance(value, int | float):
        yield path, value


def _check_dry_friction(config):
    """Refuse other scenes for figures 2a, 2b and table 4, whose solvers take the velocity alone."""
    for topic in ("variance", "crossing", "convergence"):
        scene = Scene(**config[topic]["scene"])
        if scene.state != ("y",) or scene.noise.kind != "white":
            raise SceneError(
                f"config: {topic}.scene has the state ({', '.join(scene.state)}) with "
                f"{scene.noise.title}, but its reference solver takes (y) with white noise only; "
                "choose friction with potential '0' and g of y"
            )
        nodes = config[topic].get("finite_difference", {}).get("nodes", 1)
        if nodes % 8 != 1:
            raise ConfigError(
                f"config: '{topic}.finite_difference.nodes' = {nodes}: (N - 1)/8 must be an "
                f"integer, so that the mesh and the domain can be halved; use {nodes // 8 * 8 + 1}"
            )


def _check_times(variance):
    """Refuse times of figure 2a that are no steps of the paper's scheme.

    They are multiples of first_time/10, so twice the step must divide that.
    """
    unit, horizon = variance["first_time"] / 10, variance["horizon"]
    if horizon <= variance["first_time"] or not _divides(unit, horizon):
        raise ConfigError(
            f"config: 'variance.horizon' = {horizon} must be a larger multiple of "
            f"variance.first_time/10 = {unit:g}; change either"
        )
    step = variance["finite_difference"]["time_step"]
    if not _divides(2 * step, unit):
        raise ConfigError(
            f"config: 'variance.finite_difference.time_step' = {step}: twice it must divide "
            f"variance.first_time/10 = {unit:g}; change either"
        )


def _check_some_finite(key, numbers):
    """Refuse n = inf alone, for which the paper's scheme is not made."""
    if not finite(numbers):
        raise ConfigError(f"config: '{key}' = {numbers} needs a finite n; add one")


def _divides(part, whole):
    return abs(whole / part - round(whole / part)) < 1e-9 * whole / part


def _check_increasing(config):
    """Refuse lists of times and of p that do not increase."""
    lists = {
        "sweep.variance.times": config["sweep"]["variance"]["times"],
        "gamma2.potentials.times": config["gamma2"]["potentials"]["times"],
        "limit_theorem.p": config["limit_theorem"]["p"],
        "finite_p.p": config["finite_p"]["p"],
        "finite_p.horizons": config["finite_p"]["horizons"],
    }
    for key, numbers in lists.items():
        if sorted(set(numbers)) != numbers:
            raise ConfigError(f"config: '{key}' = {numbers} must increase; sort them")


def _check_formulas(config):
    """Read every formula by making every scene; the n and C_b of the theorems do not matter."""
    for parameters in config["sweep"]["scenes"].values():
        Scene(**parameters["scene"])
    for parameters in config["gamma2"]["potentials"]["scenes"]:
        by_formulas(parameters)
    for model, parameters in config["trajectories"]["models"].items():
        Scene(model, potential=parameters["potential"], damping=parameters["damping"])
    yielding_oscillator(config["plasticity"]["ground"], config["plasticity"]["oscillator"])
    for v in config["theorems"]["langevin"]:
        Langevin(v)
    with warnings.catch_warnings():
        # with U = 0 the theorems cover the velocity alone, which is intended
        warnings.simplefilter("ignore", AssumptionWarning)
        for model, potentials in config["theorems"]["potentials"].items():
            for U in potentials:
                Scene(model, potential=U)


def _check_names(config):
    """Refuse a scene that is not one of the sweep, or not of the kind that its topic needs."""
    known, simulated = list(config["sweep"]["scenes"]), config["sweep"]["simulated"]
    _check_scenes("sweep.simulated", simulated, known)
    # table 5 and figure 8 compare with the simulations
    for topic in ("gamma2", "limit_theorem"):
        _check_scenes(f"{topic}.scenes", config[topic]["scenes"], simulated, "simulated ")
    for key, topic in (
        ("density", config["density"]),
        ("theorems.ergodicity", config["theorems"]["ergodicity"]),
    ):
        _check_scenes(f"{key}.scenes", topic["scenes"], known)
    for name, parameters in ergodic_scenes(config).items():
        if Scene(**parameters).dimension > 2:
            raise SceneError(
                f"config: 'theorems.ergodicity.scenes' has {name!r}, which has more than two state "
                "variables; choose scenes with one or two"
            )


def _check_scenes(key, names, choice, kind=""):
    for name in names:
        if name not in choice:
            raise ConfigError(
                f"config: '{key}' has {name!r}, which is not a {kind}scene of the sweep; "
                f"choose from {', '.join(choice)}"
            )


def _check_finite_p(finite_p, crossing):
    """Refuse a T of table 9 at which the formulas or Monte Carlo have no value."""
    horizon, interval = finite_p["tabulated"], crossing["horizon"] / crossing["outputs"]
    if horizon not in finite_p["horizons"] or not _divides(interval, horizon):
        raise ConfigError(
            f"config: 'finite_p.tabulated' = {horizon} must be one of finite_p.horizons and a "
            f"multiple of crossing.horizon/crossing.outputs = {interval:g}; change it"
        )
    if finite_p["first_time"] > 0.5 * crossing["horizon"]:
        raise ConfigError(
            f"config: 'finite_p.first_time' = {finite_p['first_time']} leaves less than half of "
            f"crossing.horizon = {crossing['horizon']}; lower it"
        )


def _check_folders(outputs):
    """Refuse folders that cannot be written."""
    for key, path in outputs.items():
        folder = Path(path) if key == "results" else Path(path).parent
        while not folder.exists():
            folder = folder.parent
        if not (folder.is_dir() and os.access(folder, os.W_OK)):
            raise ConfigError(
                f"config: outputs.{key} = {path!r}: cannot write into {str(folder)!r}; "
                "make it writable or choose another folder"
            )


def label(number: float) -> str:
    """Spell a number of the configuration as it stands in file names."""
    return f"{float(number):.17g}"


def swept(config: dict) -> dict[str, dict]:
    """Return the scenes that the sweep simulates, by their names."""
    return {name: config["sweep"]["scenes"][name] for name in config["sweep"]["simulated"]}


def ergodic_scenes(config: dict) -> dict[str, dict]:
    """Return the parameters of the scenes of table 7b by their names, in the table's order."""
    scenes = config["sweep"]["scenes"]
    return {name: scenes[name]["scene"] for name in config["theorems"]["ergodicity"]["scenes"]}


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


def sweep_halving(topic: dict, p: str) -> int:
    """Choose the paths on which the step is halved in the sweep.

    There are fewer in longer runs, where the effect of halving the step scatters less.
    """
    return max(1_000, round(topic["halving_paths"] / max(1.0, float(p) / 100)))


def finite(numbers: list[float]) -> list[float]:
    """Leave out infinity: the paper's scheme needs a finite n."""
    return [number for number in numbers if isfinite(number)]
