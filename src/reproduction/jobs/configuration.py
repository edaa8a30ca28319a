"""Validation of a configuration against its schema, with one-line messages."""

import difflib

import jsonschema

from reproduction.errors import ConfigError


def validate(config: dict, schema: dict) -> None:
    """Check a configuration.

    Parameters
    ----------
    config : dict
    schema : dict
        JSON schema, draft 2020-12.

    Raises
    ------
    ConfigError
        If a key is unknown, missing or out of range: one line that names it and what to do.
    """
    errors = jsonschema.Draft202012Validator(schema).iter_errors(config)
    error = next(iter(sorted(errors, key=lambda e: list(map(str, e.absolute_path)))), None)
    if error is None:
        return
    where = ".".join(map(str, error.absolute_path))
    if error.validator == "additionalProperties":
        known = list(error.schema.get("properties", {}))
        unknown = next(key for key in error.instance if key not in known)
        near = difflib.get_close_matches(str(unknown), known, n=1)
        cure = f"did you mean {near[0]!r}?" if near else f"the keys here are {', '.join(known)}"
        place = f" in {where!r}" if where else ""
        raise ConfigError(f"config: unknown key {str(unknown)!r}{place}; {cure}")
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in error.instance)
        place = f" in {where!r}" if where else ""
        raise ConfigError(
            f"config: the key {missing!r} is missing{place}; add it as in config.yaml"
        )
    meaning = error.schema.get("description", "")
    raise ConfigError(f"config: {where!r} = {error.instance!r}: {_cure(error)} ({meaning})")


def _cure(error):
    limit = error.validator_value
    match error.validator:
        case "exclusiveMinimum":
            return f"must be greater than {limit}"
        case "minimum":
            return f"must be at least {limit}"
        case "exclusiveMaximum":
            return f"must be less than {limit}"
        case "maximum":
            return f"must be at most {limit}"
        case "type":
            return f"must be of type {limit}"
        case "multipleOf":
            return f"must be a multiple of {limit}"
        case "enum":
            return f"must be one of {', '.join(map(str, limit))}"
        case _:
            return " ".join(error.message.split())
