"""Mutations of the two configurations, generated from the schema, and what must become of them."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
CONFIG, SMOKE = "config.yaml", "config/smoke.yaml"
SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
DELETED = object()


@dataclass(frozen=True)
class Mutation:
    """One change of a configuration file.

    Parameters
    ----------
    kind : str
    file : str
        Of the two configurations.
    key : tuple
        Keys and positions of what is changed.
    content : dict or bytes
        The whole changed configuration, or the file's text.
    legal : bool
        Whether it must be accepted.
    """

    kind: str
    file: str
    key: tuple
    content: dict | bytes
    legal: bool = False

    @property
    def told(self) -> str:
        """The file, and what is changed where."""
        return f"{self.file}, {self.kind}, {'.'.join(map(str, self.key))[:80]}"

    @property
    def text(self) -> bytes:
        """The whole changed file."""
        if isinstance(self.content, bytes):
            return self.content
        return yaml.safe_dump(self.content, sort_keys=False, allow_unicode=True).encode()


BROKEN = {
    "formula: unfinished": "x +",
    "formula: statement": "import os",
    "formula: unknown variable": "q",
    "formula: two statements": "x; x",
    "formula: string": "exp(\"__import__('os').system('touch hacked')\")",
    "formula: call of a builtin": "__import__('os')",
    "formula: attribute": "x.__class__",
    "formula: comparison": "x < 1",
    "formula: complex": "sqrt(-1)*x",
    "formula: lambda": "lambda x: x",
    "formula: exploding power": "(9**9999)**9999",
    "formula: very long": "+".join(["x"] * 15_000),
    "formula: list": "[x, x]",
    "formula: unclosed": "(x",
    "formula: not finite": "1/0",
}
BROKEN_TEXTS = {
    "YAML: empty": b"",
    "YAML: comments alone": b"# nothing\n",
    "YAML: tab": b"crossing:\n\tp: [1]\n",
    "YAML: unclosed bracket": b"crossing:\n  p: [1, 2\nseed: 1\n",
    "YAML: unclosed quote": b"seed: 'a\n",
    "YAML: doubled key": b"seed: 1\nseed: 2\n",
    "YAML: doubled key inside": b"crossing:\n  paths: 100\n  paths: 200\n",
    "YAML: UTF-16": "seed: 1\n".encode("utf-16"),
    "YAML: latin-1": "# für\nseed: 1\n".encode("latin-1"),
    "YAML: control character": b"seed: \x01\n",
    "YAML: list": b"- 1\n- 2\n",
    "YAML: scalar": b"5\n",
    "YAML: two documents": b"seed: 1\n---\nseed: 2\n",
    "YAML: python tag": b"seed: !!python/object/apply:os.system ['touch hacked']\n",
    "YAML: own tag": b"seed: !mine 1\n",
    "YAML: runs code": b"__use_yte__: true\n__definitions__:\n  - open('hacked', 'w')\nseed: 1\n",
    "YAML: billion laughs": b"a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
    + b"".join(b"%c: &%c [%s]\n" % (c, c, b", ".join([b"*%c" % (c - 1)] * 9)) for c in b"bcdefghi"),
    "YAML: anchor in itself": b"seed: &a [*a]\n",
    "YAML: unknown alias": b"seed: *a\n",
    "YAML: nested deeply": b"seed: " + b"[" * 5000,
    "YAML: impossible date": b"seed: 2026-13-45\n",
    "YAML: indentation": b"crossing:\n  paths: 100\n    shard: 1\n",
    "YAML: zeros": b"\0" * 100,
    "YAML: number of 5000 digits": b"seed: " + b"9" * 5000 + b"\n",
    "YAML: key that is a number": b"1: 2\n",
    "YAML: sexagesimal": b"crossing:\n  horizon: 1:30\n",
    "YAML: sexagesimal fraction": b"crossing:\n  horizon: 1:30.5\n",
    "YAML: octal": b"crossing:\n  paths: 0100000\n",
    "YAML: hexadecimal": b"seed: 0x10\n",
    "YAML: binary": b"seed: 0b10\n",
}


def mutations() -> list[Mutation]:
    """Generate them all; the order is fixed."""
    found = []
    schema = yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))
    for file in (CONFIG, SMOKE):
        config = yaml.safe_load((ROOT / file).read_text(encoding="utf-8"))
        found += [Mutation(kind, file, (), text) for kind, text in BROKEN_TEXTS.items()]
        for kind, key, value in [
            *mutated_by_schema(config, schema, schema, file),
            *SIZES,
            *MISFITS,
        ]:
            # a file that overrides may leave out everything
            if not (file == SMOKE and value is DELETED):
                found.append(changed(kind, file, config, key, value))
        found += [
            changed(f"outputs: {value!r:.30}", file, config, ("outputs", name), value)
            for name, values in OUTPUTS.items()
            for value in values
            # the results of the reduced sizes are elsewhere
            if not (file == SMOKE and value.startswith("results/tables"))
        ]
    config = yaml.safe_load((ROOT / CONFIG).read_text(encoding="utf-8"))
    found += [changed("legal", CONFIG, config, key, value, legal=True) for key, value in LEGAL]
    return found


def changed(
    kind: str, file: str, config: dict, key: tuple, value: object, legal: bool = False
) -> Mutation:
    """Change one value of a configuration."""
    return Mutation(kind, file, key, _with(config, key, value), legal)


def _with(config, key, value):
    """Return a configuration with one value changed; what is not on the way to it is shared."""
    if not key:
        return value
    first, *rest = key
    if isinstance(config, list):
        return [*config[:first], _with(config[first], rest, value), *config[first + 1 :]]
    if value is DELETED and not rest:
        return {name: own for name, own in config.items() if name != first}
    return config | {first: _with(config.get(first, {}), rest, value)}


def mutated_by_schema(
    value: object, node: dict, schema: dict, file: str, key: tuple = ()
) -> Iterator[tuple[str, tuple, object]]:
    """Walk a configuration with its schema, and break each value in every way the schema names."""
    node = _resolved(value, node, schema)
    if key:
        yield "null", key, None
        yield "wrong type", key, [] if node.get("type") == "object" else {"a": 1}
    kind = node.get("type", "string")
    kind = kind[0] if isinstance(kind, list) else kind
    yield from {"object": _objects, "array": _arrays, "string": _texts}.get(kind, _numbers)(
        value, node, key
    )
    if kind == "object":
        named = node.get("properties", {})
        for name, inner in value.items():
            below = named.get(name, node.get("additionalProperties"))
            if below:
                yield from mutated_by_schema(inner, below, schema, file, (*key, name))
    elif kind == "array":
        # all entries are alike
        below = node["prefixItems"][0] if "prefixItems" in node else node.get("items")
        if below:
            yield from mutated_by_schema(value[0], below, schema, file, (*key, 0))


def _resolved(value, node, schema):
    """Follow references, and the branch that a value takes."""
    while True:
        if "$ref" in node:
            rest = {name: own for name, own in node.items() if name != "$ref"}
            node = schema["$defs"][node["$ref"].rpartition("/")[2]] | rest
        elif "if" in node and "type" not in node:
            named = set(value) if isinstance(value, dict) else set()
            if "type" in node["if"]:
                taken = isinstance(value, {"object": dict, "string": str}[node["if"]["type"]])
            else:
                taken = bool({"H", "F"} & named)
            node = node["then" if taken else "else"]
        else:
            return node


def _objects(value, node, key):
    named = "properties" in node
    for name in node.get("required", []):
        if name in value:
            yield "missing key", (*key, name), DELETED
    if named:
        yield "extra key", (*key, "extra"), 1
        for name in value:
            # two letters exchanged, as in sigam
            if len(name) > 1 and (wrong := name[:-2] + name[-1] + name[-2]) not in value:
                yield "misspelt key", (*key, wrong), value[name]
    else:
        first = next(iter(value.values()))
        for name in ("", "Two Words", "a/b", "../a", "line\nbreak", "x" * 300):
            yield "name", (*key, name), first


def _arrays(value, node, key):
    yield "not a list", key, value[0]
    if node.get("minItems", 0) > 0:
        yield "too short", key, value[: node["minItems"] - 1]
    if "maxItems" in node:
        yield "too long", key, [*value, *value][: node["maxItems"] + 1]
    if node.get("uniqueItems"):
        yield "repeated", key, [*value[:-1], value[0], value[0]]
    if "increas" in node.get("description", ""):
        yield "not sorted", key, value[::-1] if len(value) > 1 else [*value, *value]


def _texts(value, node, key):
    yield "number for a text", key, 5
    yield "empty text", key, ""
    if "enum" in node:
        yield "not a choice", key, value[:-1]
    elif "formula" in node.get("description", "") or "pathwise" in key:
        # a third of them for each formula, so that all are tried somewhere
        for kind, formula in list(BROKEN.items())[len(".".join(map(str, key))) % 3 :: 3]:
            yield kind, key, formula


def _numbers(value, node, key):
    whole = node["type"] == "integer"
    yield "text for a number", key, "many"
    yield "boolean for a number", key, True
    yield "not a number", key, math.nan
    yield "negative", key, -1 if whole else -0.5
    if "may be .inf" not in node.get("description", ""):
        yield "infinite", key, math.inf
    if whole:
        yield "fraction", key, value + 0.5
        yield "float for an integer", key, float(value)
    lowest = node.get("minimum", node.get("exclusiveMinimum"))
    if lowest is not None and lowest > 0:
        yield "zero", key, 0
        yield "below the minimum", key, lowest - 1 if whole else lowest / 2
    if "exclusiveMinimum" in node:
        yield "at the excluded minimum", key, node["exclusiveMinimum"]
    highest = node.get("maximum", node.get("exclusiveMaximum"))
    if highest is not None:
        yield "above the maximum", key, highest * 10 if whole else highest * 1.5
    if "exclusiveMaximum" in node:
        yield "at the excluded maximum", key, node["exclusiveMaximum"]


HUGE, LONG, SHORT = 10**15, 1.0e12, 1.0e-12
SIZES = [
    ("size", key, value)
    for value, keys in {
        HUGE: [
            ("variance", "monte_carlo", "paths"),
            ("variance", "monte_carlo", "halving_paths"),
            ("variance", "times"),
            ("crossing", "paths"),
            ("crossing", "halving", "gamma2_paths"),
            ("crossing", "outputs"),
            ("gamma2", "potentials", "paths"),
            ("gamma2", "potentials", "halving_paths"),
            ("sweep", "paths"),
            ("sweep", "halving_paths"),
            ("sweep", "outputs"),
            ("sweep", "variance", "paths"),
            ("sweep", "variance", "halving_paths"),
            ("density", "paths"),
            ("limit_theorem", "paths"),
            ("plasticity", "paths"),
            ("plasticity", "outputs"),
            ("rates", "paths"),
            ("rates", "weak", "paths"),
            ("hard_cases", "paths"),
            ("trajectories", "outputs"),
            ("speed_against_error", "cost", "least"),
            ("speed_against_error", "rounds"),
        ],
        8 * 10**9 + 1: [
            ("variance", "finite_difference", "nodes"),
            ("convergence", "finite_difference", "nodes"),
            ("speed_against_error", "cost", "paper_scheme", "nodes"),
        ],
        LONG: [
            ("trajectories", "horizon"),
            ("variance", "horizon"),
            ("crossing", "horizon"),
            ("crossing", "halving", "gamma2_time"),
            ("convergence", "horizon"),
            ("sweep", "horizon"),
            ("density", "time"),
            ("plasticity", "duration"),
            ("rates", "horizon"),
            ("rates", "weak", "horizon"),
            ("speed_against_error", "monte_carlo", "horizon"),
            ("speed_against_error", "crossing", "horizon"),
        ],
        SHORT: [
            ("trajectories", "step"),
            ("variance", "finite_difference", "time_step"),
            ("variance", "monte_carlo", "step"),
            ("crossing", "step"),
            ("convergence", "finite_difference", "time_step"),
            ("gamma2", "potentials", "step"),
            ("sweep", "step"),
            ("sweep", "scenes", "friction_white", "long_step"),
            ("theorems", "ergodicity", "step"),
            ("density", "step"),
            ("limit_theorem", "step"),
            ("plasticity", "step"),
            ("plasticity", "tolerance"),
            ("rates", "resolution"),
            ("rates", "longest_step"),
            ("rates", "weak", "step"),
            ("speed_against_error", "gamma2", "step"),
            ("speed_against_error", "cost", "step"),
            ("limits", "hours"),
            ("limits", "memory"),
        ],
    }.items()
    for key in keys
] + [
    ("size", ("crossing", "p"), [1, 1.0e12]),
    ("size", ("sweep", "p"), [1.0e12]),
    ("size", ("limit_theorem", "p"), [1, 10, 1.0e12]),
    ("size", ("sweep", "variance", "times"), [10, 60, 1.0e12]),
    ("size", ("gamma2", "potentials", "times"), [10, 60, 1.0e12]),
    ("size", ("gamma2", "tolerance"), [1.0e-10, 1.0e-12, 1.0e-12, 1.0e-12]),
    ("size", ("speed_against_error", "monte_carlo", "paths"), [HUGE]),
    ("size", ("speed_against_error", "monte_carlo", "steps"), [SHORT]),
    ("size", ("speed_against_error", "gamma2", "paths"), [HUGE]),
    ("size", ("speed_against_error", "cost", "horizons"), [1.0e12]),
    ("size", ("speed_against_error", "cost", "n"), [1.0e9]),
    ("size", ("speed_against_error", "pde", "paper_scheme", "nodes"), [8 * 10**9 + 1]),
    ("size", ("speed_against_error", "pde", "spectral_elements", "degrees"), [10**6]),
]
MISFITS = [
    ("misfit", ("variance", "finite_difference", "time_step"), 0.003),
    ("misfit", ("variance", "first_time"), 0.07),
    ("misfit", ("variance", "horizon"), 0.01),
    ("misfit", ("convergence", "finite_difference", "time_step"), 0.003),
    ("misfit", ("convergence", "horizon"), 0.001),
    ("misfit", ("variance", "finite_difference", "nodes"), 4003),
    ("misfit", ("convergence", "finite_difference", "nodes"), 1000),
    ("misfit", ("convergence", "finite_difference", "nodes"), 9),
    ("misfit", ("speed_against_error", "cost", "paper_scheme", "time_step"), 0.03),
    ("misfit", ("speed_against_error", "pde", "paper_scheme", "time_steps"), [0.3]),
    ("misfit", ("speed_against_error", "pde", "paper_scheme", "nodes"), [400]),
    ("misfit", ("speed_against_error", "pde", "fitted_grid", "cells"), [50]),
    ("misfit", ("speed_against_error", "crossing", "contours"), [3]),
    ("misfit", ("speed_against_error", "pathwise", "doublings"), [4, 15]),
    ("misfit", ("crossing", "shard"), 7500),
    ("misfit", ("finite_p", "tabulated"), 3),
    ("misfit", ("finite_p", "first_time"), 11),
    ("misfit", ("rates", "resolution"), "4e0"),
    ("misfit", ("trajectories", "step"), 60),
    ("misfit", ("variance", "monte_carlo", "step"), 6),
    ("misfit", ("crossing", "step"), 11),
    ("misfit", ("sweep", "step"), 1.5),
    ("misfit", ("sweep", "scenes", "friction_white", "long_step"), 50),
    ("misfit", ("density", "step"), 20),
    ("misfit", ("limit_theorem", "step"), 0.6),
    ("misfit", ("plasticity", "step"), 399),
    ("misfit", ("rates", "longest_step"), 2),
    ("misfit", ("rates", "weak", "step"), 6),
    ("misfit", ("gamma2", "potentials", "step"), 30),
    ("misfit", ("speed_against_error", "gamma2", "step"), 6),
    ("misfit", ("speed_against_error", "rare", "step"), 1.5),
    ("scene", ("sweep", "simulated"), ["no_such_scene"]),
    ("scene", ("gamma2", "scenes"), ["no_such_scene"]),
    ("scene", ("density", "scenes"), ["no_such_scene"]),
    ("scene", ("limit_theorem", "scenes"), ["friction"]),
    ("scene", ("rare_crossings", "thresholds", "no_such_scene"), [1.0]),
    ("scene", ("rates", "crossing", "smallest", "no_such_scene"), 4),
    ("scene", ("theorems", "ergodicity", "scenes"), ["obstacle_langevin"]),
    ("scene", ("rates", "crossing", "scenes"), ["obstacle_langevin"]),
    ("scene", ("rates", "crossing", "scenes"), ["friction_hamiltonian"]),
    ("scene", ("speed_against_error", "cost", "names"), ["no_such_scene"]),
    ("scene", ("variance", "scene", "noise"), "langevin"),
    ("scene", ("crossing", "scene", "model"), "obstacle"),
    ("scene", ("convergence", "scene", "potential"), "x**2/2"),
    ("scene", ("speed_against_error", "peers"), "/bin/sh"),
    ("not sorted", ("limit_theorem", "p"), [1, 100, 10]),
    ("not sorted", ("finite_p", "p"), [1, 100, 10]),
    ("not sorted", ("sweep", "variance", "times"), [10, 110, 60]),
    ("not sorted", ("gamma2", "potentials", "times"), [10, 140, 90]),
    (
        "noise",
        ("gamma2", "potentials", "scenes", 0, "noise"),
        {"potential": "eta**2", "sigam": 2},
    ),
    ("noise", ("gamma2", "potentials", "scenes", 0, "noise"), {"H": "eta**2", "sigma": 2.0}),
    ("noise", ("gamma2", "potentials", "scenes", 0, "noise"), {}),
    ("noise", ("gamma2", "potentials", "scenes", 0, "noise"), "langevin"),
]
OUTPUTS = {
    "paper": [
        *("README.md", "paper/paper.typ", "config.yaml", "Snakefile", "docs/speed_pde.pdf"),
        *("src/paper.pdf", "SRC/paper.pdf", ".git/paper.pdf", "tests/mine.pdf", "results/../a.pdf"),
        *("", " ", "results", ".", "/", "paper", "paper/", "./paper.pdf", "paper/paper.PDF.txt"),
        *("results/tables/table_4.csv", "results/tables/paper.pdf", "a\nb.pdf", "{scene}.pdf"),
        *("~/paper.pdf", "x" * 250 + ".pdf", "/dev/null", "/proc/paper.pdf", "s3://a/paper.pdf"),
        *("profiles/default/paper.pdf", "config.yaml/paper.pdf", "paper .pdf ", "../../../../x"),
    ],
    "results": [
        *("", " ", "/", ".", "..", "~", "src", "src/x", "workflow", "tests/x", "docs/x", ".git/x"),
        *("config", "examples", "benchmarks", ".venv/x", ".snakemake", "paper", "README.md"),
        *("results/", "results//x", "results/../src", "config.yaml/results", "{scene}", "a\tb"),
        *("x/" * 2000 + "x", "x" * 300, "/dev/null", "/proc/x", "profiles/x", "paper/paper.pdf"),
        *("/etc", "/usr/bin", "/usr/x"),
    ],
}
LEGAL = [
    (("outputs", "paper"), "results/mine.pdf"),
    (("outputs", "paper"), "/tmp/out/paper.pdf"),
    (("outputs", "results"), "results/mine"),
    (("outputs", "results"), "/tmp/out"),
    (("outputs", "results"), "results/für uns"),
    (("outputs", "results"), "../elsewhere"),
    (("seed",), 0),
    (("seed",), 2**63 - 1),
    (("limits", "memory"), 64),
    (("limits", "hours"), 1000.0),
    (("trajectories", "n"), [float("inf")]),
    (("trajectories", "step"), 0.05),
    (("trajectories", "models", "friction", "potential"), "x**2/2"),
    (("variance", "times"), 2),
    (("variance", "monte_carlo", "paths"), 5_000_000),
    (("variance", "scene", "n"), 10),
    (("variance", "scene", "observable"), "y**3"),
    (("crossing", "p"), [7]),
    (("crossing", "paths"), 1_000_000),
    (("crossing", "threshold"), 1.0),
    (("convergence", "n"), [2]),
    (("convergence", "horizon"), 50),
    (("gamma2", "scenes"), ["friction_white"]),
    (("gamma2", "tolerance"), [1.0e-6, 1.0e-3, 1.0e-2, 0.5]),
    (("gamma2", "potentials", "scenes", 0, "noise"), {"potential": "eta**2", "sigma": 1.0}),
    (("sweep", "p"), [100, 1]),
    (("sweep", "scenes", "friction_white", "scene", "n"), float("inf")),
    (("sweep", "scenes", "friction_white", "scene", "potential"), "0.0"),
    (("theorems", "damping"), [0.5]),
    (("theorems", "potentials", "friction"), ["x**4 +\n x**2"]),
    (("density", "bins"), 4),
    (("limit_theorem", "p"), [1, 2, 3]),
    (("plasticity", "limits"), [3.5]),
    (("rates", "resolution"), 1),
    (("rates", "crossing", "scenes"), ["friction_white"]),
    (("speed_against_error", "diagrams"), ["cost"]),
    (("hard_cases", "paths"), 100),
]
