"""Gradings of elements: what they promise about ratios, ends and symmetry."""

import numpy as np
import pytest

from nonsmooth.grids.grading import distinct, geometric, graded, growing, layers, mirrored, split


@pytest.mark.parametrize(("end", "finest", "ratio"), [(1.0, 1 / 64, 4.0), (3.7, 0.011, 2.5)])
def test_graded_edges_end_at_the_finest(end, finest, ratio):
    """Ratios are equal and at most the one asked for, with as few edges as that allows."""
    edges = graded(end, finest, ratio)
    ratios = edges[:-1] / edges[1:]
    assert edges[[0, -1]] == pytest.approx([end, finest], rel=1e-14)
    assert ratios == pytest.approx(ratios[0])
    assert ratio ** (len(edges) - 2) < end / finest <= ratio ** (len(edges) - 1) * (1 + 1e-8)


def test_geometric_edges_have_the_ratio():
    """The next one, which is left out, would be at the finest."""
    edges = geometric(2.0, 4.0, layers(2.0, 2.0 / 256, 4.0))
    assert list(edges) == [2.0, 0.5, 0.125, 0.03125]


def test_growing_elements_double_up_to_the_widest():
    """The last element passes the end, or stops before it where little is left."""
    edges = growing(1.0, 3.0, 0.1, 0.5)
    assert np.diff(edges) == pytest.approx([0.1, 0.2, 0.4, 0.5, 0.5, 0.5])
    assert edges[-2] < 3.0 <= edges[-1]
    shorter = growing(1.0, 3.0, 0.1, 0.5, spare=1.5)
    assert list(shorter) == list(edges[:-1])


def test_edges_are_put_together():
    """Mirrored about 0, rid of those that coincide, and split into equal parts."""
    assert list(mirrored([2.0, 0.5])) == [-2.0, -0.5, 0.0, 0.5, 2.0]
    assert list(distinct([1.0, 0.0, 1.0 + 1e-12], 1e-9)) == [0.0, 1.0]
    assert list(distinct([1e-12, 0.0, 1.0], relative=1e-9)) == [0.0, 1e-12, 1.0]
    assert list(split(np.array([0.0, 1.0, 4.0]), np.array([2, 3]))) == [0, 0.5, 1, 2, 3, 4]
