"""Counts of a trial of bad files."""

import sys
import time
from collections import Counter


class Tally:
    """Counts answers; prints those that are bad at once and the counts at the end."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.bad, self.longest, self._began = 0, 0.0, time.perf_counter()

    def add(self, where: str, output: str, faults: list[str], seconds: float = 0.0) -> None:
        """Count an answer.

        Parameters
        ----------
        where : str
            What was broken in which file.
        output : str
            The message; nothing if the file was accepted.
        faults : list of str
            What is bad about it.
        seconds : float
            Of the processor.
        """
        self.counts.update(["refused" if output else "accepted", *faults])
        self.longest = max(self.longest, seconds)
        if faults:
            self.bad += 1
            print(f"{', '.join(faults)}: {where}: {output[-300:]}", flush=True)

    @property
    def total(self) -> int:
        """Number of answers."""
        return self.counts["refused"] + self.counts["accepted"]

    def end(self) -> None:
        """Print the counts; exit with status 1 if anything is bad."""
        for what, count in self.counts.most_common():
            print(f"{what:30}{count}")
        if self.longest:
            print(f"{'longest, processor seconds':30}{self.longest:.1f}")
        print(f"{'bad':30}{self.bad}")
        print(f"{'seconds':30}{time.perf_counter() - self._began:.0f}")
        sys.exit(bool(self.bad))
