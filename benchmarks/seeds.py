"""Random scenes of one seed after the other, for benchmarks that compare errors."""

import argparse
import sys
import warnings
from collections.abc import Callable, Iterable

import pandas as pd

from nonsmooth.errors import NonsmoothError


def compared(
    arguments: list[str], description: str, compare: Callable[[int], Iterable[dict]]
) -> pd.DataFrame:
    """Compare what `--first` and `--scenes` ask for, and tell each row as it comes.

    Parameters
    ----------
    arguments : list of str
        Of the command.
    description : str
    compare : callable
        Takes a seed, yields rows; a scene that is refused has none from then on.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--scenes", type=int, default=20, help="how many")
    chosen, rows = parser.parse_args(arguments), []
    warnings.simplefilter("ignore")
    for seed in range(chosen.first, chosen.first + chosen.scenes):
        try:
            for row in compare(seed):
                rows.append(row)
                told = ", ".join(
                    f"{key} {value}" if isinstance(value, str) else f"{key} {value:.2g}"
                    for key, value in row.items()
                )
                print(f"{seed}: {told}", file=sys.stderr, flush=True)
        except NonsmoothError as refused:
            print(f"{seed}: {refused}", file=sys.stderr, flush=True)
    return pd.DataFrame(rows)
