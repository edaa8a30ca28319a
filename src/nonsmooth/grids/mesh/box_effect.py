"""What a larger box changes, found on a grid as coarse as the tolerance allows.

On a coarse grid most of the change is due to the elements that are added, which also make the grid
finer. So finer grids are tried until the change is small enough, and the smallest one counts.
"""

from collections.abc import Callable
from typing import Any


class BoxEffect:
    """The smallest change by a larger box that was seen.

    Parameters
    ----------
    change : callable
        Takes a level; returns what a larger box changes on it, a number or an array.
    size : callable
        Takes a change; returns a number by which changes are compared.

    Attributes
    ----------
    smallest : object
        None if no level has been tried.
    """

    def __init__(self, change: Callable[[int], Any], size: Callable[[Any], float]):
        self._change, self._size = change, size
        self._next: int | None = None
        self.smallest: Any = None

    def below(self, first: int, last: int, enough: Callable[[Any], bool]) -> Any:
        """Try finer and finer levels until the change is small enough.

        Parameters
        ----------
        first, last : int
            The levels that may be tried; each is tried once.
        enough : callable
            Takes a change; returns whether it is small enough.

        Returns
        -------
        object
            The smallest change so far.
        """
        level = first if self._next is None else self._next
        while level <= last and (self.smallest is None or not enough(self.smallest)):
            found = self._change(level)
            if self.smallest is None or self._size(found) < self._size(self.smallest):
                self.smallest = found
            level += 1
        self._next = level
        return self.smallest
