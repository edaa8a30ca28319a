"""Validation of a configuration against its schema, with one-line messages."""

import difflib
import math
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import yaml

from reproduction.errors import ConfigError, dotted

LARGEST = 1e300  # beyond, arithmetic overflows
SHOWN = 80  # characters of a value in a message


def _is_integer(_, value):
    return isinstance(value, int) and not isinstance(value, bool)


# JSON takes 2.0 for an integer, but ranges and shapes do not
_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine("integer", _is_integer),
)


@cache
def read_schema(path: Path) -> dict:
    """Read a schema of this repository.

    Parameters
    ----------
    path : Path
        YAML in UTF-8.

    Returns
    -------
    dict
    """
    # libyaml, where it is there, takes a tenth of the time
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return yaml.load(path.read_text(encoding="utf-8"), loader)


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
    for key, value in numbers(config):
        if isinstance(value, float) and math.isnan(value):
            raise ConfigError(f"{dotted(key)} is not a number; give it one", key=key)
        if LARGEST < abs(value) != math.inf:
            raise ConfigError(f"{dotted(key)} = {shown(value)} is too large; lower it", key=key)
    errors = list(_Validator(schema).iter_errors(config))
    if errors:
        raise _explained(min(errors, key=_severity), schema)


def numbers(value: Any, key: tuple = ()) -> Iterator[tuple[tuple, int | float]]:
    """Yield every number of a configuration with its keys, from the outermost to the innermost."""
    if isinstance(value, dict | list):
        for part, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from numbers(inner, (*key, part))
    elif isinstance(value, int | float):
        yield key, value


def shown(value: Any) -> str:
    """Spell a value as messages have it: one line, not long."""
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."


def _severity(error):
    """Order errors: a misspelt key comes first, because it is missing, too."""
    return error.validator != "additionalProperties", len(error.absolute_path)


def _meaning(error, schema):
    """Return the innermost description of a value: of its key, else of its kind."""
    meaning, node = "", schema
    for part in error.absolute_schema_path:
        meaning = node.get("description", meaning) if isinstance(node, dict) else meaning
        if isinstance(node, dict) and part not in node:
            node = schema["$defs"][node["$ref"].rpartition("/")[2]]
            meaning = meaning or node.get("description", "")
        node = node[part]
        if part in ("properties", "additionalProperties"):
            meaning = ""
    return meaning


def _explained(error, schema):
    key = tuple(error.absolute_path)
    place = f" in {dotted(key)}" if key else ""
    if error.validator == "additionalProperties":
        return _unknown(error, key, place)
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in error.instance)
        return ConfigError(
            f"the key {missing!r} is missing{place}; add it as in config.yaml", key=key
        )
    if "propertyNames" in error.absolute_schema_path:
        return ConfigError(
            f"the key {shown(error.instance)}{place} {_cure(error)}", key=(*key, error.instance)
        )
    meaning = _meaning(error, schema)
    return ConfigError(
        f"{dotted(key)} = {shown(error.instance)}: {_cure(error)}"
        + (f" ({meaning})" if meaning else ""),
        key=key,
    )


def _unknown(error, key, place):
    known = list(error.schema.get("properties", {}))
    unknown = next(name for name in error.instance if name not in known)
    near = difflib.get_close_matches(str(unknown), known, n=1)
    cure = f"did you mean {near[0]!r}?" if near else f"the keys here are {', '.join(known)}"
    return ConfigError(f"unknown key {shown(unknown)}{place}; {cure}", key=(*key, unknown))


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
            return f"must be of type {limit}{_hint(error)}"
        case "multipleOf":
            return f"must be a multiple of {limit}"
        case "enum":
            return f"must be one of {', '.join(map(str, limit))}"
        case "pattern":
            return error.schema.get("$comment", f"must match {limit}")
        case "minItems" | "minProperties":
            return f"must have at least {limit} entries"
        case "maxItems":
            return f"must have at most {limit} entries"
        case "maxLength":
            return f"must have at most {limit} characters"
        case "minLength":
            return "must not be empty"
        case "uniqueItems":
            return "must not repeat an entry; delete the repetition"
        case _:
            return shown(" ".join(error.message.split()))


def _hint(error):
    """Say how a number is spelt that YAML takes for a text, or for no integer."""
    text, kind = error.instance, error.validator_value
    if kind == "integer" and isinstance(text, float) and text.is_integer() and abs(text) < 1e15:
        return f"; write {int(text)}"
    if kind in ("number", "integer") and isinstance(text, str):
        if found := re.fullmatch(r"([-+]?\d+)(\.?)(\d*)[eE]([-+]?)(\d+)", text):
            whole, _, fraction, sign, exponent = found.groups()
            return f"; write {whole}.{fraction or 0}e{sign or '+'}{exponent}"
        if found := re.fullmatch(r"([-+]?)inf(inity)?", text.strip(), re.IGNORECASE):
            return f"; write {found[1]}.inf"
        return "; write a number without quotes"
    return ""
