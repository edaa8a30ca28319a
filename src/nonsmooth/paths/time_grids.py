"""Output times, and the steps between them."""

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import ToleranceError
from nonsmooth.paths import tuning


def logarithmic(first: float, last: float, count: int) -> np.ndarray:
    """Return times from `first` to `last`, nearly equidistant in the logarithm.

    They are multiples of a tenth of `first`, so that schemes with a constant step can meet them.
    Times that coincide after rounding are given once.

    Returns
    -------
    numpy.ndarray, shape (k,), k <= count
    """
    unit = first / 10
    multiples = np.unique(np.rint(np.geomspace(first, last, count) / unit))
    return np.round(multiples * unit, 12)


def equidistant(last: float, count: int) -> np.ndarray:
    """Return times from `last` / `count` to `last`, shape (count,)."""
    return last / count * np.arange(1, count + 1)


def equal_steps(times: ArrayLike, step: float) -> list[tuple[int, float]]:
    """Split [0, times[-1]] into runs of equal steps, none longer than `step`, ending at `times`.

    Before the first output time the steps are at most a sixteenth of it, so that early
    outputs on a logarithmic axis are as well resolved as late ones.

    Returns
    -------
    list of (int, float)
        Number of steps and their length, for each output time.

    Raises
    ------
    ToleranceError
        If there are more steps than a computer can count exactly.
    """
    times = np.asarray(times, dtype=float)
    spans = np.diff(times, prepend=0.0)
    longest = np.minimum(step, np.maximum(times / tuning.TIME_GRID.first_steps, 1e-300))
    if not np.all(spans > 0):
        raise ValueError("output times must be positive and increase")
    if not times[-1] <= tuning.COST.most_steps * step:
        raise ToleranceError(
            f"steps of {step:.3g} up to the time {times[-1]:.3g} are more than can be simulated; "
            "choose a longer step or a shorter time"
        )
    counts = np.maximum(np.ceil(spans / longest - 1e-9).astype(int), 1)
    # Steps that differ by rounding only become the same number, so that they share coefficients.
    return [(int(k), float(f"{span / k:.12g}")) for k, span in zip(counts, spans, strict=True)]
