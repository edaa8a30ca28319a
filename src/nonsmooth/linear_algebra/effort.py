"""A limit of what solvers may take where nobody said how accurate an answer must be.

It counts operations of dense algebra and no seconds, so that a call does the same everywhere.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

import numpy as np

from nonsmooth.errors import ToleranceError

MOST = 6e11  # operations; chosen: half a minute to a minute of one core
# fitted: operations of products that take as long as the modes of r real or complex equations, over
# r^3
REAL_MODES, COMPLEX_MODES = 25.0, 100.0

_left: ContextVar[list[float] | None] = ContextVar("left", default=None)


@contextmanager
def limited(tol: float | None) -> Iterator[None]:
    """Limit the operations of what is called within to `MOST`, unless a tolerance is given.

    A limit that holds already stays.

    Parameters
    ----------
    tol : float or None
        What the user gave.
    """
    if tol is not None or _left.get() is not None:
        yield
        return
    before = _left.set([MOST])
    try:
        yield
    finally:
        _left.reset(before)


def holds() -> bool:
    """Whether a limit holds."""
    return _left.get() is not None


def of_modes(matrix: np.ndarray) -> float:
    """Operations that the modes of equations with a matrix take, shape (r, r)."""
    return (COMPLEX_MODES if np.iscomplexobj(matrix) else REAL_MODES) * len(matrix) ** 3


def spend(operations: float) -> None:
    """Note that so many additions and multiplications follow.

    Raises
    ------
    ToleranceError
        If the limit does not cover them; it covers nothing that follows then.
    """
    left = _left.get()
    if left is None:
        return
    left[0] -= operations
    if left[0] < 0:
        raise ToleranceError(
            "this takes more than a minute; give a tol to wait for it, or use method='monte_carlo'"
        )
