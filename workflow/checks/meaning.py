"""What a schema cannot say of the configuration: formulas, names, sizes that fit each other."""

import warnings
from collections.abc import Iterator
from itertools import product

from nonsmooth.errors import AssumptionWarning
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.noises import Hamiltonian, Langevin, named
from nonsmooth.scenes.scene import Scene
from reproduction.configuration.schema import shown
from reproduction.errors import ConfigError, configured_by, dotted
from reproduction.plasticity import yielding_oscillator
from workflow.checks.costs import check_costs
from workflow.checks.scenes import scene_of
from workflow.experiment import ergodic_scenes, finite, of_growing_n


def check_meaning(config: dict) -> None:
    """Refuse a configuration that fits its schema but cannot be run.

    Parameters
    ----------
    config : dict

    Raises
    ------
    ConfigError
    """
    with warnings.catch_warnings():
        # the jobs give them
        warnings.simplefilter("ignore", AssumptionWarning)
        _check_scenes(config)
        _check_names(config)
        _check_increasing(config)
        _check_speed(config)
        # before what compares sizes with each other, so that a huge one is to blame
        check_costs(config)
        _check_dry_friction(config)
        _check_steps(config)
        _check_times(config)
        if not finite(config["convergence"]["n"]):
            raise _refused(config, ("convergence", "n"), "needs a finite n; add one")
        _check_finite_p(config)


def _value(config, key):
    for part in key:
        config = config[part]
    return config


def _refused(config, key, problem, *others):
    value = shown(_value(config, key))
    return ConfigError(f"{dotted(key)} = {value} {problem}", key=key, others=others)


def _scene(key, parameters):
    """Make a scene of a table of parameters, formula by formula, so that errors name theirs."""
    model, noise = parameters["model"], parameters["noise"]
    with configured_by(*key, "noise"):
        if isinstance(noise, dict):
            noise = (Hamiltonian if "H" in noise else Langevin)(**noise)
        else:
            noise = named(noise)
    with configured_by(*key, "potential"):
        Scene(model, noise, potential=parameters["potential"]).potential_expression  # noqa: B018
    with configured_by(*key, "observable"):
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
        with configured_by("trajectories", "models", model, "potential"):
            Scene(model, potential=own["potential"], damping=own["damping"])
    with configured_by("plasticity", "oscillator", "potential"):
        yielding_oscillator(config["plasticity"]["ground"], config["plasticity"]["oscillator"])
    theorems = config["theorems"]
    for k, v in enumerate(theorems["langevin"]):
        with configured_by("theorems", "langevin", k):
            Langevin(v)
    for model, potentials in theorems["potentials"].items():
        for k, potential in enumerate(potentials):
            with configured_by("theorems", "potentials", model, k):
                Scene(model, potential=potential)
    for model, potential in config["speed_against_error"]["pathwise"]["models"].items():
        with configured_by("speed_against_error", "pathwise", "models", model):
            Scene(model, potential=potential)


def _check_names(config):
    """Refuse a scene that is not one of the sweep, or not of the kind that its topic needs."""
    known, simulated = list(config["sweep"]["scenes"]), config["sweep"]["simulated"]
    _check_known(config, ("sweep", "simulated"), known)
    # table 5 and figure 8 compare with the simulations, figure 13 with their limits
    for topic in ("gamma2", "limit_theorem", "rare_crossings"):
        _check_known(config, (topic, "scenes"), simulated, "simulated ")
    of_rates = list(config["rates"]["scenes"])
    _check_known(config, ("rates", "crossing", "scenes"), of_rates, of="rates")
    for topic, own, choice, of in (
        (("rare_crossings",), ["thresholds"], known, "the sweep"),
        (("rates", "crossing"), ["thresholds", "smallest", "tolerances"], of_rates, "rates"),
    ):
        section = _value(config, topic)
        for key in own:
            _check_known(config, (*topic, key), choice, of=of)
        for name, key in product(section["scenes"], own):
            if name not in section[key]:
                problem = f"has {name!r}, which has no {dotted((*topic, key))}; add it there"
                raise _refused(config, (*topic, "scenes"), problem)
    for key in (
        ("density", "scenes"),
        ("theorems", "ergodicity", "scenes"),
        ("speed_against_error", "cost", "names"),
    ):
        _check_known(config, key, known)
    for key, scenes in (
        (("theorems", "ergodicity", "scenes"), ergodic_scenes(config)),
        (("rates", "crossing", "scenes"), of_growing_n(config)),
    ):
        for name, parameters in scenes.items():
            if scene_of(parameters).dimension > 2:
                problem = f"has {name!r}, of more than two state variables; choose others"
                raise _refused(config, key, problem)


def _check_known(config, key, choice, kind="", of="the sweep"):
    for name in _value(config, key):
        if name not in choice:
            raise ConfigError(
                f"{dotted(key)} has {shown(name)}, which is not a {kind}scene of {of}; "
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
        *(("rare_crossings", "thresholds", name) for name in config["rare_crossings"]["scenes"]),
    ]
    for key in keys:
        numbers = _value(config, key)
        if sorted(numbers) != numbers:
            raise _refused(config, key, "must increase; sort them")


def _check_steps(config):
    """Refuse a time step above half of the time it divides: there would be no path to speak of."""
    sweep = ("sweep", "scenes")
    simulated = [(*sweep, name, "long_step") for name in config["sweep"]["scenes"]]
    pairs = [
        (("trajectories", "step"), ("trajectories", "horizon")),
        (("variance", "monte_carlo", "step"), ("variance", "horizon")),
        (("crossing", "step"), ("crossing", "horizon")),
        (("sweep", "step"), ("sweep", "horizon")),
        *((key, ("sweep", "variance", "times", 0)) for key in simulated),
        (("gamma2", "potentials", "step"), ("gamma2", "potentials", "times", 0)),
        (("density", "step"), ("density", "time")),
        (("limit_theorem", "step"), ("limit_theorem", "p", 0)),
        (("plasticity", "step"), ("plasticity", "duration")),
        (("rates", "longest_step"), ("rates", "horizon")),
        (("rates", "weak", "step"), ("rates", "weak", "horizon")),
        (("speed_against_error", "gamma2", "step"), ("speed_against_error", "gamma2", "times", 0)),
        (("speed_against_error", "rare", "step"), ("speed_against_error", "rare", "horizon")),
    ]
    for key, of in pairs:
        time = _value(config, of)
        if _value(config, key) > time / 2:
            problem = f"is above half of {dotted(of)} = {time:g}; lower it"
            raise _refused(config, key, problem, of)


def _check_dry_friction(config):
    """Refuse other scenes for figures 2a, 2b and table 4, whose solvers take the velocity alone."""
    for topic in ("variance", "crossing", "convergence"):
        parameters = config[topic]["scene"]
        scene = scene_of(parameters)
        key = (topic, "scene", "model" if parameters["model"] != "friction" else "potential")
        key = (topic, "scene", "noise") if scene.noise.kind != "white" else key
        if scene.state != ("y",) or scene.noise.kind != "white":
            problem = (
                f"has the state ({', '.join(scene.state)}) with {scene.noise.title}, but the "
                "reference solver takes (y) with white noise only; choose friction with potential "
                "'0' and g of y"
            )
            raise _refused(config, key, problem)
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
        problem = (
            "must be a multiple of 8 and one more, so that the mesh and the domain can be halved; "
            f"use {nodes // 8 * 8 + 1}"
        )
        raise _refused(config, (*key, "nodes"), problem)
    # the error takes a mesh twice as wide
    width = 4 * scheme["half_width"] / (nodes - 1)
    for n in many:
        scene = scene_of(parameters | {"n": n})
        drift = vectorised(scene.numerical_drift()[symbols.y], (symbols.y,))
        if abs(drift(scheme["half_width"])) * width > scene.noise.sigma**2:
            problem = f"are too few for half_width = {scheme['half_width']}; use more nodes"
            raise _refused(config, (*key, "nodes"), problem, (*key, "half_width"))


def _check_times(config):
    """Refuse times at which the paper's scheme takes no step.

    Those of figure 2a are multiples of first_time/10, and the error takes twice the step.
    """
    first, last = ("variance", "first_time"), ("variance", "horizon")
    unit, horizon = _value(config, first) / 10, _value(config, last)
    if horizon <= 10 * unit or not _divides(unit, horizon):
        problem = f"must be a larger multiple of variance.first_time/10 = {unit:g}; change either"
        raise _refused(config, last, problem, first)
    for whole, part, name in (
        (first, unit, "variance.first_time/10"),
        (("convergence", "horizon"), config["convergence"]["horizon"], "convergence.horizon"),
    ):
        key = (whole[0], "finite_difference", "time_step")
        if not _divides(2 * _value(config, key), part):
            problem = f"must be half of a divisor of {name} = {part:g}; change either"
            raise _refused(config, key, problem, whole)


def _divides(part, whole):
    return whole >= part and abs(whole / part - round(whole / part)) < 1e-9 * whole / part


def _check_finite_p(config):
    """Refuse a T of table 9 at which the formulas or Monte Carlo have no value."""
    crossing, finite_p = config["crossing"], config["finite_p"]
    last, outputs = ("crossing", "horizon"), ("crossing", "outputs")
    interval, horizon = crossing["horizon"] / crossing["outputs"], finite_p["tabulated"]
    if not _divides(interval, horizon) or horizon > crossing["horizon"]:
        problem = (
            f"must be at most crossing.horizon = {crossing['horizon']:g} and a multiple of "
            f"crossing.horizon/crossing.outputs = {interval:g}; change it"
        )
        raise _refused(config, ("finite_p", "tabulated"), problem, last, outputs)
    if horizon not in finite_p["horizons"]:
        problem = f"must be one of finite_p.horizons = {shown(finite_p['horizons'])}; change it"
        raise _refused(config, ("finite_p", "tabulated"), problem, ("finite_p", "horizons"))
    if finite_p["first_time"] > 0.5 * crossing["horizon"]:
        problem = f"is above half of crossing.horizon = {crossing['horizon']:g}; lower it"
        raise _refused(config, ("finite_p", "first_time"), problem, last)


def _check_speed(config):
    """Refuse lists that do not fit each other, and steps that are no divisors."""
    topic = ("speed_against_error",)
    for section, first, second in (
        ((*topic, "pde", "fitted_grid"), "cells", "steps"),
        ((*topic, "pde", "libraries"), "elements", "steps"),
        ((*topic, "crossing"), "degrees", "contours"),
    ):
        count = len(_value(config, (*section, first)))
        if len(_value(config, (*section, second))) != count:
            problem = f"must have an entry for each of the {count} {first}; add or delete some"
            raise _refused(config, (*section, second), problem, (*section, first))
    scheme, last = (*topic, "pde", "paper_scheme"), (*topic, "pde", "horizon")
    for nodes in _value(config, (*scheme, "nodes")):
        if nodes % 2 == 0:
            problem = f"has {nodes}, but nodes must be odd; add one"
            raise _refused(config, (*scheme, "nodes"), problem)
    for step in _value(config, (*scheme, "time_steps")):
        if not _divides(step, _value(config, last)):
            problem = f"has {step}, which does not divide pde.horizon; change it"
            raise _refused(config, (*scheme, "time_steps"), problem, last)
    step, horizons = (*topic, "cost", "paper_scheme", "time_step"), (*topic, "cost", "horizons")
    for horizon in _value(config, horizons):
        if not _divides(_value(config, step), horizon):
            problem = f"must divide all of cost.horizons, but not {horizon}; change it"
            raise _refused(config, step, problem, horizons)
    doublings, finest = (*topic, "pathwise", "doublings"), (*topic, "pathwise", "reference")
    if max(_value(config, doublings)) >= _value(config, finest):
        problem = f"must be below pathwise.reference = {_value(config, finest)}; leave out others"
        raise _refused(config, doublings, problem, finest)
