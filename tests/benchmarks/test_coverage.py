"""Intervals contain the truth as often as they say: a small version of the benchmark."""

import numpy as np
import pytest
from scipy import stats

from benchmarks.coverage import COARSE, coverage, of_limits

RUNS = 100
FALSE_ALARM = 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("name", COARSE)
def test_limits_account_for_the_bias_of_the_step(name):
    """At coarse steps, too; within what chance allows about 93 to 97 %, as below."""
    hits = round(of_limits(*COARSE[name], runs=RUNS, first=5000)["covered"] * RUNS)
    level = FALSE_ALARM / 2 / len(COARSE)
    assert stats.binom.ppf(level, RUNS, 0.93) <= hits <= stats.binom.isf(level, RUNS, 0.97)


@pytest.mark.slow
def test_coverage():
    """Every quantity within what chance allows about 95 %, itself allowed to be off by 2 %.

    The small runs' own intervals are approximate: what the benchmark of 1000 runs asks for is
    between 93 and 97 %.
    """
    table = coverage(RUNS, truth_paths=10_000_000)
    level = FALSE_ALARM / 2 / len(table)
    least, most = stats.binom.ppf(level, RUNS, 0.93), stats.binom.isf(level, RUNS, 0.97)
    hits = np.rint(table["covered"] * RUNS)
    assert len(table) == 9
    assert (hits >= least).all(), table
    assert (hits <= most).all(), table
