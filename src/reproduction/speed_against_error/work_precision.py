"""Work-precision diagrams: how long methods take and how far they are from a reference.

Everything is measured in one process. Each case is run once in each round, so that a slow phase of
the machine affects all of them. The first round, which compiles, is not counted.
"""

import json
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from reproduction.errors import CheckError
from reproduction.jobs import artifact


@dataclass(frozen=True)
class Case:
    """One method at one size.

    Attributes
    ----------
    panel, method : str
        Problem and method; cases that share both are one curve.
    size : float
        The number that varies along the curve, such as nodes, steps or a tolerance.
    run : callable
        Takes a seed, returns the value and the seconds it took; see `timed`.
    """

    panel: str
    method: str
    size: float
    run: Callable


def timed(function: Callable, *arguments: Any, **options: Any) -> Callable:
    """Turn a function of a seed into a `Case.run` that measures its time.

    Parameters
    ----------
    function : callable
        Takes `arguments`, `options` and, as `seed`, the seed of the round; returns the value.
    """

    def run(seed):
        began = time.perf_counter()
        value = function(*arguments, **options, seed=seed)
        return float(value), time.perf_counter() - began

    return run


def unseeded(function: Callable) -> Callable:
    """Adapt a deterministic function to `timed`."""
    return lambda *arguments, seed, **options: function(*arguments, **options)


def measured(
    title: str, summary: str, cases: list[Case], rounds: int, references: dict | None = None
) -> xr.Dataset:
    """Run every case in rounds.

    Parameters
    ----------
    title, summary : str
        Of the artifact.
    cases : list of Case
    rounds : int
        At least 2. Each has its own seed, 1, 2, ...
    references : dict, optional
        Panel -> reference value and bound of its error. Unless given, only times are measured.

    Returns
    -------
    xarray.Dataset
        Over `case`, with the coordinates `panel`, `method` and `size`: `seconds`, the median over
        the rounds, with the least and the largest; `error`, the root mean square over the rounds of
        the distance from the reference. Its own error is that of the reference and, where the
        rounds differ, the standard error of a root mean square of normal variables.

    Raises
    ------
    CheckError
        If a value is not finite.
    """
    values, seconds = np.empty((2, len(cases), rounds + 1))
    for seed in range(rounds + 1):
        for k, case in enumerate(cases):
            values[k, seed], seconds[k, seed] = case.run(seed)
            if not np.isfinite(values[k, seed]):
                raise CheckError(
                    f"{case.method} at size {case.size:g} of {case.panel} gives "
                    f"{values[k, seed]}; choose a size at which it is stable"
                )
    values, seconds = values[:, 1:], seconds[:, 1:]
    data = artifact.dataset(
        title,
        summary,
        {
            "panel": ("case", [case.panel for case in cases], "problem"),
            "method": ("case", [case.method for case in cases], "method"),
            "size": ("case", [float(case.size) for case in cases], "what is varied"),
        },
        {
            "seconds": ("case", np.median(seconds, axis=1), "median time of a run"),
            "seconds_least": ("case", seconds.min(axis=1), "least time of a run"),
            "seconds_most": ("case", seconds.max(axis=1), "largest time of a run"),
        }
        | ({} if references is None else _errors(cases, values, references)),
    )
    for name in ("seconds", "seconds_least", "seconds_most"):
        data[name].attrs["units"] = "s"
    return data


def _errors(cases, values, references):
    truth, doubt = np.array([references[case.panel] for case in cases], dtype=float).T
    error = np.sqrt(np.mean((values - truth[:, None]) ** 2, axis=1))
    chance = np.where(np.ptp(values, axis=1) > 0, error / np.sqrt(2 * values.shape[1]), 0.0)
    return {
        "error": ("case", error, "root mean square distance from the reference"),
        "error_error": ("case", np.hypot(doubt, chance), "error of that distance"),
    }


@contextmanager
def peer(python: str | Path, script: str | Path) -> Iterator[Callable]:
    """Start a program that measures methods of its own in its own environment.

    It answers requests, one JSON object a line, with the value and the seconds.

    Parameters
    ----------
    python : str or Path
        Interpreter of the environment.
    script : str or Path

    Yields
    ------
    callable
        Takes the parameters of a request by name, returns a `Case.run`.
    """
    with subprocess.Popen(
        [python, script], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:

        def request(**parameters):
            def run(seed):
                print(json.dumps(parameters | {"seed": seed}), file=process.stdin, flush=True)
                answer = process.stdout.readline()
                if not answer:
                    raise CheckError(f"{Path(script).name} failed at {parameters}; see above")
                return tuple(json.loads(answer))

            return run

        yield request


def front(seconds: np.ndarray, error: np.ndarray) -> list[int]:
    """Return the indices of cases that no other one beats in time and error, by increasing time."""
    kept, least = [], np.inf
    for k in np.lexsort((error, seconds)):
        if error[k] < least:
            kept.append(int(k))
            least = error[k]
    return kept


def exponent(size: np.ndarray, cost: np.ndarray) -> tuple[float, float]:
    """Slope of log cost against log size, by least squares, and its standard error."""
    (slope, _), covariance = np.polyfit(np.log(size), np.log(cost), 1, cov="unscaled")
    residual = np.log(cost) - np.polyval(np.polyfit(np.log(size), np.log(cost), 1), np.log(size))
    freedom = max(len(size) - 2, 1)
    return float(slope), float(np.sqrt(covariance[0, 0] * np.sum(residual**2) / freedom))
