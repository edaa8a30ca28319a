"""Bad studies: each is refused in a line that says what is wrong, and none runs.

Mutations of the studies in `studies/` are made from their schema and from what the library calls
odd. With no argument each is checked in this process, from a file; ``--command N`` gives every N-th
to ``snakemake --dry-run`` as a user would. Prints what `benchmarks.trials.configurations` prints,
and exits with status 1 if anything is bad.
"""

import argparse
import shutil
import tempfile
import time
import traceback
from dataclasses import replace
from pathlib import Path

import yaml

from benchmarks.trials import configurations
from benchmarks.trials.mutations import (
    BROKEN,
    BROKEN_TEXTS,
    DELETED,
    ROOT,
    Mutation,
    changed,
    mutated_by_schema,
)
from benchmarks.trials.tally import Tally
from reproduction.errors import ConfigError
from workflow.studies import Studies

SCHEMA = ROOT / "workflow/schemas/study.schema.yaml"
BAD_QUANTITIES = (
    "3",
    "3 flurps",
    "kg",
    "1e999 kg",
    "-1 kg",
    "0 N",
    "1 kg kg",
    "__import__('os')",
    "",
)
BAD_ARGUMENTS = {
    "tol": (0, -1, "small", [0.1], 1e-40),
    "threshold": (-1, 0, "far", [], [[1, 2, 3]], {"a": 1}),
    "horizons": ([], 0, [2, 1], ["soon"], [1, 1]),
    "times": ([], -1, ["soon"]),
    "method": ("by hand", 1, ["monte_carlo"], "Monte Carlo"),
    "paths": (0, 1.5, "many"),
    "probability": (0, 1, 1.5, [], "half"),
    "variable": ("z", "eta" * 30, 1),
    "parameter": ("theta", 1),
    "sides": ("left", 1),
    "p": (0, -1, "large"),
    "step": (0, -1, "short"),
    "precision": ("half", 16),
    "order": (0, 4, 1.5),
}
CSV = {
    "a cell that is no YAML": "name,slip_force\na,[1\n",
    "a cell with a tag": "name,slip_force\na,!!python/object/apply:os.system ['touch hacked']\n",
    "a cell with an alias": "name,slip_force\na,*b\n",
    "a nested cell": "name,slip_force\na," + "[" * 5000 + "\n",
    "an impossible date": "name,slip_force\na,2026-13-45\n",
    "a column twice": "name,slip_force,slip_force\na,1 N,2 N\n",
    "a name twice": "name,slip_force\na,1 N\na,2 N\n",
    "no names": "slip_force\n1 N\n",
    "a name that leaves the folder": "name,slip_force\n../a,1 N\n",
    "a name with a blank": "name,slip_force\na b,1 N\n",
    "a name with a slash": "name,slip_force\na/b,1 N\n",
    "a long name": "name,slip_force\n" + "a" * 300 + ",1 N\n",
    "a cell too many": "name,slip_force\na,1 N,2\n",
    "a cell too few": "name,slip_force,n\na,1 N\n",
    "an unknown column": "name,slip_farce\na,1 N\n",
    "a column without a name": "name,\na,1 N\n",
    "empty": "",
    "names of columns alone": "name,slip_force\n",
    "NUL": "name,slip_force\na,\0\n",
    "semicolons": "name;slip_force\na;1 N\n",
    "UTF-16": "name,slip_force\na,1 N\n".encode("utf-16"),
    "latin-1": "name,slip_force\nfür,1 N\n".encode("latin-1"),
}
FILES = (
    "../x.csv",
    "/etc/passwd",
    "rows.txt",
    "",
    "no_such.csv",
    ".",
    "a\nb.csv",
    "x" * 300 + ".csv",
)
NAMES = ("", "Two Words", "a/b", "../a", "line\nbreak", "x" * 300, ".", "..", "ä", "a.b", "a:b")


def mutations() -> list[Mutation]:
    """Generate them all; the order is fixed."""
    schema = yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))
    found = []
    for path in sorted((ROOT / "studies").glob("*.yaml")):
        study, file = yaml.safe_load(path.read_text(encoding="utf-8")), f"studies/{path.name}"
        found += [Mutation(kind, file, (), text) for kind, text in BROKEN_TEXTS.items()]
        found += [
            replace(changed(kind, file, study, key, value), key=key[key[:1] == ("base",) :])
            for kind, key, value in [
                # an empty summary is one, and m is a choice as mm is
                *(
                    mutation
                    for mutation in mutated_by_schema(study, schema, schema, file)
                    if mutation[:2] != ("empty text", ("summary",)) and mutation[2] != "m"
                ),
                *_parameters(study, schema, file),
                *_questions(study),
                *_structure(study),
            ]
        ]
    return found


def _parameters(study, schema, file):
    """Break every parameter of the scenes, which the schema has by their kind."""
    base = study["base"]
    node = schema["$defs"]["system" if "mass" in base else "scene"]
    for kind, key, value in mutated_by_schema(base, node, schema, file):
        # another model, or a scene that says it itself, makes some of these right
        plain = "ratio" in str(key[-1]) and kind == "number for a text"
        if not plain and (kind != "missing key" or key[-1] == "model"):
            yield kind, ("base", *key), value
    for name, own in base.items():
        if isinstance(own, str) and own[:1].isdigit():
            for value in BAD_QUANTITIES[1 if "ratio" in name else 0 :]:
                yield f"quantity {value!r}", ("base", name), value
    for kind, formula in BROKEN.items():
        yield kind, ("base", "observable"), formula


def _questions(study):
    """Break every argument of every question."""
    for name, question in study["questions"].items():
        key = ("questions", name)
        yield "unknown question", (*key, "ask"), question["ask"][:-2]
        for argument in question:
            for value in BAD_ARGUMENTS.get(argument, ()):
                yield f"argument {value!r:.30}", (*key, argument), value
        for argument in ("tol", "method"):
            for value in BAD_ARGUMENTS[argument]:
                yield f"argument {value!r:.30}", (*key, argument), value
        yield "unknown argument", (*key, "tool"), 1
        if question["ask"] == "crossing_probability":
            sizes = {"method": "monte_carlo", "paths": 10**15, "step": question["horizons"][0]}
            yield "size", key, question | sizes
            yield "two methods", key, question | {"method": "deterministic", "paths": 100}
            yield "an order of counting", key, question | {"method": "monte_carlo", "order": 2}


def _structure(study):
    """Break names, files of scenes and sweeps."""
    scene = {"n": 7}
    for name in NAMES:
        yield "name of a scene", ("scenes",), {name: scene}
        yield "name of a question", ("questions", name), {"ask": "mean"}
    for name in FILES:
        yield "file of scenes", ("scenes",), name
    yield "scenes and a sweep", ("sweep" if "scenes" in study else "scenes",), {"a": {"n": 1}}
    yield "nothing", ("questions",), {}
    for axes in (
        {"n": []},
        {"n": 5},
        {"n": [1, 1]},
        {"n": [1, "many"]},
        {"../n": [1, 2]},
        {"n": list(range(1, 400)), "damping": list(range(1, 400))},
        {"potential": ["x**2/2", "__import__('os')"]},
        {"start": [{"y": 1}, {"q": 1}]},
    ):
        yield "sweep", ("scenes",), DELETED
        yield "sweep", (), {k: v for k, v in study.items() if k != "scenes"} | {"sweep": axes}


def answer(mutation: Mutation, folder: Path) -> str:
    """Check a mutation as the rules do; return the error's message, or nothing if accepted."""
    path = folder / mutation.file
    path.write_bytes(mutation.text)
    try:
        Studies({}, str(path.parent)).check([f"study_{path.stem}"])
    except ConfigError as error:
        return f"error: {error}".replace(f"{folder}/", "")
    except Exception:  # what snakemake would print; it is counted
        return traceback.format_exc()
    return ""


def tables(folder: Path) -> list[tuple[str, str]]:
    """Answers about broken files of scenes, by what is broken."""
    base = yaml.safe_load((ROOT / "studies/sliding_isolator.yaml").read_text(encoding="utf-8"))
    mutation = changed("CSV", "studies/table.yaml", base, ("scenes",), "table.csv")
    found = []
    for kind, content in CSV.items():
        raw = content.encode() if isinstance(content, str) else content
        (folder / "studies/table.csv").write_bytes(raw)
        found.append((kind, answer(mutation, folder)))
    return found


def main() -> None:
    """Run the trial."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--command", type=int, metavar="N", help="every N-th through snakemake")
    every = parser.parse_args().command
    tally = Tally()
    # a sweep without its scenes and a scene more may be right
    chosen = [m for m in mutations() if not (m.kind == "sweep" and m.key)][:: every or 1]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if every:
            configurations.copy_of_repository(folder)
        else:
            shutil.copytree(ROOT / "studies", folder / "studies")
        for mutation in chosen:
            began = time.process_time()
            if every:
                target = f"study_{Path(mutation.file).stem}"
                output, found, seconds = configurations.by_command(mutation, folder, target)
            else:
                original = (folder / mutation.file).read_bytes()
                output = answer(mutation, folder)
                (folder / mutation.file).write_bytes(original)
                found, seconds = (
                    configurations.faults(mutation, output),
                    time.process_time() - began,
                )
                if seconds > configurations.SECONDS:
                    found.append(f"slower than {configurations.SECONDS:g} s")
            tally.add(mutation.told, output, found, seconds)
        for kind, output in [] if every else tables(folder):
            fine = len(output.splitlines()) == 1 and "studies/table" in output
            tally.add(f"CSV, {kind}", output, [] if fine else ["does not tell file and cure"])
    print(f"{'mutations':30}{tally.total}")
    tally.end()


if __name__ == "__main__":
    main()
