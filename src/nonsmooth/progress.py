"""Bars that show how far a long computation is.

They go to the standard error, only if that is a terminal or the program runs in a notebook, and
only after a second. Logs and tests see none.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

DELAY = 1.0  # seconds; what is over sooner needs no bar


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
    if not (sys.stderr.isatty() or "ipykernel" in sys.modules):
        yield lambda more: None
        return
    from tqdm.auto import tqdm  # slow to import, and seldom needed

    with tqdm(desc=what, total=total, delay=DELAY, leave=False, bar_format=shape) as drawn:
        yield drawn.update
