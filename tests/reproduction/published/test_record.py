"""The record has every number that the paper shows, and tells its own run from another."""

import json
import re
import subprocess
import sys

import numpy as np
import pytest

from reproduction.errors import ArtifactError
from reproduction.jobs import artifact
from reproduction.published.comparison import IDENTICAL, compare
from reproduction.published.record import Number, gather, read, write
from reproduction.rendering.quoted import BOUND, ERROR
from support import ROOT

EMPTY = artifact.dataset("nothing", "no variables", {}, {})
DECIMAL = re.compile(r"(?<![\w.])\d+\.\d+")
# also of a value and its error in brackets
POWER = re.compile(r"(?: plus\.minus [\d.]+)?\)?\s*times 10\^\((- )?(\d+)\)")


@pytest.fixture
def results(tmp_path):
    """Return a folder with the least that a finished run leaves."""
    for name in ("paper", "tables", "gamma2", "hard_cases", "smoke/logs", "smoke/gamma2"):
        (tmp_path / name).mkdir(parents=True)
    kappa = {"text": "0.29", "value": 0.291, "error": 1e-9, "kind": BOUND}
    numbers = {"finite_p.kappa": kappa, "finite_p.p": "1, 10", "seed": "1"}
    (tmp_path / "paper" / "numbers.json").write_text(json.dumps(numbers))
    table = "p,W,W_error,standard_error,empty\n1.0,0.5,0.01,0.02,\n"
    (tmp_path / "tables" / "table_9.csv").write_text(table)
    (tmp_path / "tables" / "table_hard_cases.csv").write_text(table)
    for folder in ("gamma2", "hard_cases", "smoke/gamma2"):
        history = "rule first(seed=1); x\nrule gamma2(tol=1, seed=7); nonsmooth 0.2"
        artifact.write(EMPTY, tmp_path / folder / "a.nc", history)
    return tmp_path


def test_numbers_carry_the_errors_beside_them(results):
    """A column with an ending is the error of another; empty cells are left out."""
    record = gather(results)
    assert record.seed == "1"
    assert record.sections == {
        "table_9": {
            "row 1, p": "1.0",
            "row 1, W": Number(0.5, 0.01, BOUND),
            "row 1, standard_error": Number(0.02, 0.0, ERROR),
        },
        "text: finite_p": {"kappa": Number(0.291, 1e-9, BOUND), "p": "1, 10"},
    }
    assert list(record.artifacts) == ["gamma2/a.nc"]


def test_the_parameters_are_the_own_ones_without_the_seed(results):
    """Another seed, another version and another history before do not change their checksum."""

    def parameters(history):
        path = results / "gamma2" / "a.nc"
        artifact.write(EMPTY, path, history)
        return gather(results).artifacts["gamma2/a.nc"]["parameters"]

    one = parameters("rule gamma2(tol=1, seed=7); version 2")
    assert one == parameters("rule b(); x\nrule gamma2(tol=1, seed=8); nonsmooth 0.3")
    assert one != parameters("rule gamma2(tol=2, seed=7); nonsmooth 0.2")


def test_a_record_survives_its_file(results, tmp_path):
    """And the file is the same however it was ordered."""
    record = gather(results)
    write(record, tmp_path / "published.json")
    assert read(tmp_path / "published.json") == record


def test_a_broken_record_is_one_line(tmp_path):
    """So is a missing run."""
    (tmp_path / "published.json").write_text('{"seed": 1}')
    with pytest.raises(ArtifactError, match="restore it with git"):
        read(tmp_path / "published.json")
    with pytest.raises(ArtifactError, match="run make paper first"):
        gather(tmp_path)


def shown(text):
    """Find the decimal numbers of Typst source: their sizes and units of the last digit."""
    for match in DECIMAL.finditer(text):
        power = POWER.match(text, match.end())
        exponent = int(power[2]) * (-1 if power[1] else 1) if power else 0
        digits = len(match[0].partition(".")[2])
        yield float(match[0]) * 10.0**exponent, 10.0 ** (exponent - digits)


def known(record, section):
    """Return the sizes of a section's numbers, errors and those within texts among them."""
    values = []
    for entry in record.sections[section].values():
        if isinstance(entry, Number):
            values += [entry.value, entry.error, abs(entry.value) + entry.error]
        else:
            values += [float(number) for number in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", entry)]
            values += [number for number, _ in shown(entry)]
    return np.abs(values)


def holds(values, value, unit):
    """Whether a number is among values: rounded to the unit, or raised.

    Bounds are raised by 5 % and rounded; or they include the rounding of a value, and are rounded
    up.
    """
    half = 0.5001 * unit
    rounded = np.abs(values - value) <= half
    raised = np.abs(1.05 * values - value) <= half
    rounded_up = (values <= value) & (value <= values + 3 * half)
    return np.any(rounded | raised | rounded_up)


def test_every_decimal_of_the_paper_is_in_the_record(smoke_run):
    """Those of its tables and of the text."""
    results = smoke_run.folder / "results" / "smoke"
    record, found = gather(results), 0
    for table in (results / "tables").glob("table_*.typ"):
        values = known(record, table.stem)
        rows = re.findall(r"^  \[.*$", table.read_text(encoding="utf-8"), flags=re.MULTILINE)
        for value, unit in shown("\n".join(rows)):
            assert holds(values, value, unit), (table.stem, value)
            found += 1
    text = json.loads((results / "paper" / "values.json").read_text(encoding="utf-8"))
    for section in text.keys() - {"seed"}:
        values = known(record, f"text: {section}")
        for value, unit in shown(json.dumps(text[section])):
            assert holds(values, value, unit), (section, value)
            found += 1
    assert found > 150, found


def test_every_artifact_of_the_paper_is_in_the_record(smoke_run):
    """All that are not on demand."""
    results = smoke_run.folder / "results" / "smoke"
    names = {path.relative_to(results).as_posix() for path in results.rglob("*.nc")}
    on_demand = {name for name in names if name.startswith("speed_against_error/")}
    assert on_demand
    assert gather(results).artifacts.keys() == names - on_demand


def published(repository, *arguments):
    """Run the program on the smoke run."""
    return subprocess.run(
        [
            *(sys.executable, "-m", "reproduction.published", *arguments),
            *("--results", "results/smoke", "--record", "record.json"),
        ],
        cwd=repository.folder,
        capture_output=True,
        text=True,
    )


def test_a_run_is_verified_and_a_changed_one_is_not(finished):
    """Against itself, with numbers within and beyond errors, with other bytes, with a lost file."""
    assert published(finished, "publish").returncode == 0
    same = published(finished, "verify")
    assert (same.returncode, same.stderr) == (0, "")
    assert "reproduced to the digit" in same.stdout

    results = finished.folder / "results" / "smoke"
    table = results / "tables" / "table_5.csv"
    before = table.read_text()
    number = gather(results).sections["table_5"]["row 1, monte_carlo_gamma2"]

    def changed(by):
        table.write_text(before.replace(repr(number.value), repr(number.value + by)))
        return published(finished, "verify")

    within, beyond = changed(number.error), changed(20 * number.error)
    assert within.returncode == 0
    assert "reproduced within the stated errors" in within.stdout
    assert beyond.returncode == 1
    assert "table_5, row 1, monte_carlo_gamma2: published" in beyond.stdout
    assert "Traceback" not in beyond.stderr

    table.write_text(before)
    path = results / "gamma2" / "friction_white.nc"
    data = artifact.read(path)
    data["gamma2"] += data["gamma2_error"] / 2
    artifact.write(data, path, data.attrs["history"])
    other_bytes = published(finished, "verify")
    assert other_bytes.returncode == 0
    (files,) = (line for line in other_bytes.stdout.splitlines() if line.startswith("artifacts"))
    assert files.split()[-2:] == ["1", "0"]

    (results / "errata" / "errata.nc").unlink()
    lost = published(finished, "verify")
    assert lost.returncode == 1
    assert "results/smoke/errata/errata.nc is missing" in lost.stdout


def test_reduced_sizes_are_refused(smoke_run):
    """They are not those of the published record."""
    found = gather(smoke_run.folder / "results" / "smoke")
    full = read(ROOT / "paper" / "published.json")
    with pytest.raises(ArtifactError, match="other parameters"):
        compare(full, found, "results/smoke")


def test_the_published_record_is_that_of_a_whole_run():
    """It is identical with itself, has all tables, and is small enough to be read in a review."""
    path = ROOT / "paper" / "published.json"
    record = read(path)
    outcome = compare(record, record)
    assert set().union(*outcome.sections.values()) == {IDENTICAL}
    assert len(record.artifacts) > 100
    template = (ROOT / "paper" / "paper.typ").read_text(encoding="utf-8")
    assert set(re.findall(r"table_(?:\d+b?|potentials|time_step)(?=\")", template)) <= set(
        record.sections
    )
    assert path.stat().st_size < 1e6


def test_every_computed_number_of_a_table_has_an_error():
    """What has none, and must be equal, are texts and numbers of a few digits."""
    for section, entries in read(ROOT / "paper" / "published.json").sections.items():
        for name, entry in entries.items():
            if section.startswith("table") and isinstance(entry, str):
                assert not re.fullmatch(r"-?\d+\.\d{7,}(e-?\d+)?", entry), (section, name)
