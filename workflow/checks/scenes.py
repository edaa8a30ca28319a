"""The scenes of the configuration."""

from functools import cache

from nonsmooth.scenes.scene import Scene, by_formulas


def scene_of(parameters: dict) -> Scene:
    """Return the scene of a table of parameters; each is made once."""
    return _scene_of(
        tuple(
            (name, tuple(value.items()) if isinstance(value, dict) else value)
            for name, value in parameters.items()
        )
    )


@cache
def _scene_of(items):
    parameters = dict(items)
    if isinstance(parameters["noise"], tuple):
        parameters["noise"] = dict(parameters["noise"])
    return by_formulas(parameters)
