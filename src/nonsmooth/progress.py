"""Where long computations begin: bars that show how far they are, and calls that hear Ctrl-C.

Bars go to the standard error, only if that is a terminal or the program runs in a notebook, and
only after a second. Logs and tests see none.
"""

import contextvars
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from typing import Any, TypeVar

Result = TypeVar("Result")

DELAY = 1.0  # seconds; what is over sooner needs no bar
BEAT = 0.5  # seconds between two looks at the clock, or for Ctrl-C

_rehearsing = contextvars.ContextVar("rehearsing", default=False)


class _Begun(BaseException):
    """Ends a rehearsal."""


@contextmanager
def rehearsal() -> Iterator[None]:
    """End what is called within as soon as it begins to compute.

    So it raises what it refuses before, because an argument or the scene is none that it takes.
    """
    before = _rehearsing.set(True)
    try:
        yield
    except _Begun:
        pass
    finally:
        _rehearsing.reset(before)


def begin() -> None:
    """Note that a computation begins, which is where a rehearsal ends."""
    if _rehearsing.get():
        raise _Begun


def bar(what: str, total: float) -> AbstractContextManager[Callable[[float], None]]:
    """Show which share of a known amount is done, and how long the rest will take.

    Parameters
    ----------
    what : str
        What is computed.
    total : float
        How much there is to do, in any unit.

    Returns
    -------
    context manager
        Of a function to be told how much more has been done.
    """
    return _shown(what, total, "{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}")


def counter(what: str, most: int = 0) -> AbstractContextManager[Callable[[float], None]]:
    """Show how many of some things are done, of at most so many if that is known.

    Parameters and result are those of `bar`.
    """
    limit = " of at most {total_fmt}" if most else ""
    return _shown(what, most or None, "{desc}: {n_fmt}" + limit + ", {elapsed}")


@contextmanager
def _shown(what: str, total: float | None, shape: str) -> Iterator[Callable[[float], None]]:
    begin()
    if not (sys.stderr.isatty() or "ipykernel" in sys.modules):
        yield lambda more: None
        return
    from tqdm.auto import tqdm  # slow to import, and seldom needed

    done = threading.Event()

    def beat():
        """Show the time that has passed, also while nothing advances."""
        while not done.wait(DELAY + BEAT):
            drawn.refresh()

    with tqdm(desc=what, total=total, delay=DELAY, leave=False, bar_format=shape) as drawn:
        heart = threading.Thread(target=beat, daemon=True)
        heart.start()
        try:
            yield drawn.update
        finally:  # nothing may be drawn once the bar is gone
            done.set()
            heart.join()


def interruptible(call: Callable[[], Result]) -> Result:
    """Call a function in another thread and wait for it, so that Ctrl-C need not.

    Python looks for Ctrl-C between two of its own instructions, and not within a call of a compiled
    library. The call must release Python's global lock where it takes long, as the sparse
    factorisation of scipy and the linear algebra of numpy do; most of that of scipy does not. After
    Ctrl-C the call goes on until it is done or the program ends, and its result is dropped.

    Parameters
    ----------
    call : callable
        Takes nothing.

    Returns
    -------
    object
        What the call returns; what it raises is raised here.
    """
    begin()
    result: Future = Future()
    context = contextvars.copy_context()  # has numpy's treatment of overflow

    threading.Thread(target=fulfil, args=(result, partial(context.run, call)), daemon=True).start()
    return awaited(result)


def awaited(result: Future) -> Any:
    """Wait for what another thread promised, looking for Ctrl-C again and again.

    Python misses it for the whole of a wait if it comes just before that begins.
    """
    while not wait([result], BEAT).done:
        pass
    return result.result()


def fulfil(promised: Future, call: Callable[[], Any]) -> None:
    """Keep what a call returns, or raises, for the thread that waits for it."""
    try:
        promised.set_result(call())
    except BaseException as error:
        promised.set_exception(error)
