"""Blocks on several threads: in order, few at once, and stopped when nobody waits."""

import threading
import time

import pytest

from nonsmooth.paths.kernels.random_numbers import BLOCK
from nonsmooth.paths.parallel import count, kept_at_once, parallel
from nonsmooth.paths.sampling import Sampling


def sampling(number, threads):
    """So many blocks on so many threads."""
    return Sampling(0.1, number * BLOCK, 0, threads=threads)


@pytest.mark.parametrize("threads", [1, 3])
def test_results_come_in_order(threads):
    """Results are those of the blocks in their order, whichever block ends first."""

    def work(job):
        block, lanes = job
        time.sleep(0.002 * (block % 3))
        return block, lanes

    found = list(parallel(work, sampling(20, threads), steps=1))
    assert found == [(block, BLOCK) for block in range(20)]


def test_few_results_are_kept():
    """A block is not begun long before its result is taken, so that memory stays small."""
    begun, run = [], sampling(100, threads=2)
    results = parallel(begun.append, run, steps=1)
    next(results)
    time.sleep(0.05)
    assert len(begun) <= kept_at_once(run) + 1
    results.close()


def test_an_error_stops_the_other_threads():
    """The error of a block reaches the caller, and threads end that would work for ever."""

    def work(job):
        if job[0] == 1:
            raise ZeroDivisionError
        while True:
            count(1)

    before = threading.active_count()
    with pytest.raises(ZeroDivisionError):
        # the first block has no end, so that the second one's error must not wait for it
        list(parallel(work, sampling(2, threads=2), steps=1))
    assert threading.active_count() <= before  # those of other tests may end meanwhile
