"""Checks of the configuration: what cannot run is refused in one line before anything runs."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import yaml

from nonsmooth.errors import AssumptionWarning, NonsmoothError
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.noises import NOISES, Hamiltonian, Langevin
from nonsmooth.scenes.scene import Scene
from reproduction.configuration.layers import Layers
from reproduction.configuration.schema import dotted, shown, validate
from reproduction.errors import ConfigError
from reproduction.plasticity import yielding_oscillator
from workflow.costs import check_costs
from workflow.experiment import ergodic_scenes, finite, scene_of
from workflow.outputs import check_outputs

SCHEMA = Path(__file__).parent / "schemas" / "config.schema.yaml"


def check(layers: Layers) -> None:
    """Refuse a configuration that cannot be run, before anything runs.

    Parameters
    ----------
    layers : Layers

    Raises
    ------
    ConfigError
        With one line that names the file, the key, its value and the cure.
    """
    config = layers.merged
    with warnings.catch_warnings():
        # the jobs give them
        warnings.simplefilter("ignore", AssumptionWarning)
        try:
            validate(config, _schema())
            check_outputs(config["outputs"])
            _check_scenes(config)
            _check_names(config)
            _check_increasing(config)
            _check_dry_friction(config)
            _check_times(config)
            if not finite(config["convergence"]["n"]):
                raise _refused(config, ("convergence", "n"), "needs a finite n; add one")
            _check_finite_p(config["finite_p"], config["crossing"])
            _check_speed(config["speed_against_error"])
            check_costs(config)
        except ConfigError as error:
            raise layers.named(error) from None


@cache
def _schema():
    return yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))


def _refused(config, key, problem):
    value = config
    for part in key:
        value = value[part]
    return ConfigError(f"{dotted(key)} = {shown(value)} {problem}", key=key)


@contextmanager
def _blamed(*key):
    """Say which key an error is about."""
    try:
        yield
    except NonsmoothError as error:
        raise ConfigError(f"{dotted(key)}: {error}", key=key) from None


def _scene(key, parameters):
    """Make a scene of a table of parameters, formula by formula, so that errors name theirs."""
    model, noise = parameters["model"], parameters["noise"]
    with _blamed(*key, "noise"):
        if isinstance(noise, dict):
            noise = (Hamiltonian if "H" in noise else Langevin)(**noise)
        else:
            noise = NOISES[noise]
    with _blamed(*key, "potential"):
        Scene(model, noise, potential=parameters["potential"]).potential_expression  # noqa: B018
    with _blamed(*key, "observable"):
        return scene_of(parameters)


def _scenes(config) -> Iterator[tuple[tuple, dict]]:
    """Yield the parameters of every scene with its keys."""
    for topic in ("variance", "crossing", "convergence"):
        yield (topic, "scene"), config[topic]["scene"]
    for name, entry in config["sweep"]["scenes"].items():
        yield ("sweep", "scenes", name, "scene"), entry["scene"]
    for k, parameters in enumerate(config["gamma2"]["potentials"]["scenes"]):
        yield ("gamma2", "potentials", "scenes", k), parameters
    for name, entry in config["rates"]["scenes"].items():
        yield ("rates", "scenes", name, "scene"), entry["scene"]


def _check_scenes(config):
    """Read every formula by making every scene; where there are many n and C_b, any will do."""
    for key, parameters in _scenes(config):
        _scene(key, parameters)
    for model, own in config["trajectories"]["models"].items():
        with _blamed("trajectories", "models", model, "potential"):
            Scene(model, potential=own["potential"], damping=own["damping"])
    with _blamed("plasticity", "oscillator", "potential"):
        yielding_oscillator(config["plasticity"]["ground"], config["plasticity"]["oscillator"])
    theorems = config["theorems"]
    for k, v in enumerate(theorems["langevin"]):
        with _blamed("theorems", "langevin", k):
            Langevin(v)
    for model, potentials in theorems["potentials"].items():
        for k, potential in enumerate(potentials):
            with _blamed("theorems", "potentials", model, k):
                Scene(model, potential=potential)
    for model, potential in config["speed_against_error"]["pathwise"]["models"].items():
        with _blamed("speed_against_error", "pathwise", "models", model):
            Scene(model, potential=potential)


def _check_names(config):
    """Refuse a scene that is not one of the sweep, or not of the kind that its topic needs."""
    known, simulated = list(config["sweep"]["scenes"]), config["sweep"]["simulated"]
    _check_known(config, ("sweep", "simulated"), known)
    # table 5 and figure 8 compare with the simulations
    for topic in ("gamma2", "limit_theorem"):
        _check_known(config, (topic, "scenes"), simulated, "simulated ")
    for key in (
        ("density", "scenes"),
        ("theorems", "ergodicity", "scenes"),
        ("speed_against_error", "cost", "names"),
    ):
        _check_known(config, key, known)
    for name, parameters in ergodic_scenes(config).items():
        if scene_of(parameters).dimension > 2:
            raise _refused(
                config, ("theorems", "ergodicity", "scenes"), f"has {name!r}, which has more than "
                "two state variables; choose scenes with one or two"
            )  # fmt: skip


def _check_known(config, key, choice, kind=""):
    names = config
    for part in key:
        names = names[part]
    for name in names:
        if name not in choice:
            raise ConfigError(
                f"{dotted(key)} has {shown(name)}, which is not a {kind}scene of the sweep; "
                f"choose from {', '.join(choice)}",
                key=key,
            )


def _check_increasing(config):
    """Refuse lists of times, of n and of p that do not increase."""
    keys = [
        ("sweep", "variance", "times"),
        ("gamma2", "potentials", "times"),
        ("speed_against_error", "gamma2", "times"),
        ("limit_theorem", "p"),
        ("finite_p", "p"),
        ("finite_p", "horizons"),
        *(("rates", "scenes", name, "n") for name in config["rates"]["scenes"]),
    ]
    for key in keys:
        numbers = config
        for part in key:
            numbers = numbers[part]
        if sorted(numbers) != numbers:
            raise _refused(config, key, "must increase; sort them")


def _check_dry_friction(config):
    """Refuse other scenes for figures 2a, 2b and table 4, whose solvers take the velocity alone."""
    for topic in ("variance", "crossing", "convergence"):
        parameters = config[topic]["scene"]
        scene = scene_of(parameters)
        key = (topic, "scene", "model" if parameters["model"] != "friction" else "potential")
        key = (topic, "scene", "noise") if scene.noise.kind != "white" else key
        if scene.state != ("y",) or scene.noise.kind != "white":
            raise _refused(
                config, key, f"has the state ({', '.join(scene.state)}) with {scene.noise.title}, "
                "but the reference solver takes (y) with white noise only; choose friction with "
                "potential '0' and g of y"
            )  # fmt: skip
    for key, scheme in (
        (("variance",), config["variance"]["finite_difference"]),
        (("convergence",), config["convergence"]["finite_difference"]),
    ):
        topic = config[key[0]]
        many = finite(topic["n"]) if "n" in topic else [topic["scene"]["n"]]
        _check_grid(config, (*key, "finite_difference"), topic["scene"], many, scheme)


def _check_grid(config, key, parameters, many, scheme):
    nodes = scheme["nodes"]
    if nodes % 8 != 1:
        raise _refused(
            config, (*key, "nodes"), "must be a multiple of 8 and one more, so that the mesh and "
            f"the domain can be halved; use {nodes // 8 * 8 + 1}"
        )  # fmt: skip
    # the error takes a mesh twice as wide
    width = 4 * scheme["half_width"] / (nodes - 1)
    for n in many:
        scene = scene_of(parameters | {"n": n})
        drift = vectorised(scene.numerical_drift()[symbols.y], (symbols.y,))
        if abs(drift(scheme["half_width"])) * width > scene.noise.sigma**2:
            raise _refused(
                config, (*key, "nodes"), f"are too few for half_width = {scheme['half_width']}: "
                "the paper's scheme oscillates; use more nodes"
            )  # fmt: skip


def _check_times(config):
    """Refuse times at which the paper's scheme takes no step.

    Those of figure 2a are multiples of first_time/10, and the error takes twice the step.
    """
    variance, convergence = config["variance"], config["convergence"]
    unit, horizon = variance["first_time"] / 10, variance["horizon"]
    if horizon <= variance["first_time"] or not _divides(unit, horizon):
        raise _refused(
            config, ("variance", "horizon"), "must be a larger multiple of variance.first_time/10 "
            f"= {unit:g}; change either"
        )  # fmt: skip
    for topic, whole, name in (
        ("variance", unit, f"variance.first_time/10 = {unit:g}"),
        ("convergence", convergence["horizon"], f"convergence.horizon = {convergence['horizon']}"),
    ):
        key = (topic, "finite_difference", "time_step")
        if not _divides(2 * config[topic]["finite_difference"]["time_step"], whole):
            raise _refused(config, key, f"must be a half of a divisor of {name}; change either")


def _divides(part, whole):
    return whole >= part and abs(whole / part - round(whole / part)) < 1e-9 * whole / part


def _check_finite_p(finite_p, crossing):
    """Refuse a T of table 9 at which the formulas or Monte Carlo have no value."""
    config, horizon = {"finite_p": finite_p}, finite_p["tabulated"]
    interval = crossing["horizon"] / crossing["outputs"]
    if (
        horizon not in finite_p["horizons"]
        or not _divides(interval, horizon)
        or horizon > crossing["horizon"]
    ):
        raise _refused(
            config, ("finite_p", "tabulated"), "must be one of finite_p.horizons, at most "
            f"crossing.horizon, and a multiple of crossing.horizon/crossing.outputs = "
            f"{interval:g}; change it"
        )  # fmt: skip
    if finite_p["first_time"] > 0.5 * crossing["horizon"]:
        raise _refused(
            config, ("finite_p", "first_time"), "leaves less than half of crossing.horizon = "
            f"{crossing['horizon']}; lower it"
        )  # fmt: skip


def _check_speed(speed):
    """Refuse lists that do not fit each other, and steps that are no divisors."""
    config = {"speed_against_error": speed}
    for topic, first, second in (
        (("pde", "fitted_grid"), "cells", "steps"),
        (("pde", "libraries"), "elements", "steps"),
        (("crossing",), "degrees", "contours"),
    ):
        own = speed
        for part in topic:
            own = own[part]
        if len(own[first]) != len(own[second]):
            raise _refused(
                config, ("speed_against_error", *topic, second), "must have an entry for each of "
                f"the {len(own[first])} {first}; add or delete some"
            )  # fmt: skip
    pde, cost, pathwise = speed["pde"], speed["cost"], speed["pathwise"]
    key = ("speed_against_error", "pde", "paper_scheme")
    for nodes in pde["paper_scheme"]["nodes"]:
        if nodes % 2 == 0:
            raise _refused(config, (*key, "nodes"), f"has {nodes}; nodes must be odd, add one")
    for step in pde["paper_scheme"]["time_steps"]:
        if not _divides(step, pde["horizon"]):
            raise _refused(
                config, (*key, "time_steps"), f"has {step}, which does not divide pde.horizon = "
                f"{pde['horizon']}; change it"
            )  # fmt: skip
    for horizon in cost["horizons"]:
        if not _divides(cost["paper_scheme"]["time_step"], horizon):
            raise _refused(
                config, ("speed_against_error", "cost", "horizons"), f"has {horizon}, no multiple "
                f"of cost.paper_scheme.time_step = {cost['paper_scheme']['time_step']}; change it"
            )  # fmt: skip
    if max(pathwise["doublings"]) >= pathwise["reference"]:
        raise _refused(
            config, ("speed_against_error", "pathwise", "doublings"), "must be below "
            f"pathwise.reference = {pathwise['reference']}; leave out the larger ones"
        )  # fmt: skip
