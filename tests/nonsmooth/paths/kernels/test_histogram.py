"""Cells of values, against numpy's search and its histograms."""

import numpy as np
import pytest

from nonsmooth.paths.kernels.histogram import count_pairs, place

SEED = 4
EDGES = {
    "equal": np.linspace(-1.0, 1.0, 21),
    "unequal": np.cumsum(np.geomspace(1e-6, 1.0, 40)) - 1,
    "two": np.array([0.0, 0.5]),
}


@pytest.mark.parametrize("edges", EDGES.values(), ids=EDGES)
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_cells_are_those_of_a_search(edges, kind):
    """Also on edges, next to them, beyond them, and for what is not a number."""
    rng = np.random.default_rng(SEED)
    near = [np.nextafter(edges, side).astype(kind) for side in (-np.inf, np.inf)]
    values = np.concatenate([rng.normal(size=1000), edges, *near, [-np.inf, np.inf]]).astype(kind)
    cells = np.empty(len(values) + 1, int)
    place(np.append(values, kind(np.nan)), edges, cells)
    assert np.array_equal(cells[:-1], np.searchsorted(edges, values, side="right"))
    assert cells[-1] == 0


def test_pairs_are_counted_where_they_belong():
    """Pairs that occur several times count several times, and add to what was there."""
    rng = np.random.default_rng(SEED)
    rows, columns = rng.integers(0, 3, 500), rng.integers(0, 2, 500)
    counts = np.ones((3, 2), int)
    count_pairs(counts, rows, columns)
    expected = np.histogram2d(rows, columns, bins=(3, 2))[0] + 1
    assert np.array_equal(counts, expected)
