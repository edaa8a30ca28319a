"""Mutations of the configurations: bad ones are refused in a line, legal ones are accepted."""

import pytest

from benchmarks.trials.configurations import answer, by_command, copy_of_repository, faults
from benchmarks.trials.mutations import mutations

ALL = mutations()
LEGAL = [mutation for mutation in ALL if mutation.legal]
# of each kind some
BAD = sorted((m for m in ALL if not m.legal), key=lambda m: (m.kind, m.file))[::14]


def test_there_are_many_of_all_kinds():
    """The whole trial has thousands, and the sample hundreds."""
    assert len(ALL) > 5000
    assert len(BAD) >= 365
    assert len({m.kind.partition(":")[0] for m in BAD}) > 25


@pytest.mark.slow
def test_bad_configurations_are_refused(tmp_path):
    """Each in a line with file, key and cure."""
    answers = [(m.kind, m.key, faults(m, answer(m, tmp_path))) for m in BAD]
    assert not [answer for answer in answers if answer[-1]]


@pytest.mark.parametrize("mutation", LEGAL, ids=lambda m: ".".join(map(str, m.key)))
def test_legal_configurations_are_accepted(mutation, tmp_path):
    """The checks refuse no more than they should."""
    assert answer(mutation, tmp_path) == ""


@pytest.mark.slow
def test_the_command_answers_likewise(tmp_path):
    """One of each way to be bad, and a legal one, as a user would give them to snakemake."""
    copy_of_repository(tmp_path)
    kinds = ["YAML: unclosed bracket", "YAML: runs code", "misspelt key", "size", "formula: string"]
    chosen = [next(m for m in reversed(ALL) if m.kind == kind) for kind in kinds]
    for mutation in [*chosen, LEGAL[0]]:
        output, found, _ = by_command(mutation, tmp_path)
        assert not [fault for fault in found if not fault.startswith("slower")], output
