"""A thousand million normal numbers: moments, law, tails, correlations.

`python -m benchmarks.normals` prints by how many standard errors each statistic differs from its
value for independent normal numbers; the largest of the 30 should stay below 4.
"""

import numpy as np
from scipy import stats

import nonsmooth as ns
from nonsmooth.paths.kernels.random_numbers import BLOCK, generator_words, normals

SCENE = ns.Scene("friction")
BLOCKS, ROUNDS, DRAWS = 8, 500, 125  # 8000 lanes, 500 * 125 * 2 numbers each
LEVELS = np.array([1, 2, 3, 4, 4.5, 5, 5.5])
BINS = 4096


def main():
    """Draw, gather sums, print."""
    words = np.hstack([generator_words(SCENE, 11, block) for block in range(BLOCKS)])
    lanes = BLOCKS * BLOCK
    out = np.empty((2 * DRAWS, lanes), dtype=np.float32)
    edges = stats.norm.isf(np.arange(1, BINS)[::-1] / BINS)
    sums, tails, counts = np.zeros(7), np.zeros((2, len(LEVELS))), np.zeros(BINS)
    products = {}
    for _ in range(ROUNDS):
        for k in range(DRAWS):
            normals(words, out[2 * k : 2 * k + 2], lanes)
        flat = out.ravel().astype(float)
        power = np.ones_like(flat)
        for k in range(7):
            sums[k] += power.sum()
            power *= flat
        for side, sign in enumerate((1, -1)):
            tails[side] += [(sign * flat > level).sum() for level in LEVELS]
        counts += np.bincount(np.searchsorted(edges, flat), minlength=BINS)
        for kind, z in (("", out), ("squares, ", (out**2 - 1) / np.sqrt(2))):
            for name, a, b in (
                ("pair of one draw", z[0::2], z[1::2]),
                ("next draw", z[:-2:2], z[2::2]),
                ("next lane", z[:, :-1], z[:, 1:]),
                ("next stream", z[:, :-BLOCK], z[:, BLOCK:]),
            ):
                total, number = products.get(kind + name, (0.0, 0))
                products[kind + name] = (total + np.vdot(a, b).item(), number + a.size)
    count = sums[0]
    deviations = {}
    exact = (1, 0, 1, 0, 3, 0, 15, 0, 105, 0, 945, 0, 10395)
    for k in range(1, 7):
        spread = np.sqrt((exact[2 * k] - exact[k] ** 2) / count)
        deviations[f"moment {k}"] = (sums[k] / count - exact[k]) / spread
    for side, sign in enumerate("+-"):
        for level, found in zip(LEVELS, tails[side], strict=True):
            expected = count * stats.norm.sf(level)
            deviations[f"beyond {sign}{level}"] = (found - expected) / np.sqrt(expected)
    chi2 = np.sum((counts - count / BINS) ** 2) / (count / BINS)
    deviations[f"chi-square in {BINS} bins"] = (chi2 - BINS + 1) / np.sqrt(2 * (BINS - 1))
    distance = np.max(np.abs(np.cumsum(counts) / count - np.arange(1, BINS + 1) / BINS))
    deviations["Kolmogorov-Smirnov (quantile)"] = stats.norm.isf(
        stats.kstwobign.sf(distance * np.sqrt(count))
    )
    for name, (total, number) in products.items():
        deviations["correlation, " + name] = total / np.sqrt(number)
    for name, value in deviations.items():
        print(f"{name:40s} {value:8.2f}")
    print(f"{count:.4g} numbers; largest deviation {max(map(abs, deviations.values())):.2f}")


if __name__ == "__main__":
    main()
