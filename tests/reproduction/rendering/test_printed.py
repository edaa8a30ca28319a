"""What the paper prints, and the numbers in the place of its labels."""

import pytest

from reproduction.errors import ArtifactError
from reproduction.rendering import printed
from reproduction.rendering.printed import numbered, printed_values


def test_values_of_table_4():
    """They are read as the paper prints them."""
    assert printed_values("tab:convergence-vng-n")["values"][100] == 0.136784


def test_labels_become_the_numbers_that_readers_see():
    """Several in one text; text without a label stays as it is."""
    text = r"claim \ref{eq:lyapu-bound-S4} and \ref{lemma1}"
    assert numbered(text) == "claim (30) and Lemma 2"
    assert numbered("$x^2$") == "$x^2$"


def test_an_unknown_label_is_refused():
    """The error says where to add it."""
    with pytest.raises(ArtifactError, match=r"printed\.yaml has no number for the label misspelt"):
        numbered(r"eq. \ref{misspelt}")


@pytest.mark.parametrize(
    "content", [None, b"", b"numbers: [", b"- 1", b"numbers: 3", b"\xff\xfe", b"other: {}"]
)
def test_a_damaged_file_is_one_line(tmp_path, monkeypatch, content):
    """Missing, empty, cut off, of another kind: the cure is the tracked file."""
    path = tmp_path / "printed.yaml"
    monkeypatch.setattr(printed, "PRINTED", str(path))
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ArtifactError, match=r"printed\.yaml has no readable entry") as error:
        numbered("")
    assert "\n" not in str(error.value)
