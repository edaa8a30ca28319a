"""Every entry of the errata: what is printed is wrong, what is mended is right."""

import re

import pytest
import yaml

from nonsmooth.line.dry_friction import friction_variance
from reproduction.errata.entries import ERRATA
from reproduction.errata.record import Evidence
from reproduction.rendering.printed import numbered
from support import ROOT

LABELS = [erratum.label for erratum in ERRATA]


@pytest.fixture(scope="module")
def evidence():
    """All values, each computed once."""
    return {erratum.label: erratum.evaluate() for erratum in ERRATA}


@pytest.mark.slow
@pytest.mark.parametrize("label", LABELS)
def test_printed_is_wrong_and_mended_is_right(evidence, label):
    """The printed value violates the stated relation to the reference, the mended one keeps it."""
    e = evidence[label]
    assert not e.holds(e.printed)
    assert e.holds(e.mended)
    if e.relation == "equal":
        # the printed value is off by more than any doubt about the error
        most = 1.1 if label in {"5b", "5c"} else 50
        assert abs(e.printed - e.reference) > most * e.error


def test_every_entry_is_there():
    """There are fourteen, in order, and no label occurs twice."""
    numbers = [int(re.match(r"\d+", label)[0]) for label in LABELS]
    assert numbers == sorted(numbers)
    assert set(numbers) == set(range(1, 15))
    assert len(set(LABELS)) == len(LABELS)


@pytest.mark.slow
def test_texts_are_balanced(evidence):
    """Dollar signs and braces are paired, and every label of the paper has its number."""
    for erratum in ERRATA:
        quantity = evidence[erratum.label].quantity
        for text in (erratum.place, erratum.wrong, erratum.right, quantity):
            assert text.count("$") % 2 == 0
            assert text.count("{") == text.count("}")
            assert "\\ref" not in numbered(text)  # every label has a number


@pytest.mark.parametrize(
    ("relation", "right", "wrong"),
    [
        ("equal", (0.9, 1.1), (0.8, 1.2)),
        ("at least", (0.9, 5), (0.8,)),
        ("at most", (-5, 1.1), (1.2,)),
    ],
)
def test_relations(relation, right, wrong):
    """A value is equal, at least or at most the reference, each within the error."""
    e = Evidence("", 0, 0, reference=1.0, error=0.11, relation=relation)
    assert all(map(e.holds, right))
    assert not any(map(e.holds, wrong))


@pytest.mark.slow
def test_known_values(evidence):
    """The references agree with formulas derived by hand."""
    assert evidence["1"].reference == pytest.approx(1 / 1.4, rel=1e-15)  # 1/(2 C_b)
    assert evidence["2"].reference == pytest.approx(0.25, rel=1e-13)  # sigma^2/(2 theta)
    # sigma^2/(2 k gamma_0), k = 2, gamma_0 = 0.6, sigma = 2
    assert evidence["3c"].reference == pytest.approx(4 / 2.4, rel=1e-13)
    assert evidence["3b"].reference == pytest.approx(4 / 0.72, rel=1e-13)  # k^2/(gamma_0^2 k)
    assert evidence["4"].reference == pytest.approx(friction_variance(100)[0], rel=1e-10)
    assert evidence["14b"].reference == 1


@pytest.mark.slow
def test_printed_numbers_are_the_papers(evidence):
    """They agree with those of paper/printed.yaml."""
    printed = yaml.safe_load((ROOT / "paper" / "printed.yaml").read_text(encoding="utf-8"))
    table = printed["tab:convergence-vng-n"]["values"]
    assert evidence["4"].printed == printed["fig:fpn-cmp-PDE-MC"]["asymptotic_value"]
    assert [evidence[label].printed for label in ("5a", "5b", "5c")] == [
        table[n] for n in (100, 2, 50)
    ]


@pytest.mark.slow
def test_only_one_entry_of_table_4_is_truncated(evidence):
    """That of n = 2 is truncated; that of n = 50 is neither rounded nor truncated."""
    truncated = {k: int(evidence[k].reference * 1e6) / 1e6 for k in ("5b", "5c")}
    assert evidence["5b"].printed == truncated["5b"]
    assert evidence["5c"].printed < truncated["5c"]
