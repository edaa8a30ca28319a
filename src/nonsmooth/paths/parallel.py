"""Blocks of paths on several threads: in order, with a bar, and stopped at once by Ctrl-C."""

import queue
import threading
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
from typing import Any

from nonsmooth.paths import cost, tuning
from nonsmooth.paths.kernels.random_numbers import blocks
from nonsmooth.paths.sampling import Sampling
from nonsmooth.progress import bar, fulfil

_of_thread = threading.local()  # its attribute `run` is the `_Run` that a thread works for


class _Stopped(Exception):
    """Ends the work on a block whose result nobody waits for any more."""


class _Run:
    """What the threads of one simulation share."""

    def __init__(self) -> None:
        self.stopped = False
        self._steps = 0
        self._lock = threading.Lock()

    def count(self, steps: int) -> None:
        if self.stopped:
            raise _Stopped
        with self._lock:
            self._steps += steps

    def counted(self) -> int:
        """Return the number of steps since this was last asked."""
        with self._lock:
            steps, self._steps = self._steps, 0
        return steps


def count(steps: int) -> None:
    """Note that a block has advanced by so many steps; end its thread's work if nobody waits.

    The time loop calls this several times a second.
    """
    run = getattr(_of_thread, "run", None)
    if run is not None:
        run.count(steps)


def kept_at_once(sampling: Sampling) -> int:
    """Return the largest number of results of `parallel` that are kept at once."""
    return 4 * sampling.workers


def parallel(
    work: Callable[[tuple[int, int]], Any], sampling: Sampling, steps: float
) -> Iterator[Any]:
    """Map `work` over the blocks of paths of a simulation, on several threads.

    Where the main thread is interrupted, it stops the others within a fraction of a second. Kernels
    must have been compiled before, because that cannot be stopped.

    Parameters
    ----------
    work : callable
        Takes the number of a block and that of its paths.
    sampling : Sampling
        Which paths, and how many threads; all cores unless given.
    steps : float
        Number of steps of each path, for the bar and to refuse what takes too long.

    Yields
    ------
    object
        The results, in the order of the blocks. Only a few are kept at once.

    Raises
    ------
    ToleranceError
        If the simulation would take too long, see `cost.require_time`.
    """
    cost.require_time(steps, sampling)
    todo: queue.SimpleQueue = queue.SimpleQueue()
    run = _Run()
    jobs = blocks(sampling.first_path, sampling.paths)
    threads = [
        threading.Thread(target=_serve, args=(todo, work, run), daemon=True)
        for _ in range(min(sampling.workers, len(jobs)))
    ]
    try:
        for thread in threads:
            thread.start()
        with bar("simulating", steps * len(jobs)) as advance:
            ahead = kept_at_once(sampling)
            yield from _in_order(jobs, todo, ahead, lambda: advance(run.counted()))
    finally:
        run.stopped = True
        for _ in threads:
            todo.put(None)
        for thread in threads:
            thread.join()


def _in_order(jobs, todo, ahead, look):
    """Hand out jobs, a few ahead of the one that is waited for, and yield their results."""
    waiting: deque[Future] = deque()
    coming = iter(jobs)
    while True:
        for job in coming:
            waiting.append(Future())
            todo.put((waiting[-1], job))
            if len(waiting) >= ahead:
                break
        if not waiting:
            return
        result = waiting.popleft()
        while not result.done():
            with suppress(TimeoutError):
                result.exception(tuning.INTERRUPTION.look)
            look()
            for later in waiting:  # an error is raised at once
                if later.done() and later.exception():
                    later.result()
        yield result.result()


def _serve(todo, work, run):
    """Work on jobs until there are none, or nobody waits for them."""
    _of_thread.run = run
    while (task := todo.get()) is not None and not run.stopped:
        result, job = task
        fulfil(result, partial(work, job))
