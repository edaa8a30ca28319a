"""Counting in which cells values are."""

from nonsmooth.paths.kernels.compilation import kernel


@kernel
def place(values, edges, cells):
    """Write to `cells` how many edges are not above each value; 0 if it is not a number.

    Edges increase. Where they are equally spaced, the first guess is the cell or next to it.
    """
    count = len(edges)
    first, last = edges[0], edges[count - 1]
    scale = (count - 1) / (last - first)
    for i in range(len(cells)):
        value = values[i]
        if not value >= first:
            cells[i] = 0
        elif value >= last:
            cells[i] = count
        else:
            k = int((value - first) * scale)
            while edges[k] > value:
                k -= 1
            while edges[k + 1] <= value:
                k += 1
            cells[i] = k + 1


@kernel
def count_pairs(counts, rows, columns):
    """Add 1 at each pair of a row and a column."""
    for i in range(len(rows)):
        counts[rows[i], columns[i]] += 1
