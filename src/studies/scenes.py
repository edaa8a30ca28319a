"""Scenes of a study: a row of its table as an object that the library knows, and its units."""

from collections.abc import Mapping
from typing import Any

from nonsmooth.dimensions import Structure
from nonsmooth.scenes.noises import NOISES, Hamiltonian, Langevin
from nonsmooth.scenes.scene import Scene
from reproduction.errors import ConfigError, configured_by
from studies.units import Units, in_si

# SI units of the quantities of a structure
QUANTITIES = {
    "mass": "kg",
    "stiffness": "N/m",
    "damping_ratio": "1",
    "damping": "N*s/m",
    "slip_force": "N",
    "yield_force": "N",
    "gap": "m",
    "stop_stiffness": "N/m",
    "ground_spectral_density": "m**2/s**3",
    "ground_frequency": "rad/s",
    "ground_damping_ratio": "1",
}
LIMITS = {"friction": "slip_force", "elasto_plastic": "yield_force", "obstacle": "gap"}
# observables of structures: the formula, and what it is
OBSERVABLES = {
    "friction": {"velocity": "y", "displacement": "x", "friction_force": "friction_force"},
    "elasto_plastic": {
        "velocity": "y",
        "elastic_deformation": "x",
        "plastic_strain_rate": "plastic_strain_rate",
    },
    "obstacle": {"velocity": "y", "displacement": "x", "contact_force": "contact_force"},
}
POWERS = {
    "velocity": {"length": 1, "time": -1},
    "plastic_strain_rate": {"length": 1, "time": -1},
    "displacement": {"length": 1},
    "elastic_deformation": {"length": 1},
    "friction_force": {"force": 1},
    "contact_force": {"force": 1},
}


def is_structure(parameters: Mapping) -> bool:
    """Whether a scene is given in SI units."""
    return "mass" in parameters


def scene_of(parameters: Mapping[str, Any], names: Mapping[str, str]) -> tuple[Scene, Units]:
    """Make a scene.

    Parameters
    ----------
    parameters : mapping
        Valid by the schema of studies.
    names : mapping
        The user's units, by length, time and force.

    Returns
    -------
    Scene
    Units
        With the scales of the scene, if it is given in SI units.

    Raises
    ------
    ConfigError
        If a quantity cannot be read, is missing or does not belong to the model; with its key.
    SceneError, ExpressionError
        As from the library.
    """
    if not is_structure(parameters):
        arguments = dict(parameters)
        arguments["noise"] = _noise(arguments.get("noise", "white"), arguments.pop("sigma", 1.0))
        return Scene(**arguments), Units()
    structure = structure_of(parameters)
    n = parameters.get("n", float("inf"))
    if "stop_stiffness" in parameters:
        contact = in_si(parameters["stop_stiffness"], QUANTITIES["stop_stiffness"])
        n = contact * structure.scales.time**2 / structure.mass
    known = OBSERVABLES[structure.model]
    observable = parameters.get("observable", next(iter(known)))
    return structure.scene(known.get(observable, observable), n), Units(structure.scales, names)


def _noise(noise, sigma):
    if isinstance(noise, Mapping):
        return (Hamiltonian if "H" in noise else Langevin)(**noise, sigma=sigma)
    return NOISES[noise](sigma=sigma)


def structure_of(parameters: Mapping[str, Any]) -> Structure:
    """Read a structure in SI units; errors as from `scene_of`."""
    model = parameters["model"]
    si = {}
    for name in QUANTITIES.keys() & parameters.keys():
        with configured_by(name):
            si[name] = in_si(parameters[name], QUANTITIES[name])
            if not si[name] > 0:
                raise ConfigError(f"{parameters[name]!r} is not positive; give a positive quantity")
    for name in (*LIMITS.values(), "stop_stiffness"):
        of = (
            "obstacle" if name == "stop_stiffness" else next(m for m in LIMITS if LIMITS[m] == name)
        )
        if name in si and of != model:
            raise ConfigError(f"{name!r} is of the model {of!r}, not of {model!r}; delete it")
    if "stop_stiffness" in si and "n" in parameters:
        raise ConfigError("'stop_stiffness' and 'n' are both given; delete one of the two")
    _require(si, LIMITS[model], f"the model {model!r} needs it")
    if model == "elasto_plastic":
        _require(si, "stiffness", "a structure that yields needs it")
    for one, other in (
        ("ground_frequency", "ground_damping_ratio"),
        ("ground_damping_ratio", "ground_frequency"),
    ):
        if one in si:
            _require(si, other, f"it belongs to {one!r}")
    return Structure(
        model,
        mass=si["mass"],
        damping=_damping(si),
        limit=si[LIMITS[model]],
        spectral_density=si["ground_spectral_density"],
        stiffness=si.get("stiffness", 0.0),
        ground_frequency=si.get("ground_frequency"),
        ground_damping=si.get("ground_damping_ratio"),
    )


def _damping(si):
    if ("damping" in si) == ("damping_ratio" in si):
        both = "both" if "damping" in si else "none"
        raise ConfigError(
            f"of 'damping' and 'damping_ratio' there are {both}; give exactly one of them"
        )
    if "damping" in si:
        return si["damping"]
    _require(si, "stiffness", "a damping ratio needs it; without a spring give 'damping'")
    return 2 * si["damping_ratio"] * (si["stiffness"] * si["mass"]) ** 0.5


def _require(si, name, why):
    if name not in si:
        raise ConfigError(f"the key {name!r} is missing: {why}; add it, in {QUANTITIES[name]}")


def observed(parameters: Mapping[str, Any]) -> Mapping[str, int]:
    """Return the powers of the base quantities in the observable; none of a formula's."""
    if not is_structure(parameters):
        return {}
    known = OBSERVABLES[parameters["model"]]
    return POWERS.get(parameters.get("observable", next(iter(known))), {})
