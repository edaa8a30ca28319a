"""Configuration files, read strictly: what is broken or doubled is refused with its line.

Snakemake itself takes the last of doubled keys, and answers some broken files with a traceback and
those that ask for it (``__use_yte__``) by running the code in them.
"""

from pathlib import Path
from typing import Any

import yaml

from reproduction.errors import ConfigError

# a configuration has some hundred lines; aliases of aliases can make billions of values of a few
LARGEST_FILE = 1_000_000
MOST_VALUES = 100_000


def read(path: str | Path) -> dict[str, Any]:
    """Read a configuration file.

    Parameters
    ----------
    path : str or Path
        YAML in UTF-8.

    Returns
    -------
    dict

    Raises
    ------
    ConfigError
        If it is not readable, no YAML, no mapping, has a key twice, or tags or so many values as no
        configuration has: one line with the file and, where there is one, the line.
    """
    path = Path(path)
    text = _text(path)
    try:
        loader = yaml.SafeLoader(text)
        node = loader.get_single_node()
        if not isinstance(node, yaml.MappingNode):
            found = "is empty" if node is None else "has no keys at its top level"
            raise ConfigError(f"{found}; write 'key: value' as in config.yaml", path)
        _require_modest(node, path)
        _require_plain(node, path)
        if any(key.value == "__use_yte__" for key, _ in node.value):
            raise ConfigError("asks to run code, by '__use_yte__'; delete that key", path)
        return loader.construct_document(node)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise _broken(path, mark, error.problem or error.context) from None
    except yaml.YAMLError as error:
        # a control character; only a position is known
        number = text.count("\n", 0, getattr(error, "position", 0)) + 1
        raise ConfigError(
            f"line {number}: a character that YAML does not allow; delete it", path
        ) from None
    except (ValueError, OverflowError) as error:
        told = str(error).partition(";")[0]  # the rest is advice to programmers
        raise ConfigError(f"has a value that cannot be read ({told}); mend it", path) from None
    except RecursionError:
        raise ConfigError("is nested too deeply; write it as config.yaml is", path) from None


def _text(path):
    try:
        if not path.is_file():
            raise ConfigError(
                "is not a file that exists; name a configuration file, and write -- before targets",
                path,
            )
        if path.stat().st_size > LARGEST_FILE:
            raise ConfigError(
                f"has more than {LARGEST_FILE:_} bytes; a configuration has some thousands", path
            )
        raw = path.read_bytes()
    except OSError as error:
        raise ConfigError(f"cannot be read ({error.strerror}); make it readable", path) from None
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as error:
        number = raw.count(b"\n", 0, error.start) + 1
        raise ConfigError(f"line {number} is not UTF-8; save the file as UTF-8", path) from None


def _broken(path, mark, problem):
    cure = "mend the YAML there or just before"
    if "'\\t'" in problem:
        problem, cure = "a tab", "indent with blanks"
    problem = " ".join(problem.split())[:80]
    return ConfigError(f"line {mark.line + 1}, column {mark.column + 1}: {problem}; {cure}", path)


def _require_modest(node, path):
    """Refuse a document that its aliases make huge or endless."""
    sizes, open_nodes = {}, set()

    def size(node):
        if id(node) in open_nodes:
            raise ConfigError(
                f"line {node.start_mark.line + 1}: an anchor that contains itself; write it out",
                path,
            )
        if id(node) not in sizes:
            open_nodes.add(id(node))
            sizes[id(node)] = 1 + sum(map(size, _inner(node)))
            open_nodes.remove(id(node))
        return sizes[id(node)]

    if size(node) > MOST_VALUES:
        raise ConfigError(f"has more than {MOST_VALUES:_} values; write fewer", path)


def _inner(node):
    if isinstance(node, yaml.MappingNode):
        return [inner for pair in node.value for inner in pair]
    return node.value if isinstance(node, yaml.SequenceNode) else []


def _require_plain(node, path):
    """Refuse tags, keys that are no texts or stand twice, and numbers to bases other than ten."""
    line = node.start_mark.line + 1
    if not node.tag.startswith("tag:yaml.org,2002:") or "python" in node.tag:
        tag = node.tag.removeprefix("tag:yaml.org,2002:")[:40]
        raise ConfigError(f"line {line}: the tag {tag!r} is not allowed; delete it", path)
    if isinstance(node, yaml.MappingNode):
        first = {}
        for key, _ in node.value:
            name, number = key.value, key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode) or key.tag != "tag:yaml.org,2002:str":
                raise ConfigError(f"line {number}: a key that is not a name; quote it", path)
            if name in first:
                raise ConfigError(
                    f"line {number}: the key {name[:80]!r} stands already in line {first[name]}; "
                    "delete one of the two",
                    path,
                )
            first[name] = number
    if isinstance(node, yaml.ScalarNode) and _is_read_as_another_number(node):
        number, told = node.start_mark.line + 1, node.value[:40]
        raise ConfigError(f"line {number}: {told!r} is not a decimal number; write it as one", path)
    for inner in _inner(node):
        _require_plain(inner, path)


def _is_read_as_another_number(node):
    """Whether YAML 1.1 takes a scalar as sexagesimal (1:30), octal (010), binary or hexadecimal."""
    digits = node.value.lstrip("+-").replace("_", "")
    octal = digits.isdecimal() and digits.startswith("0") and digits.strip("0") != ""
    if node.tag == "tag:yaml.org,2002:int":
        return octal or not digits.isdecimal()
    return node.tag == "tag:yaml.org,2002:float" and ":" in digits
